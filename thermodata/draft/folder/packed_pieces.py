"""Pieces of a log that was put aside and packed: nothing reads them, and the log lacks their time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from thermodata.draft.folder.sources import Group
from thermodata.reader.rotated import age, unrotated

_PACKED = (".gz", ".bz2", ".xz", ".zst")
_SHOWN = 4


def packed_pieces(group: Group, ignored: Sequence[tuple[str, str]]) -> list[str]:
    """What to ask of a source some of whose logs have packed pieces beside them: 'a.log.2.gz' beside 'a.log'."""
    paths = [PurePosixPath(path) for path, _ in ignored]
    bare = [(p, p.with_suffix("")) for p in paths if p.suffix.lower() in _PACKED]
    known = {unrotated(f.path) for f in group.files}
    found: dict[PurePosixPath, list[PurePosixPath]] = {}
    for packed, piece in bare:
        if unrotated(piece) != piece and unrotated(piece) in known:
            found.setdefault(unrotated(piece), []).append(packed)
    asked: list[str] = []
    for log, pieces in found.items():
        pieces.sort(key=lambda p: age(p.with_suffix("")))
        shown = ", ".join(f"'{p}'" for p in pieces[:_SHOWN]) + (", ..." if len(pieces) > _SHOWN else "")
        are = "is a piece" if len(pieces) == 1 else "are pieces"
        asked.append(f"{shown} {are} of {log} too, packed and not read: unpack and draft again, or leave that time out")
    return asked
