"""The turnstile in front of the catalogue: many readers or one writer, and no writer starves.

Two lock files. Whoever wants in holds the turnstile while waiting for the catalogue, so that no reader slips
past a writer that waits. The locks are advisory, belong to the open file, and vanish with the process.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from thermodata.errors import StoreError

TURNSTILE, CATALOGUE = "turnstile.lock", "catalog.lock"

try:
    import fcntl

    def _try_lock(fd: int, exclusive: bool) -> bool:
        try:
            fcntl.flock(fd, (fcntl.LOCK_EX if exclusive else fcntl.LOCK_SH) | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True

    def _unlock(fd: int) -> None:
        fcntl.flock(fd, fcntl.LOCK_UN)

except ImportError:  # not POSIX: a byte of the file is locked, always exclusively
    import msvcrt

    def _try_lock(fd: int, exclusive: bool) -> bool:
        try:
            os.lseek(fd, 0, os.SEEK_SET)
            msvcrt.locking(fd, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        except OSError:
            return False
        return True

    def _unlock(fd: int) -> None:
        os.lseek(fd, 0, os.SEEK_SET)
        msvcrt.locking(fd, msvcrt.LK_UNLCK, 1)  # type: ignore[attr-defined,unused-ignore]


@contextmanager
def catalogue_lock(folder: Path, *, exclusive: bool, timeout_s: float = 60.0) -> Iterator[None]:
    """Holds the catalogue, shared for reading or exclusive for writing; StoreError when it stays busy."""
    deadline = time.monotonic() + timeout_s
    turnstile = _open(folder / TURNSTILE)
    try:
        _wait(turnstile, True, deadline, folder, timeout_s)
        catalogue = _open(folder / CATALOGUE)
        try:
            _wait(catalogue, exclusive, deadline, folder, timeout_s)
            _unlock(turnstile)
            try:
                yield
            finally:
                _unlock(catalogue)
        finally:
            os.close(catalogue)
    finally:
        os.close(turnstile)


def _open(path: Path) -> int:
    flags = getattr(os, "O_CLOEXEC", 0)
    try:
        try:
            return os.open(path, os.O_RDWR | os.O_CREAT | flags, 0o666)
        except OSError:
            return os.open(path, os.O_RDONLY | flags)    # a store that may only be read
    except OSError as error:
        raise StoreError("the store's lock file cannot be opened", where=str(path), got=str(error)) from error


def _wait(fd: int, exclusive: bool, deadline: float, folder: Path, timeout_s: float) -> None:
    pause = 0.0005
    attempt: Callable[[], bool] = lambda: _try_lock(fd, exclusive)  # noqa: E731
    while not attempt():
        if time.monotonic() > deadline:
            raise StoreError(
                "the store is busy", where=str(folder), expected=f"a free catalogue within {timeout_s:g} s",
                got="another process held it all the time",
                hint="wait for the other program, or end one that hangs in this store")
        time.sleep(pause)
        pause = min(pause * 1.5, 0.005)
