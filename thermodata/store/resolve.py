"""Which files belong to a test and a source. Paths stay inside the campaign's folder, through symlinks too."""

from __future__ import annotations

import glob
import re
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from thermodata.errors import SpecError
from thermodata.schema.campaign import Campaign, Test


@dataclass(frozen=True, slots=True)
class Found:
    """The files of one (test, source). paths: relative to the campaign's folder, in natural order. refused:
    (path, reason). shared: the pattern doesn't name the test, so that other tests have the same files."""

    patterns: tuple[str, ...]
    paths: tuple[str, ...]
    refused: tuple[tuple[str, str], ...]
    shared: bool
    explicit: bool

    def claims(self, path: str) -> bool:
        """Whether a path that is no longer there would still belong."""
        return any(re.fullmatch(_regex(p), path) for p in self.patterns)


def patterns_of(campaign: Campaign, test: Test, source: str) -> tuple[tuple[str, ...], bool, bool]:
    """(glob patterns, shared, explicit) of a source in a test; no patterns where it has no files."""
    own = test.files.get(source)
    declared = own if own is not None else campaign.sources[source].files
    if declared is None:
        return (), False, False
    listed = [declared] if isinstance(declared, str) else list(declared)
    shared = own is None and not any("{test}" in p for p in listed)
    return tuple(_checked(p, test.id) for p in listed), shared, own is not None


def resolve(folder: Path, campaign: Campaign, test: Test, source: str) -> Found:
    """The files of a source in a test, as they stand in the campaign's folder now."""
    patterns, shared, explicit = patterns_of(campaign, test, source)
    root = folder.resolve()
    paths: list[str] = []
    refused: list[tuple[str, str]] = []
    for pattern in patterns:
        for name in sorted(glob.glob(pattern, root_dir=root, recursive=True), key=natural):
            relative = PurePosixPath(Path(name)).as_posix()
            if relative in paths:
                continue
            real = (root / name).resolve()
            if not real.is_relative_to(root):
                refused.append((relative, "leads outside the campaign's folder"))
            elif real.is_file() and not real.name.endswith(".tdms_index"):
                paths.append(relative)
    return Found(patterns, tuple(paths), tuple(refused), shared, explicit)


def inside(folder: Path, name: str, where: str) -> Path:
    """One declared file, which must lie inside the campaign's folder (it need not exist)."""
    root = folder.resolve()
    _checked(name, "", where)
    real = (root / name).resolve()
    if not real.is_relative_to(root):
        raise SpecError("a path leads outside the campaign's folder", where=where, got=name,
                        expected="a file inside the campaign's folder")
    return root / name


def natural(text: str) -> list[tuple[int, int, str]]:
    """Sort key that puts run_2 before run_10."""
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"(\d+)", text) if part]


def _checked(pattern: str, test: str, where: str = "files") -> str:
    if PurePosixPath(pattern).is_absolute() or Path(pattern).is_absolute() or re.match(r"^[A-Za-z]:", pattern) \
            or ".." in re.split(r"[/\\]", pattern):
        raise SpecError("a path leads outside the campaign's folder", where=where, got=pattern,
                        expected="a path relative to the campaign file, without '..'",
                        hint="put the files into the campaign's folder, or the campaign file above them")
    return pattern.replace("{test}", glob.escape(test))


def _regex(pattern: str) -> str:
    out, i = "", 0
    while i < len(pattern):
        if pattern.startswith("**/", i):
            out, i = out + "(?:.*/)?", i + 3
        elif pattern[i] == "*":
            out, i = out + "[^/]*", i + 1
        elif pattern[i] == "?":
            out, i = out + "[^/]", i + 1
        elif pattern[i] == "[" and "]" in pattern[i + 1:]:
            end = pattern.index("]", i + 2) if pattern.find("]", i + 2) > 0 else pattern.index("]", i + 1)
            out, i = out + "[" + pattern[i + 1:end].replace("!", "^", 1).replace("\\", "\\\\") + "]", end + 1
        else:
            out, i = out + re.escape(pattern[i]), i + 1
    return out
