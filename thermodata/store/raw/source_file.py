"""A source file as it stands: hashed, read, and found unchanged afterwards, or read from a copy that can't change."""

from __future__ import annotations

import contextlib
import hashlib
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from thermodata.errors import StoreError
from thermodata.reader.files.regular import opened

_CHUNK = 1 << 20


class ChangedError(Exception):
    """A source file is no longer what was hashed: a logger still writes it, or it was replaced."""


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A file with the hash of its bytes. path: where the bytes can be read. mark: by which a change is noticed.
    note: said where the bytes are those of a copy."""

    path: Path
    sha256: str
    bytes: int
    mark: tuple[int, ...]
    note: str | None = None

    def check(self) -> None:
        """Raises ChangedError where the file is another one, longer, shorter or newer than when it was hashed."""
        try:
            now = mark_of(os.stat(self.path))
        except OSError as error:
            raise ChangedError(str(error)) from error
        if now != self.mark:
            raise ChangedError(f"{self.bytes} bytes when it was hashed, {now[2]} bytes now")


def mark_of(status: os.stat_result) -> tuple[int, ...]:
    """What changes with a file's content: which file it is, its length, and when it was last written."""
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def settled(path: Path) -> SourceFile:
    """A file and its hash. The mark is that from before the hash: what is written meanwhile shows in `check`."""
    with opened(path) as handle:
        mark = mark_of(os.fstat(handle.fileno()))
        digest = hashlib.sha256()
        while data := handle.read(_CHUNK):
            digest.update(data)
    return SourceFile(path, digest.hexdigest(), mark[2], mark)


@contextmanager
def frozen(path: Path, folder: Path) -> Iterator[SourceFile]:
    """A copy of as much of the file as is there now, for files that grow while they are read.

    folder: where the copy stands meanwhile, under the file's own name. StoreError where there is no room for it.
    """
    place = folder / f".{secrets.token_hex(4)}.growing.tmp"
    copy = place / path.name
    digest = hashlib.sha256()
    try:
        with opened(path) as handle, _room(place, copy) as out:
            left = os.fstat(handle.fileno()).st_size
            while left and (data := handle.read(min(left, _CHUNK))):
                digest.update(data)
                _put(out, data, copy)
                left -= len(data)
        status = copy.stat()
        yield SourceFile(
            copy,
            digest.hexdigest(),
            status.st_size,
            mark_of(status),
            f"changed while it was read: its first {status.st_size} bytes are in the store; "
            "ingest again when the logger has ended",
        )
    finally:
        with contextlib.suppress(OSError):
            shutil.rmtree(place)


@contextmanager
def _room(place: Path, copy: Path) -> Iterator[BinaryIO]:
    try:
        place.mkdir(parents=True)
        out: BinaryIO = copy.open("wb", buffering=0)
    except OSError as error:
        raise _no_room(copy, error) from error
    with out:
        yield out


def _put(out: BinaryIO, data: bytes, copy: Path) -> None:
    try:
        while data:
            data = data[out.write(data) :]
    except OSError as error:
        raise _no_room(copy, error) from error


def _no_room(copy: Path, error: OSError) -> StoreError:
    return StoreError(
        "a file that grows while it is read cannot be copied",
        where=str(copy),
        got=str(error),
        hint="ingest again when the logger has ended, or free space on the store's disk",
    )
