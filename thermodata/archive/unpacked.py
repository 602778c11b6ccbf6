"""Packed logs as readers see them: unpacked into a folder of this process, which goes with it.

A file packed alone keeps its name, 'run.csv.gz'. In a ZIP or TAR archive each file is one of its own,
'day.zip/run.csv'. Both are known by their names too: formats of their own are packed, as NumPy's .npz. What stands on
the disk is never touched, and is not trusted: what would take the disk is refused before it does.
"""

from __future__ import annotations

import atexit
import lzma
import os
import shutil
import threading
import zipfile
import zlib
from collections import OrderedDict
from collections.abc import Callable, Generator, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from thermodata.archive.members import ARCHIVES, archive_of, file_state, is_archive, is_archive_name, listed
from thermodata.archive.packed_by import how_to_unpack, is_tar, packed, packed_by
from thermodata.archive.packers import OPEN, SUFFIXES
from thermodata.archive.process_folder import process_folder
from thermodata.archive.regular import opened
from thermodata.archive.too_much import MOST_BYTES, most_of, no_room
from thermodata.errors import FormatError

_PART = 1 << 20
_KEPT_BYTES, _KEPT = 4 << 30, 64  # what was unpacked last is likely to be asked for again
PACKED = (*SUFFIXES, *(end for end in ARCHIVES if end.count(".") == 1))
"""The last suffixes of files that are packed."""


@dataclass(slots=True)
class _Copy:
    """A file as it was before it was packed. cut: it is packed alone, and ends too early. held: by how many it is being
    read."""

    path: Path
    size: int
    cut: bool
    held: int = 0


_copies: OrderedDict[tuple[object, ...], _Copy] = OrderedDict()
_lock = threading.RLock()
_folder: Path | None = None
_count = 0


def unpacked(path: Path) -> Path:
    """Where the bytes of a log can be read: the path itself, unless it is packed. Good until some more are asked for.

    FormatError for what cannot be unpacked, or unpacks to too much, or holds several files.
    """
    with held(path) as real:
        return real


@contextmanager
def held(path: Path) -> Iterator[Path]:
    """The same, for as long as it takes."""
    where = _packed_in(path)
    if where is None:
        yield path
        return
    with _lock:
        copy = _copy(*where)
        copy.held += 1
    try:
        yield copy.path
    finally:
        with _lock:
            copy.held -= 1


def cut_off(path: Path) -> str | None:
    """What is cut off of a log, so that what was unpacked is its beginning: the file that it was packed in alone, or
    the archive. None where nothing is."""
    where = _packed_in(path)
    if where is None:
        return None
    if where[1]:
        return "the archive ends within this file" if listed(where[0]).cut == where[1] else None
    with _lock:
        return "the packed file is cut off" if _copy(*where).cut else None


def forget_unpacked() -> None:
    """Deletes all that was unpacked here: for a process that ends without a word."""
    global _folder
    with _lock:
        _copies.clear()
        if _folder is not None:
            shutil.rmtree(_folder, ignore_errors=True)
            _folder = None


def _forked() -> None:
    """What was unpacked before a fork stays the parent's, as do its open archives, whose places both would move."""
    global _folder, _lock
    _lock = threading.RLock()  # a thread that is not here may hold the other
    _copies.clear()
    _folder = None
    _zipped.cache_clear()


atexit.register(forget_unpacked)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forked)


def _packed_in(path: Path) -> tuple[Path, str] | None:
    """(the packed file, the file in it, '' where it is packed alone); None where nothing is packed."""
    if (inside := archive_of(path)) is not None:
        return inside
    if path.suffix.lower() not in PACKED or not path.is_file():
        return None
    if not is_archive_name(path.name):
        with opened(path) as file:
            return (path, "") if packed_by(file.read(16)) in OPEN else None
    if not is_archive(path):
        return None
    names = listed(path).names
    if len(names) != 1:
        raise FormatError(
            "an archive of several files" if names else "an archive without a file that can be read",
            where=path.name,
            expected="one log",
            got=", ".join((*names[:3], *["..."] * (len(names) > 3))) or listed(path).why(),
            hint=f"name what is in it: files: '{path.name}/*', or '{path.name}/{names[0]}'" if names else None,
        )
    return path, names[0]


def _copy(archive: Path, name: str) -> _Copy:
    status = archive.stat()
    key = (str(archive), name, *file_state(status))
    if key in _copies:
        _copies.move_to_end(key)
        return _copies[key]
    with _unpacked_archive(archive, name):
        _drop_unread(lambda: len(_copies) < _KEPT and sum(c.size for c in _copies.values()) <= _KEPT_BYTES)
        made = _unpack(archive, name, status)
    _copies[key] = made
    return made


