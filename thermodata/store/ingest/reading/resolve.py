"""Which files belong to a test and a source. Paths stay inside the campaign's folder, through symlinks too."""

from __future__ import annotations

import glob
import os
import re
import stat
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path, PurePosixPath

from thermodata.archive.members import standing
from thermodata.archive.patterns import as_regex, in_archives
from thermodata.archive.regular import kind_of
from thermodata.errors import SpecError
from thermodata.reader.files.rotated import age, unrotated
from thermodata.schema.files.campaign import Campaign, Test
from thermodata.schema.strict.lines import is_text


@dataclass(frozen=True, slots=True)
class SourceFiles:
    """The files of one (test, source). paths: relative to the campaign's folder, in natural order. refused:
    (path, reason). shared: the pattern doesn't name the test, so that other tests have the same files. odd: path ->
    the name on the disk, where that is no valid text."""

    patterns: tuple[str, ...]
    paths: tuple[str, ...]
    refused: tuple[tuple[str, str], ...]
    shared: bool
    explicit: bool
    odd: Mapping[str, str] = field(default_factory=dict)

    def isdisjoint(self, paths: Collection[str]) -> bool:
        """Whether it has none of the files."""
        return not any(path in paths for path in self.paths)

    def in_order(self, paths: Iterable[str]) -> list[str]:
        """Paths, also of files that are no longer there, as the patterns list them, and under each as names count."""
        listed = {path: k for k, path in enumerate(self.paths)}
        paths = list(paths)
        if all(path in listed for path in paths):
            return sorted(paths, key=listed.__getitem__)
        return sorted(paths, key=lambda path: (_number_of_pattern(self.patterns, path), *_in_order(path)))

    def claims(self, path: str) -> bool:
        """Whether a path that is no longer there would still belong."""
        return _number_of_pattern(self.patterns, path) < len(self.patterns)


def patterns_of(campaign: Campaign, test: Test, source: str) -> tuple[tuple[str, ...], bool, bool]:
    """(glob patterns, shared, explicit) of a source in a test; no patterns where it has no files."""
    own = test.files.get(source)
    declared = own if own is not None else campaign.sources[source].files
    if declared is None:
        return (), False, False
    listed = [declared] if isinstance(declared, str) else list(declared)
    shared = own is None and not any("{test}" in p for p in listed) and not campaign.sources[source].sheet_a_test
    return tuple(_pattern_of_test(p, test.id) for p in listed), shared, own is not None


def resolve(
    folder: Path,
    campaign: Campaign,
    test: Test,
    source: str,
    root: Path | None = None,
    folders: dict[str, str] | None = None,
) -> SourceFiles:
    """The files of a source in a test, as they stand in the campaign's folder now. root: the folder without links,
    where the caller has it; folders: takes those of the files, without links, for the next call."""
    patterns, shared, explicit = patterns_of(campaign, test, source)
    root = root or folder.resolve()
    folders = {} if folders is None else folders
    paths: dict[str, str | None] = {}
    odd: dict[str, str] = {}
    for pattern in patterns:
        # a folder or a pipe that a pattern happens to fit is nobody's log; one that is named is a mistake
        named = not glob.has_magic(pattern)
        fitting = _paths_of_pattern(root, pattern, named)
        for name in sorted(fitting, key=_in_order) if len(fitting) > 1 else fitting:
            relative = PurePosixPath(Path(name)).as_posix()
            if not is_text(relative):
                odd[text := os.fsencode(relative).decode("utf-8", "backslashreplace")] = relative
                relative = text
            if relative not in paths and not relative.endswith(".tdms_index"):
                why = _refusal(root, name, named, folders)
                if why != "":
                    paths[relative] = why
    return SourceFiles(
        patterns,
        tuple(p for p, why in paths.items() if why is None),
        tuple((p, why) for p, why in paths.items() if why is not None),
        shared,
        explicit,
        odd,
    )


def _paths_of_pattern(root: Path, pattern: str, named: bool) -> list[str]:
    """What stands in the folder under a pattern, or under a name, which takes a fifth of the time; and in archives that
    the pattern leads into."""
    if not named:
        return glob.glob(pattern, root_dir=root, recursive=True) + in_archives(root, pattern)
    if not pattern:
        return []
    return [pattern] if os.path.lexists(os.path.join(root, pattern)) else in_archives(root, pattern)


