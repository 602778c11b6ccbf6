"""Names of tests in lists of them, where a test may stand in several parts: each by its hours."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from thermodata.schema.answers.candidate import CandidateCourse, LeftOut
from thermodata.schema.answers.missing_heat import HeatCourse

Piece = LeftOut | CandidateCourse | HeatCourse


def names_of_pieces(pieces: Sequence[Piece]) -> list[str]:
    """'head' where the test stands once, 'head, 2 to 4 h' where it stands in parts, 'campaign/head' of several
    campaigns; in the order given."""
    often = Counter((p.campaign, p.test) for p in pieces)
    several = len({p.campaign for p in pieces}) > 1
    names = [f"{p.campaign}/{p.test}" if several else p.test for p in pieces]
    return [
        name if often[p.campaign, p.test] == 1 else f"{name}, {_hours(p)}"
        for name, p in zip(names, pieces, strict=True)
    ]


def _hours(piece: Piece) -> str:
    begin, end = _ends(piece)
    digits = 2 if end - begin < 3600 else 1
    return f"{_short(begin / 3600, digits)} to {_short(end / 3600, digits)} h"


def _short(hours: float, digits: int) -> str:
    text = f"{hours:.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def _ends(piece: Piece) -> tuple[float, float]:
    if isinstance(piece, LeftOut):
        return piece.from_s, piece.to_s
    if isinstance(piece, HeatCourse):
        return piece.from_s, piece.from_s + piece.step_s * len(piece.residual_um)
    return (piece.t_s[0], piece.t_s[-1]) if piece.t_s else (0.0, 0.0)
