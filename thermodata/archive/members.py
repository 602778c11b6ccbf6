"""The files in a ZIP or TAR archive, each under a path of its own: 'day.zip/run.csv' is no file, and reads as one."""

from __future__ import annotations

import lzma
import os
import re
import tarfile
import zipfile
import zlib
from collections import Counter
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path, PurePosixPath

from thermodata.archive.packed_by import is_tar, packed_by
from thermodata.archive.packers import OPEN
from thermodata.archive.regular import opened
from thermodata.archive.tarred import Member, Tarred, tarred
from thermodata.archive.too_much import MOST_FILES, more_than_logs, most_of
from thermodata.errors import FormatError

_ZIP = ".zip"
ARCHIVES = (_ZIP, ".tar", ".tgz", ".tbz2", ".txz", ".tar.gz", ".tar.bz2", ".tar.xz")
"""What the names of archives end with, in lower case."""
_MAGIC = (b"PK\x03\x04", b"PK\x05\x06")  # the latter of one that holds nothing
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2)  # others unpack in what memory they ask for
_NO_COLON = os.name == "nt"  # in names of files
_DRIVE = re.compile("[A-Za-z]:/")
_SHOWN = 3
_WRONG = (
    zipfile.BadZipFile,
    tarfile.TarError,
    zlib.error,
    lzma.LZMAError,
    ValueError,
    EOFError,
    NotImplementedError,
)  # of an archive


@dataclass(frozen=True, slots=True)
class Listed:
    """What an archive holds. sizes: name -> bytes, unpacked; refused: name -> why it is not read; stored: name -> as
    the archive has it; at: name -> where it begins in a TAR archive, unpacked. cut: the name of a file within which the
    archive ends; ended: whether its end mark is there; torn: whether it is known to be cut off where none is."""

    archive: str
    sizes: dict[str, int] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    stored: dict[str, str] = field(default_factory=dict)
    at: dict[str, int] = field(default_factory=dict)
    cut: str | None = None
    ended: bool = True
    torn: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.sizes)

    def why(self) -> str:
        """Why what is refused is."""
        told = [f"{name!r}: {why}" for name, why in self.refused.items()]
        more = f" and {len(told) - _SHOWN} more" if len(told) > _SHOWN else ""
        return ", ".join(told[:_SHOWN]) + more or "nothing"

    @property
    def lost(self) -> str | None:
        """What is lost, or may be, of an archive without its end mark; None where it is there."""
        if self.ended:
            return None
        if self.cut is not None:
            return f"the archive ends within {self.cut!r}: the rest of it, and what stood behind, is lost"
        behind = f"behind {self.names[-1]!r}" if self.names else "behind its last file"
        if self.torn:
            return f"the archive is cut off {behind}: what stood there is lost"
        return f"the archive has no end mark {behind}: if more stood there, it is lost"

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


def is_archive_name(name: str) -> bool:
    """Whether a file is called as archives are."""
    return name.lower().endswith(ARCHIVES)


def is_archive(path: Path) -> bool:
    """Whether a file is an archive, by its name and its first bytes."""
    if not is_archive_name(path.name) or not path.is_file():
        return False
    with opened(path) as file:
        start = file.read(512)
    if path.suffix.lower() == _ZIP:
        return start[:4] in _MAGIC
    return is_tar(start) or packed_by(start) in OPEN


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
    whole = str(path).lower()
    if not any(f"{end}{os.sep}" in whole for end in ARCHIVES):
        return None
    for above in path.parents:
        if is_archive_name(above.name) and above.is_file():
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


def file_state(status: os.stat_result) -> tuple[int, ...]:
    """What changes with a file's content."""
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def listed(archive: Path) -> Listed:
    """The files in an archive, in its order; without hidden ones. FormatError where it is damaged, or holds too much to
    be one of logs."""
    return _list_archive(str(archive), file_state(archive.stat()))


@lru_cache(maxsize=64)
def _list_archive(archive: str, mark: tuple[int, ...]) -> Listed:
    name, most = Path(archive).name, most_of(mark[2])
    kind = "ZIP" if name.lower().endswith(_ZIP) else "TAR"
    try:
        held = Tarred(_zipped(archive)) if kind == "ZIP" else tarred(Path(archive), most)
    except OSError as error:
        if error.errno is not None:  # of the disk
            raise
        raise _error_of_archive(name, kind, error) from None
    except _WRONG as error:
        raise _error_of_archive(name, kind, error) from None
    members = held.members
    whole = sum(m.size for m in members)
    if len(members) > MOST_FILES or whole > most:
        raise more_than_logs(name, most, len(members), whole)
    cut = next((_path(m) for m in members if m.cut), None)
    found = Listed(name, cut=cut, ended=held.ended, torn=held.torn)
    last, again = {_path(m): m for m in members}, "there are two of this name"
    twice = {path for path, n in Counter(map(_path, members)).items() if n > 1 and kind == "ZIP"}
    for m in members:
        path = _path(m)
        parts = path.split("/")
        if any(p.startswith((".", "~$")) and p != ".." for p in parts) or "__MACOSX" in parts:
            continue
        if kind == "TAR" and m is not last[path]:  # as 'tar -r' and 'tar -u' leave it, and unpacking takes the last
            found.refused[f"{path.lstrip('/')} (earlier)"] = "another of its name stands behind it: that one is read"
        elif (why := _misnamed(path) or m.why or (again if path in twice else None)) is not None:
            found.refused[path.lstrip("/").replace(":", "_" if _NO_COLON else ":")] = why
        else:
            found.sizes[path], found.stored[path], found.at[path] = m.size, m.name, m.at
    return found


def _path(member: Member) -> str:
    return member.name.replace("\\", "/").removeprefix("./")


def _error_of_archive(name: str, kind: str, error: Exception) -> FormatError:
    return FormatError(
        "an archive that can't be read", where=name, expected=f"a {kind} archive that is whole", got=str(error)
    )


def _zipped(archive: str) -> list[Member]:
    with zipfile.ZipFile(archive) as zipped:
        return [Member(m.filename, m.file_size, _locked(m)) for m in zipped.infolist() if not m.is_dir()]


def _locked(member: zipfile.ZipInfo) -> str | None:
    if member.flag_bits & 1:
        return "it is encrypted"
    return None if member.compress_type in _METHODS else "it is packed in an unusual way"


def _misnamed(path: str) -> str | None:
    """Why a file in an archive is not read for its name; None where it is."""
    pure = PurePosixPath(path)
    if pure.is_absolute() or ".." in pure.parts or _DRIVE.match(path):
        return "its name leads elsewhere"
    if not path.isprintable():
        return "its name holds what can't be shown"
    if _NO_COLON and ":" in path:
        return "its name holds ':', as no name does here"
    if str(pure) != path:
        return "its name holds '//' or '/./'"
    return "its name is too long" if len(os.fsencode(pure.name)) > 200 else None
