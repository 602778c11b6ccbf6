"""The files below a folder that may be logs, in the order of their names or of their kinds."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from thermodata.reader.files.stores import within_stores
from thermodata.reader.finding.registry import files_in

_NOT_LOGS = frozenset((".yaml", ".yml", ".md", ".tdms_index"))


def files_below(folder: Path) -> Iterator[PurePosixPath]:
    in_store = within_stores(folder)
    for path in sorted(folder.rglob("*"), key=lambda p: natural(p.relative_to(folder).as_posix())):
        inside = PurePosixPath(path.relative_to(folder).as_posix())
        hidden = any(p.startswith((".", "~$")) for p in inside.parts) or in_store(path)
        if not hidden and path.is_file() and not path.is_symlink() and _may_be_log(path):
            yield from (PurePosixPath(p.relative_to(folder).as_posix()) for p in files_in(path) if _may_be_log(p))


def _may_be_log(path: Path) -> bool:
    return path.suffix.lower() not in _NOT_LOGS


def natural(text: str) -> list[tuple[int, int, str]]:
    """Sort key that puts run_2 before run_10."""
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in re.split(r"(\d+)", text) if part]


def shape_of(path: PurePosixPath) -> str:
    """Its name without digits: files of one kind have the same."""
    return re.sub(r"\d+", "#", str(path))


def spread(paths: Sequence[PurePosixPath]) -> list[PurePosixPath]:
    """One of each kind first, then the second ones: whatever time there is, every kind is looked at."""
    seen: dict[str, int] = {}
    ranked = []
    for i, path in enumerate(paths):
        shape = shape_of(path)
        seen[shape] = seen.get(shape, 0) + 1
        ranked.append((seen[shape], i, path))
    return [path for _, _, path in sorted(ranked)]
