"""Packed logs that lie beside what they were packed of, and archives that hold no log at all."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from pathlib import Path, PurePosixPath

from thermodata.archive.members import archive_of, size_of
from thermodata.archive.unpacked import held
from thermodata.errors import FormatError
from thermodata.reader.files.rotated import as_unpacked
from thermodata.schema.words.sentences import with_count

_SHOWN = 3


def packed_copies(folder: Path, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
    """Packed file -> the one that is called as it was before, and holds the same: 'a.csv.gz' -> 'a.csv',
    'day.zip/a.csv' -> 'day/a.csv'."""
    loose: dict[str, list[PurePosixPath]] = {}
    packed = []
    for path in paths:
        if as_unpacked(path) != path or archive_of(folder / path) is not None:
            packed.append(path)
        else:
            loose.setdefault(path.name, []).append(path)
    found = {}
    digest, size = cache(_digest), cache(_size)  # a log of one length lies in the folder of each test
    for path in packed:
        others = loose.get(as_unpacked(path).name, ())
        if archive_of(folder / path) is not None:
            unpacked = _size(folder / path)
            others = [o for o in others if size(folder / o) == unpacked]
        of = next((o for o in others if digest(folder / path) == digest(folder / o) is not None), None)
        if of is not None:
            found[path] = of
    return found


def _size(path: Path) -> int | None:
    try:
        return size_of(path)
    except (FormatError, OSError):
        return None


def _digest(path: Path) -> bytes | None:
    try:
        with held(path) as real, real.open("rb") as file:
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
