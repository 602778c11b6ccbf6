"""A source file as it stands: hashed, read, and found unchanged afterwards, or read from a copy that can't change."""

from __future__ import annotations

import contextlib
import hashlib
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from thermodata.archive.members import archive_of, file_state, standing
from thermodata.archive.regular import opened
from thermodata.archive.unpacked import held
from thermodata.errors import StoreError

_CHUNK = 1 << 20


class ChangedError(Exception):
    """A source file is no longer what was hashed: a logger still writes it, or it was replaced."""


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A file with the hash of its bytes. path: where the bytes can be read. mark: by which a change is noticed, of one
    in an archive that of the archive. note: said where the bytes are those of a copy."""

    path: Path
    sha256: str
    bytes: int
    mark: tuple[int, ...]
    note: str | None = None

    def check(self) -> None:
        """Raises ChangedError where the file is another one, longer, shorter or newer than when it was hashed."""
        try:
            now = mark_of(os.stat(standing(self.path)))
        except OSError as error:
            raise ChangedError(str(error)) from error
        if now != self.mark:
            raise ChangedError(f"{self.bytes} bytes when it was hashed, {now[2]} bytes now")


def mark_of(status: os.stat_result) -> tuple[int, ...]:
    """What changes with a file's content: which file it is, its length, and when it was last written."""
    return file_state(status)


def settled(path: Path) -> SourceFile:
    """A file and its hash. The mark is that from before the hash: what is written meanwhile shows in `check`."""
    mark = mark_of(os.stat(standing(path)))
    with _as_hashed(path) as bytes_of, opened(bytes_of) as handle:
        digest, size = hashlib.sha256(), 0
        while data := handle.read(_CHUNK):
            digest.update(data)
            size += len(data)
    return SourceFile(path, digest.hexdigest(), size, mark)


def _as_hashed(path: Path) -> AbstractContextManager[Path]:
    """What is hashed of a log: the file on the disk, packed as it may be; one in an archive as it is there, for others
    come to it and go."""
    return nullcontext(path) if archive_of(path) is None else held(path)


@contextmanager
def frozen(path: Path, folder: Path) -> Iterator[SourceFile]:
    """A copy of as much of the file as is there now, for files that grow while they are read.

    folder: where the copy stands meanwhile, under the file's own name. StoreError where there is no room for it.
    """
    place = folder / f".{secrets.token_hex(4)}.growing.tmp"
    copy = place / path.name
    digest = hashlib.sha256()
    try:
        with _as_hashed(path) as bytes_of, opened(bytes_of) as handle, _room(place, copy) as out:
            left = os.fstat(handle.fileno()).st_size
            while left and (data := handle.read(min(left, _CHUNK))):
                digest.update(data)
                _write_copy(out, data, copy)
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


def _write_copy(out: BinaryIO, data: bytes, copy: Path) -> None:
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
