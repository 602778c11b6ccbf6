"""Packed logs that lie beside what they were packed of, and archives that hold no log at all."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path, PurePosixPath

from thermodata.archive.members import archive_of, listed, size_of
from thermodata.archive.unpacked import held
from thermodata.errors import FormatError
from thermodata.reader.files.rotated import as_unpacked
from thermodata.schema.words.sentences import with_count

_SHOWN = 3
_NUMBER = re.compile(r"\d")


def packed_copies(folder: Path, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
    """Packed file -> the one that is called as it was before, and holds the same: 'a.csv.gz' -> 'a.csv',
    'day.zip/a.csv' -> 'day/a.csv', 'a.csv.xz' -> 'a.csv.gz' beside it. Of two archives only where all that is in one
    is in the other, or all that is called alike in both is equal and has a number in its name, as 'T3.csv' of a day in
    the week's: logs of two tests may well be equal, as a speed that both were told."""
    size, digest = cache(partial(_size, folder)), cache(partial(_digest, folder))
    new = partial(_Known, size, digest)
    known = new()
    archives: dict[Path, list[PurePosixPath]] = {}
    alone = []
    for path in paths:
        if (inside := archive_of(folder / path)) is not None:
            archives.setdefault(inside[0], []).append(path)
        elif as_unpacked(path) != path:
            alone.append(path)
        else:
            known.add(path)
    found = {p: of for p in alone if (of := known.like(p)) is not None}
    beside: dict[PurePosixPath, _Known] = {}
    for path in (p for p in alone if p not in found):
        if (of := beside.setdefault(path.parent, new()).like(path)) is not None:
            found[path] = of
        else:
            beside[path.parent].add(path)
    for path in (p for p in alone if p not in found):
        known.add(path)
    whole: list[_Known] = []
    for files in sorted(archives.values(), key=len, reverse=True):
        copies = {p: of for p in files if (of := known.like(p)) is not None}
        rest = [p for p in files if p not in copies]
        found |= copies | (
            next((again for other in whole if (again := other.all_like(rest))), {})
            or {p: of for other in whole for p, of in other.shared_with(rest).items()}
        )
        whole.append(new())
        for path in (p for p in rest if p not in found):
            whole[-1].add(path)
    return found


def cut_archives(folder: Path, paths: Iterable[PurePosixPath]) -> list[tuple[str, str]]:
    """(archive, what is lost of it), of those that end behind a file without an end mark."""
    inside = (archive_of(folder / path) for path in paths)
    archives = dict.fromkeys(found[0] for found in inside if found is not None)
    return [(a.relative_to(folder).as_posix(), lost) for a in archives if (lost := listed(a).lost) is not None]


class _Known:
    """Files by the names of their logs."""

    def __init__(
        self, size: Callable[[PurePosixPath], int | None], digest: Callable[[PurePosixPath], bytes | None]
    ) -> None:
        self._size, self._digest, self._named = size, digest, dict[str, list[PurePosixPath]]()

    def add(self, path: PurePosixPath) -> None:
        self._named.setdefault(as_unpacked(path).name, []).append(path)

    def like(self, path: PurePosixPath) -> PurePosixPath | None:
        """One that is called as the file was before it was packed, and holds the same."""
        fits = self._fitting(path)
        mine = self._digest(path) if fits else None
        return next((o for o in fits if self._digest(o) == mine is not None), None)

    def all_like(self, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
        """The same of all that can be read in an archive; none where one has no such file."""
        paths = [p for p in paths if self._size(p) is not None]
        if not all(map(self._fitting, paths)):
            return {}
        found: dict[PurePosixPath, PurePosixPath] = {}
        for path in paths:
            if (of := self.like(path)) is None:
                return {}
            found[path] = of
        return found

    def shared_with(self, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
        """The same of what one archive shares with another in part; none where a file of one name differs: such names
        are those of any test."""
        both = [p for p in paths if as_unpacked(p).name in self._named]
        found = {p: of for p in both if _NUMBER.search(as_unpacked(p).stem) and (of := self.like(p)) is not None}
        return found if len(found) == len(both) else {}

    def _fitting(self, path: PurePosixPath) -> list[PurePosixPath]:
        """Those of its name that may hold the same, by their sizes."""
        size, named = self._size(path), self._named.get(as_unpacked(path).name, ())
        return [o for o in named if size is None or self._size(o) in (size, None)]


def _size(folder: Path, path: PurePosixPath) -> int | None:
    """How long a log is, unpacked; None where it can't be read, or only unpacking it would tell."""
    if archive_of(folder / path) is None and as_unpacked(path) != path:
        return None
    try:
        return size_of(folder / path)
    except (FormatError, OSError):
        return None


def _digest(folder: Path, path: PurePosixPath) -> bytes | None:
    try:
        with held(folder / path) as real, real.open("rb") as file:
            return hashlib.file_digest(file, "sha256").digest()
    except (FormatError, OSError):
        return None


def by_archive(
    folder: Path, ignored: Sequence[tuple[str, str]], failed: Collection[str], logs: Collection[str]
) -> list[tuple[str, str]]:
    """What is ignored, with one line for an archive of which nothing is a log. failed: files that a reader claims."""
    inside: dict[str, list[tuple[str, str]]] = {}
    for path, why in ignored:
        if (of := archive_of(folder / path)) is not None:
            inside.setdefault(of[0].relative_to(folder).as_posix(), []).append((path, why))
    whole: Mapping[str, list[tuple[str, str]]] = {
        archive: told
        for archive, told in inside.items()
        if len(told) > 1 and not any(p.startswith(f"{archive}/") for p in (*failed, *logs))
    }
    out: dict[str, str] = {}
    for path, why in ignored:
        archive = next((a for a in whole if path.startswith(f"{a}/")), None)
        if archive is None:
            out[path] = why
        elif archive not in out:
            named = with_count([p.removeprefix(f"{archive}/") for p, _ in whole[archive]], _SHOWN)
            out[archive] = f"no file in it is read as a log ({named}): {whole[archive][0][1]}"
    return list(out.items())
