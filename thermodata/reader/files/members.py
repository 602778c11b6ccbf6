"""The files in a ZIP archive, each under a path of its own: 'day.zip/run.csv' is no file, and reads as one."""

from __future__ import annotations

import os
import zipfile
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path, PurePosixPath

from thermodata.errors import FormatError
from thermodata.reader.files.regular import opened
from thermodata.reader.files.too_much import most_of
from thermodata.schema.words.sentences import with_count

SUFFIX = ".zip"
_MAGIC = (b"PK\x03\x04", b"PK\x05\x06")  # the latter of one that holds nothing
_MOST = 20_000  # files in an archive
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2)  # others unpack in what memory they ask for
_SHOWN = 3


@dataclass(frozen=True, slots=True)
class Listed:
    """What an archive holds. sizes: name -> bytes, unpacked; refused: name -> why it is not read."""

    archive: str
    sizes: dict[str, int] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    stored: dict[str, str] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.sizes)

    def why(self) -> str:
        """Why what is refused is."""
        return with_count([f"{name!r}: {why}" for name, why in self.refused.items()], _SHOWN) or "nothing"

    def member(self, name: str) -> str:
        """The name of a file as the archive has it. FormatError where it may not be read, FileNotFoundError where there
        is none."""
        if name in self.refused:
            raise FormatError(
                "a file in an archive that is not read",
                where=f"{self.archive}/{name}",
                expected="a log",
                got=self.refused[name],
                hint="unpack it yourself, beside the others",
            )
        if name not in self.stored:
            raise FileNotFoundError(2, "no such file in the archive", f"{self.archive}/{name}")
        return self.stored[name]


def is_archive(path: Path) -> bool:
    """Whether a file is a ZIP archive, by its name and its first bytes."""
    if path.suffix.lower() != SUFFIX or not path.is_file():
        return False
    with opened(path) as file:
        return file.read(4) in _MAGIC


def each_in(path: Path) -> list[Path]:
    """The files in an archive, those too that are not read; any other file alone, and an archive that can't be read."""
    try:
        if not is_archive(path):
            return [path]
        found = listed(path)
    except (FormatError, OSError):
        return [path]
    return [path / name for name in (*found.names, *found.refused)] or [path]


def archive_of(path: Path) -> tuple[Path, str] | None:
    """(archive, the name of a file in it) of a path that leads into one; None for any other."""
    if SUFFIX not in str(path).lower():
        return None
    for above in path.parents:
        if above.suffix.lower() == SUFFIX and above.is_file():
            return above, path.relative_to(above).as_posix()
    return None


def standing(path: Path) -> Path:
    """The file on the disk that a path leads to, or into."""
    inside = archive_of(path)
    return path if inside is None else inside[0]


def size_of(path: Path) -> int:
    """How many bytes a file has, or one in an archive. OSError where it is not there, FormatError where the archive
    can't be read."""
    inside = archive_of(path)
    if inside is None:
        return os.stat(path).st_size
    found = listed(inside[0])
    found.member(inside[1])
    return found.sizes[inside[1]]


def is_there(path: Path) -> bool:
    """Whether a path leads to a file, or to one in an archive."""
    try:
        return path.is_file() or (archive_of(path) is not None and size_of(path) >= 0)
    except (OSError, FormatError):
        return False


def same(status: os.stat_result) -> tuple[int, ...]:
    """What changes with a file's content."""
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def listed(archive: Path) -> Listed:
    """The files in an archive, in its order; without hidden ones. FormatError where it is damaged, or holds too much to
    be one of logs."""
    return _listed(str(archive), same(archive.stat()))


@lru_cache(maxsize=64)
def _listed(archive: str, mark: tuple[int, ...]) -> Listed:
    name, size = Path(archive).name, mark[2]
    try:
        with zipfile.ZipFile(archive) as zipped:
            members = [m for m in zipped.infolist() if not m.is_dir()]
    except (zipfile.BadZipFile, ValueError, NotImplementedError, EOFError) as error:
        raise FormatError(
            "an archive that can't be read", where=name, expected="a ZIP archive that is whole", got=str(error)
        ) from None
    whole = sum(m.file_size for m in members)
    if len(members) > _MOST or whole > most_of(size):
        raise FormatError(
            "an archive that unpacks to more than logs do",
            where=name,
            expected=f"at most {_MOST} files and {most_of(size)} bytes",
            got=f"{len(members)} files and {whole} bytes",
            hint="unpack it yourself, beside the others",
        )
    found = Listed(name)
    for m in members:
        path = m.filename.replace("\\", "/").removeprefix("./")
        parts = path.split("/")
        if any(p.startswith((".", "~$")) and p != ".." for p in parts) or "__MACOSX" in parts:
            continue
        if (why := _refused(m, path, found)) is not None:
            found.refused[path.lstrip("/").replace(":", "_")] = why
        else:
            found.sizes[path], found.stored[path] = m.file_size, m.filename
    return found


def _refused(member: zipfile.ZipInfo, path: str, found: Listed) -> str | None:
    """Why a file in an archive is not read; None where it is."""
    pure = PurePosixPath(path)
    if pure.is_absolute() or ".." in pure.parts or ":" in path or not path.isprintable() or str(pure) != path:
        return "its name leads elsewhere"
    if len(os.fsencode(pure.name)) > 200:
        return "its name is too long"
    if path in found.stored:
        return "there are two of this name"
    if member.flag_bits & 1:
        return "it is encrypted"
    if member.compress_type not in _METHODS:
        return "it is packed in an unusual way"
    return None
