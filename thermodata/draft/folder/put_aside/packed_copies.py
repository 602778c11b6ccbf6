"""Packed logs that lie beside what they were packed of, and archives that hold no log at all."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from pathlib import Path, PurePosixPath

from thermodata.archive.members import archive_of, size_of
from thermodata.archive.unpacked import held
from thermodata.errors import FormatError
from thermodata.reader.files.rotated import as_unpacked
from thermodata.schema.words.sentences import with_count

_SHOWN = 3
_NUMBER = re.compile(r"\d+")


def packed_copies(folder: Path, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
    """Packed file -> the one that is called as it was before, and holds the same: 'a.csv.gz' -> 'a.csv',
    'day.zip/a.csv' -> 'day/a.csv', 'a.csv.xz' -> 'a.csv.gz' beside it. Of two archives only where all that is in one
    is in the other, or all that stands at one place in both is equal and has a number that counts tests, as 'T3.csv' of
    a day in the week's: logs of two tests may well be equal, as a speed that both were told."""
    asked = _OncePerFile(folder)
    known = _ByLogName(asked)
    archives: dict[Path, dict[str, PurePosixPath]] = {}
    alone = []
    for path in paths:
        if (inside := archive_of(folder / path)) is not None:
            archives.setdefault(inside[0], {})[inside[1]] = path
        elif as_unpacked(path) != path:
            alone.append(path)
        else:
            known.add(path)
    found = {p: of for p in alone if (of := known.like(p)) is not None}
    beside: dict[PurePosixPath, _ByLogName] = {}
    for path in (p for p in alone if p not in found):
        if (of := beside.setdefault(path.parent, _ByLogName(asked)).like(path)) is not None:
            found[path] = of
        else:
            beside[path.parent].add(path)
    for path in (p for p in alone if p not in found):
        known.add(path)
    others = _Archives(asked)
    for archive in (_Archive(files) for files in sorted(archives.values(), key=len, reverse=True)):
        found |= {p: of for p in archive.files.values() if (of := known.like(p)) is not None}
        rest = {inside: p for inside, p in archive.files.items() if p not in found}
        found |= others.with_all(rest.values()) or others.sharing(archive, rest)
        others.add(archive, {inside: p for inside, p in rest.items() if p not in found})
    return found


class _OncePerFile:
    """What is asked of files, once each."""

    def __init__(self, folder: Path) -> None:
        self.size, self.digest = cache(partial(_size, folder)), cache(partial(_digest, folder))
        self.name = cache(_name)

    def may_be(self, path: PurePosixPath, of: PurePosixPath) -> bool:
        """Whether two may hold the same, by their sizes."""
        size = self.size(path)
        return size is None or self.size(of) in (size, None)

    def are_equal(self, path: PurePosixPath, of: PurePosixPath) -> bool:
        return self.may_be(path, of) and self.digest(path) == self.digest(of) is not None


class _ByLogName:
    """Files by the names of their logs."""

    def __init__(self, asked: _OncePerFile) -> None:
        self._asked, self._named = asked, dict[str, list[PurePosixPath]]()

    def add(self, path: PurePosixPath) -> None:
        self._named.setdefault(self._asked.name(path), []).append(path)

    def may_have(self, path: PurePosixPath) -> bool:
        """Whether one that is called as the file was before it was packed may hold the same."""
        return any(self._asked.may_be(path, of) for of in self._named.get(self._asked.name(path), ()))

    def like(self, path: PurePosixPath) -> PurePosixPath | None:
        """One that is called so, and holds the same."""
        return next((o for o in self._named.get(self._asked.name(path), ()) if self._asked.are_equal(path, o)), None)

    def all_like(self, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
        """The same of all of them; none where one has no such file."""
        if not all(map(self.may_have, paths)):
            return {}
        found: dict[PurePosixPath, PurePosixPath] = {}
        for path in paths:
            if (of := self.like(path)) is None:
                return {}
            found[path] = of
        return found


@dataclass(frozen=True, eq=False)
class _Archive:
    """files: by their paths within it."""

    files: Mapping[str, PurePosixPath]

    def counts_beside(self, other: _Archive, inside: str) -> bool:
        """Whether a number in a path counts tests: the same path has another one in one of two archives, as T1 to T3
        and T3 to T5; 'axis1.csv' of each test has not."""
        pattern = _pattern(inside)
        return self._patterns[pattern] != other._patterns[pattern]

    @cached_property
    def _patterns(self) -> dict[str, set[str]]:
        found: dict[str, set[str]] = {}
        for inside in self.files:
            found.setdefault(_pattern(inside), set()).add(inside)
        return found


class _Archives:
    """Those that were looked at, by what is no copy in them: an archive is held only against such as share a name."""

    def __init__(self, asked: _OncePerFile) -> None:
        self._asked = asked
        self._named: dict[str, list[_ByLogName]] = {}
        self._at: dict[str, list[tuple[_Archive, PurePosixPath]]] = {}

    def add(self, archive: _Archive, files: Mapping[str, PurePosixPath]) -> None:
        """files: those in it that are no copies, by their paths within it."""
        known = _ByLogName(self._asked)
        for inside, path in files.items():
            known.add(path)
            self._at.setdefault(inside, []).append((archive, path))
        for name in {self._asked.name(path) for path in files.values()}:
            self._named.setdefault(name, []).append(known)

    def with_all(self, paths: Iterable[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
        """The same, in one other archive, of all that can be read in one; none where no other has all."""
        paths = [p for p in paths if self._asked.size(p) is not None]
        others: list[_ByLogName] = min((self._named.get(self._asked.name(p), []) for p in paths), key=len, default=[])
        return next((again for other in others if (again := other.all_like(paths))), {})

    def sharing(self, archive: _Archive, files: Mapping[str, PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
        """The same of what an archive shares in part with others; none with one where a file at one place differs, or
        its path is that of any test. files: those of it that are no copies yet."""
        shared: dict[_Archive, dict[str, PurePosixPath]] = {}
        for inside in files:
            for other, of in self._at.get(inside, ()):
                shared.setdefault(other, {})[inside] = of
        return {
            files[inside]: of
            for other, both in shared.items()
            if all(archive.counts_beside(other, inside) for inside in both)
            and all(self._asked.are_equal(files[inside], of) for inside, of in both.items())
            for inside, of in both.items()
        }


def _pattern(inside: str) -> str:
    return _NUMBER.sub("#", inside)


def _name(path: PurePosixPath) -> str:
    """What a log is called that was packed alone, or not."""
    return as_unpacked(path).name


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