def _refusal(root: Path, name: str, named: bool, folders: dict[str, str]) -> str | None:
    """Why a path isn't read: None where it is a file inside the folder, '' where it need not be mentioned."""
    try:
        real, status = _path_without_links(str(standing(root / name)), folders)
        if real != str(root) and not real.startswith(os.path.join(root, "")):
            return "leads outside the campaign's folder"
        kind = kind_of(status or os.stat(real))
    except FileNotFoundError:
        return "a link to nothing"
    except (OSError, RuntimeError, ValueError) as error:
        return str(getattr(error, "strerror", None) or error)  # a loop of links, a folder that may not be entered
    if kind is None:
        return None
    return "" if kind == "a folder" and not named else f"this is {kind}, not a file"


def _path_without_links(path: str, folders: dict[str, str]) -> tuple[str, os.stat_result | None]:
    """(a path without links, what the system says of it where it is none itself). Thousands of files lie in a few
    folders, which are looked through once."""
    folder, name = os.path.split(path)
    if os.name != "posix" or name in ("", ".", ".."):  # elsewhere there are links that look like none
        return os.path.realpath(path), None
    if folder not in folders:
        folders[folder] = os.path.realpath(folder)
    real = os.path.join(folders[folder], name)
    try:
        status = os.lstat(real)
    except OSError:
        return os.path.realpath(path), None
    return (os.path.realpath(real), None) if stat.S_ISLNK(status.st_mode) else (real, status)


def file_inside(folder: Path, name: str, where: str) -> Path:
    """One declared file, which must lie inside the campaign's folder (it need not exist)."""
    root = folder.resolve()
    _pattern_of_test(name, "", where)
    try:
        real = (root / name).resolve()
    except (OSError, RuntimeError, ValueError) as error:
        raise SpecError(
            "a path that leads nowhere",
            where=where,
            got=f"{name}: {error}",
            hint="correct the path: it counts from the folder of the campaign file",
        ) from error
    if not real.is_relative_to(root):
        raise SpecError(
            "a path leads outside the campaign's folder",
            where=where,
            got=name,
            expected="a file inside the campaign's folder",
            hint="move or link the logs into the folder of the campaign file, or move that file above them",
        )
    return root / name


def _in_order(name: str) -> tuple[list[tuple[int, int, str]], tuple[int, int]]:
    """Names as they are counted, but the pieces of one log that were put aside from the oldest on."""
    path = PurePosixPath(name)
    return natural(unrotated(path).as_posix()), age(path)


def natural(text: str) -> list[tuple[int, int, str]]:
    """Sort key that puts run_2 before run_10."""
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"(\d+)", text) if part]


def _pattern_of_test(pattern: str, test: str, where: str = "files") -> str:
    _check(pattern, where)
    return pattern.replace("{test}", glob.escape(test))


@lru_cache(maxsize=1024)
def _check(pattern: str, where: str) -> None:
    if (
        PurePosixPath(pattern).is_absolute()
        or Path(pattern).is_absolute()
        or re.match(r"^[A-Za-z]:", pattern)
        or ".." in re.split(r"[/\\]", pattern)
    ):
        raise SpecError(
            "a path leads outside the campaign's folder",
            where=where,
            got=pattern,
            expected="a path relative to the campaign file, without '..'",
            hint="put the files into the campaign's folder, or the campaign file above them",
        )


def _number_of_pattern(patterns: tuple[str, ...], path: str) -> int:
    """The number of the first pattern that a path fits, from 0; how many there are where none does."""
    names, globs = _told_apart(patterns)
    named = names.get(path, len(patterns))
    return next((k for k, pattern in globs if k < named and pattern.fullmatch(path)), named)


@lru_cache(maxsize=64)
def _told_apart(patterns: tuple[str, ...]) -> tuple[dict[str, int], list[tuple[int, re.Pattern[str]]]]:
    """(names -> their numbers, the numbers and patterns of what is none), as a test may list thousands of files."""
    names: dict[str, int] = {}
    globs: list[tuple[int, re.Pattern[str]]] = []
    for k, pattern in enumerate(patterns):
        if glob.has_magic(pattern):
            globs.append((k, re.compile(as_regex(pattern))))
        else:
            names.setdefault(PurePosixPath(Path(pattern)).as_posix(), k)
    return names, globs
