"""The turnstile in front of the catalogue: many readers or one writer, and no writer starves.

Two lock files. Whoever wants in holds the turnstile while waiting for the catalogue, so that no reader slips
past a writer that waits. The locks are advisory, belong to the open file, and vanish with the process.
"""

from __future__ import annotations

import errno
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from thermodata.errors import StoreError
from thermodata.store.base.files import write_error

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


class _Patience:
    """How long is waited yet [s]. Time in which this process itself was stopped, or got no turn on a busy machine, is
    hardly counted: whoever holds the lock may have stood still as long."""

    def __init__(self, seconds: float) -> None:
        self.seconds = self._left = seconds
        self._seen = time.monotonic()

    def is_over(self) -> bool:
        now = time.monotonic()
        self._left -= min(now - self._seen, _MOST_STEP_S)
        self._seen = now
        return self._left < 0


_MOST_STEP_S = 0.5  # of one look at the lock and the pause before it


@contextmanager
def catalogue_lock(folder: Path, *, exclusive: bool, timeout_s: float = 60.0) -> Iterator[None]:
    """Holds the catalogue, shared for reading or exclusive for writing; StoreError when it stays busy."""
    patience = _Patience(timeout_s)
    turnstile = _open_lock(folder / TURNSTILE, exclusive)
    if turnstile is None:
        # a store that may only be read: whoever may write it can lock the one file that is there
        with _reading(folder, patience):
            yield
        return
    try:
        _wait(turnstile, True, patience, folder)
        catalogue = _open_lock(folder / CATALOGUE, exclusive)
        try:
            if catalogue is not None:
                _wait(catalogue, exclusive, patience, folder)
            _unlock(turnstile)
            try:
                yield
            finally:
                if catalogue is not None:
                    _unlock(catalogue)
        finally:
            if catalogue is not None:
                os.close(catalogue)
    finally:
        os.close(turnstile)


@contextmanager
def _reading(folder: Path, patience: _Patience) -> Iterator[None]:
    try:
        fd = os.open(folder / CATALOGUE, os.O_RDONLY | _FLAGS)
    except OSError:
        yield  # nobody ever wrote here since the store was copied
        return
    try:
        _wait(fd, False, patience, folder)
        yield
    finally:
        os.close(fd)


_FLAGS = getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)


def _open_lock(path: Path, exclusive: bool) -> int | None:
    """A lock file, made where there is none; None where the folder may only be read, and no more is wanted."""
    try:
        return os.open(path, os.O_RDWR | os.O_CREAT | _FLAGS, 0o666)
    except OSError as error:
        if not exclusive and error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
            return None
        raise write_error(path, error) from error


def _wait(fd: int, exclusive: bool, patience: _Patience, folder: Path) -> None:
    pause = 0.0005
    attempt: Callable[[], bool] = lambda: _try_lock(fd, exclusive)  # noqa: E731
    while not attempt():
        if patience.is_over():
            raise StoreError(
                "the store is busy",
                where=str(folder),
                expected=f"a free catalogue within {patience.seconds:g} s",
                got="another process held it all the time",
                hint="wait for the other program, or end one that hangs in this store",
            )
        time.sleep(pause)
        pause = min(pause * 1.5, 0.005)
