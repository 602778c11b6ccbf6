"""Logs that were put aside and packed: nothing reads them, and what is drafted lacks their time."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from thermodata.draft.folder.into_sources.sources import Group
from thermodata.reader.files.rotated import age, unrotated
from thermodata.schema.words.sentences import with_dots

_PACKED = (".gz", ".bz2", ".xz", ".zst")
_SHOWN = 4
_NUMBERS = re.compile(r"[\d\W_]+")


def packed_pieces(group: Group, ignored: Sequence[tuple[str, str]]) -> list[str]:
    """What to ask of a source that has packed files beside its logs: 'a.log.2.gz' is a piece of 'a.log', and
    'a-20260301.csv.gz' a log like 'a-20260302.csv', by its name but for its number or day."""
    paths = [PurePosixPath(path) for path, _ in ignored]
    known = {unrotated(f.path) for f in group.files}
    alike = {_but_numbers(f.path): f.path for f in reversed(group.files)}
    pieces: dict[PurePosixPath, list[PurePosixPath]] = {}
    logs: dict[PurePosixPath, list[PurePosixPath]] = {}
    for packed in (p for p in paths if p.suffix.lower() in _PACKED):
        piece = packed.with_suffix("")
        if unrotated(piece) != piece and unrotated(piece) in known:
            pieces.setdefault(unrotated(piece), []).append(packed)
        elif (like := alike.get(_but_numbers(piece))) is not None:
            logs.setdefault(like, []).append(packed)
    return [
        *(_asked(some, f"a piece of {log} too", f"pieces of {log} too") for log, some in pieces.items()),
        *(_asked(some, f"a log like {log}", f"logs like {log}") for log, some in logs.items()),
    ]


def _asked(packed: list[PurePosixPath], one: str, several: str) -> str:
    packed.sort(key=lambda p: (age(p.with_suffix("")), p))
    shown = with_dots([f"'{p}'" for p in packed], _SHOWN)
    are = f"is {one}" if len(packed) == 1 else f"are {several}"
    return f"{shown} {are}, packed and not read: unpack and draft again, or leave that time out"


def _but_numbers(path: PurePosixPath) -> PurePosixPath:
    """A path without the numbers and days in its name, and without what parts them from it: 'log.csv' of
    'log-20260301.csv' and of 'log.csv.1'."""
    bare = unrotated(path)
    return bare.with_name(_NUMBERS.sub("", bare.stem) + bare.suffix.lower())