@contextmanager
def _unpacked_archive(archive: Path, name: str) -> Iterator[Path]:
    """Where the bytes of an archive of a file are. A packed TAR archive is unpacked as a whole, once, and not anew for
    each of its files: its copy stays while one is taken out."""
    if not name or archive.suffix.lower() == ".zip" or not _is_packed(archive):
        yield archive
        return
    copy = _copy(archive, "")
    copy.held += 1
    try:
        yield copy.path
    finally:
        copy.held -= 1


def _is_packed(archive: Path) -> bool:
    with opened(archive) as file:
        return packed_by(file.read(16)) is not None


def _drop_unread(enough: Callable[[], bool]) -> None:
    """Drops what nobody reads, from what was asked for longest ago on, until it is enough."""
    for old, copy in list(_copies.items()):
        if enough():
            break
        if not copy.held:
            shutil.rmtree(copy.path.parent, ignore_errors=True)
            del _copies[old]


def _unpack(archive: Path, name: str, status: os.stat_result) -> _Copy:
    """Unpacks a file, under the name that it had, with the time of what it was packed in."""
    global _folder, _count
    if _folder is None:
        _folder = process_folder("unpacked")
    _count += 1
    place = _folder / str(_count)
    place.mkdir()
    target = place / (name.rpartition("/")[2] or archive.stem)
    where = f"{archive.name}/{name}" if name else archive.name
    most = MOST_BYTES if name else most_of(status.st_size)  # an archive says how much it holds, and gives no more
    try:
        size, cut = _write_parts(_parts(archive, name), target, where, most, whole=bool(name))
        with target.open("rb") as file:
            start = file.read(512)
        inner = packed_by(start) or ("ZIP" if packed(start) is not None else "TAR" if is_tar(start) else None)
        if inner is not None and (name or inner != "TAR" or not is_archive_name(archive.name)):
            raise FormatError(
                "packed more than once",
                where=where,
                expected="a log",
                got=inner,
                hint=f"unpack it beside the others: {how_to_unpack(_packer(archive, name), archive.name)}",
            )
    except BaseException:
        shutil.rmtree(place, ignore_errors=True)
        raise
    os.utime(target, ns=(status.st_atime_ns, status.st_mtime_ns))
    return _Copy(target, size, cut)


def _packer(archive: Path, name: str) -> str:
    if name:
        return "ZIP" if archive.suffix.lower() == ".zip" else "tar"
    with opened(archive) as file:
        return packed_by(file.read(16)) or "gzip"


def _write_parts(parts: Generator[bytes], target: Path, where: str, most: int, whole: bool) -> tuple[int, bool]:
    """(bytes, whether they are the beginning of what was packed, for its end is cut off). whole: it may not be."""
    size = 0
    try:
        with closing(parts), target.open("wb") as out:
            for part in parts:
                size += len(part)
                if no_room(target):
                    _drop_unread(lambda: not no_room(target))
                if size > most or no_room(target):
                    raise FormatError(
                        "unpacks to more than a log does" if size > most else "no room to unpack it",
                        where=where,
                        expected=f"at most {most} bytes" if size > most else f"room in {target.parent.parent.parent}",
                        got=f"{size} bytes, and more",
                        hint="unpack it yourself, beside the others" + ("" if size > most else ", or set TMPDIR"),
                    )
                out.write(part)
    except EOFError as error:
        if whole or not size:
            raise _damaged(where, error) from None
        return size, True
    except (zipfile.BadZipFile, zlib.error, lzma.LZMAError, RuntimeError, NotImplementedError, ValueError) as error:
        raise _damaged(where, error) from None
    except OSError as error:
        if error.errno is not None:  # of the disk
            raise
        raise _damaged(where, error) from None  # what gzip and bzip2 say of their data
    return size, False


def _damaged(where: str, error: Exception) -> FormatError:
    return FormatError("a packed file that is damaged", where=where, expected="all that was packed", got=str(error))


def _parts(archive: Path, name: str) -> Generator[bytes]:
    if not name:
        with opened(archive) as file:
            packer = packed_by(file.read(16)) or ""
            file.seek(0)
            with closing(OPEN[packer](file)) as stream:
                while part := stream.read1(_PART):
                    yield part
        return
    found = listed(archive)
    member = found.member(name)
    if archive.suffix.lower() != ".zip":
        yield from _of_tar(archive, name, found.at[name], found.sizes[name])
        return
    with _zipped(str(archive), file_state(archive.stat())).open(member) as stream:
        while part := stream.read(_PART):
            yield part


def _of_tar(archive: Path, name: str, at: int, size: int) -> Iterator[bytes]:
    with _unpacked_archive(archive, name) as real, real.open("rb") as file:
        file.seek(at)
        while size:
            part = file.read(min(size, _PART))
            if not part:
                raise EOFError("the archive ends within the file")
            size -= len(part)
            yield part


@lru_cache(maxsize=4)
def _zipped(archive: str, mark: tuple[int, ...]) -> zipfile.ZipFile:
    """An archive, whose directory is read once."""
    return zipfile.ZipFile(archive)
