"""Files that appear whole or not at all: temporary name, fsync, rename."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import re
import secrets
from collections.abc import Iterator
from pathlib import Path

from thermodata.errors import NoRoomError, StoreError, ThermodataError
from thermodata.store.base.no_room import no_room

TEMPORARY = re.compile(r"^\..*\.tmp(\.wal)?$")  # DuckDB puts a .wal beside a database in the making


_unfinished: set[Path] = set()


def temporary(target: Path) -> Path:
    """A name beside the target that nobody reads."""
    part = target.with_name(f".{target.name}.{secrets.token_hex(4)}.tmp")
    _unfinished.add(part)
    return part


def drop_unfinished() -> None:
    """Deletes what this process began under a temporary name and did not publish: for one that must end now, whatever
    its other threads are at."""
    for part in tuple(_unfinished):
        with contextlib.suppress(OSError):
            part.unlink()


def write_error(path: Path, error: Exception, needed: str | None = None) -> StoreError:
    """A failure to write below the store: no room, read-only folder, or else. needed: how much room, in words."""
    text = _first_line(error)
    way = no_room(error)
    if way is None:
        locked = getattr(error, "errno", None) in (errno.EACCES, errno.EPERM, errno.EROFS)
        return StoreError(
            "the store can only be read" if locked else "the store cannot be written",
            where=str(path),
            got=text,
            hint="give yourself the right to write there, or copy the store's folder" if locked else None,
        )
    return NoRoomError(
        way.what,
        where=str(path),
        expected=needed or "room for the file",
        got=way.got(path, text),
        hint=f"{way.todo_in_store}, and run it again: the store is as it was before",
    )


def with_room_for(error: StoreError, path: str, size_bytes: int) -> StoreError:
    """The same error; where there is no room, with how much a log of so many bytes takes in a store."""
    if not isinstance(error, NoRoomError):
        return error
    # raw Parquet takes about as much as the log, and the tidy layer as much again
    needed = f"about {max(1, 2 * size_bytes // 1_000_000)} MB for {path}"
    return NoRoomError(error.what, where=error.where, expected=needed, got=error.got, hint=error.hint)


@contextlib.contextmanager
def whole_file(target: Path, suffix: str = "") -> Iterator[Path]:
    """A path to write to, beside a file that somebody takes away; it appears under its own name once all is written,
    and nothing is left otherwise. suffix: of the path, for a library that goes by it. ThermodataError with the file and
    the room that is left where it can't be written."""
    part = target.with_name(f".{target.name}.{os.getpid()}.part{suffix}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        yield part
        _to_disk(part)
        part.replace(target)
    except OSError as error:
        raise not_written(target, error) from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()


def not_written(target: Path, error: OSError) -> ThermodataError:
    """What is said where a file outside of the store can't be written: it is not there, or as it was before."""
    way = no_room(error)
    if way is not None:
        return NoRoomError(
            way.what,
            where=str(target.absolute()),
            expected="room for the file",
            got=way.got(target, _first_line(error)),
            hint=f"{way.todo}, or name a file on another disk; nothing half-written is left",
        )
    refused = error.errno in (errno.EACCES, errno.EPERM, errno.EROFS)
    return ThermodataError(
        "no right to write there" if refused else "the file cannot be written",
        where=str(target.absolute()),
        got=_first_line(error),
        hint="name a folder of your own, or give yourself the right" if refused else "name another file",
    )


def _first_line(error: Exception) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__


def is_whole(path: Path | str, size_bytes: int | None = None) -> bool:
    """Whether a Parquet file is there with its beginning and its end, and as long as it was: not whether a byte in
    it was changed."""
    try:
        # by the system's own calls: every ingest asks for every file of the store
        fd = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
        try:
            size = os.fstat(fd).st_size
            if size < 12 or (size_bytes is not None and size != size_bytes):
                return False
            begun = os.read(fd, 4)
            os.lseek(fd, size - 8, os.SEEK_SET)
            tail = os.read(fd, 8)
        finally:
            os.close(fd)
    except OSError:
        return False
    return begun == tail[4:] == b"PAR1" and int.from_bytes(tail[:4], "little") + 12 <= size


def publish(part: Path, target: Path) -> None:
    """Makes a finished temporary file appear under its name, on the disk and not only in its cache.

    StoreError where there is no room or no right."""
    try:
        _to_disk(part)
        part.replace(target)
        _unfinished.discard(part)
        fsync_folder(target.parent)
    except OSError as error:
        raise write_error(target, error) from error


def _to_disk(part: Path) -> None:
    """What is written, before it gets its name: else a power cut leaves an empty file under it."""
    fd = os.open(part, os.O_RDWR)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def fsync_folder(folder: Path) -> None:
    """Writes a folder's entries to the disk, where the system knows that."""
    if os.name != "posix":
        return
    fd = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def write_text(target: Path, text: str) -> None:
    """A small text file, replaced at once."""
    part = temporary(target)
    try:
        part.write_text(text, encoding="utf-8")
        publish(part, target)
    except OSError as error:
        raise write_error(target, error) from error
    finally:
        part.unlink(missing_ok=True)


def key_of(*parts: str) -> str:
    """A content key of texts: 32 hexadecimal digits."""
    told = [x for data in map(str.encode, parts) for x in (b"%d:" % len(data), data)]
    return hashlib.sha256(b"".join(told)).hexdigest()[:32]


def plain_name(text: str, letters: str = r"\w.-") -> str:
    """A name of any text, without what leads elsewhere: what is none of `letters` (as in a pattern's brackets) becomes
    '_', once. It may be the name of another text too (`safe_name` is not)."""
    return re.sub(r"_+", "_", re.sub(f"[^{letters}]", "_", text)).strip("_.-") or "x"


def safe_name(text: str, limit: int = 60) -> str:
    """A file name part of any text: what is not a plain letter becomes '-', and a digest keeps it unique."""
    plain = re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip(".-")[:limit]
    return plain if plain == text else f"{plain or 'x'}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"
