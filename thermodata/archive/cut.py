"""Archives that end without their end mark, as of a logger that was switched off."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

from thermodata.archive.members import archive_of, is_archive, listed
from thermodata.errors import FormatError


def cut_archives(paths: Iterable[str], full: Callable[[str], Path]) -> dict[str, str]:
    """Archive -> what is lost of it, or may be, of those that files are read from. paths: of the files; full: where one
    stands on the disk. One that can't be read says so where its files are read."""
    found: dict[str, str] = {}
    asked: set[Path] = set()
    for path in paths:
        inside = archive_of(full(path))
        archive = full(path) if inside is None else inside[0]
        if archive in asked:
            continue
        asked.add(archive)
        with suppress(FormatError, OSError):
            lost = listed(archive).lost if inside is not None or is_archive(archive) else None
            if lost is not None:
                found[path if inside is None else path.removesuffix(f"/{inside[1]}")] = lost
    return found
