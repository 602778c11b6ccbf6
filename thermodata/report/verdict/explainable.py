"""What the best single candidate takes away, which is no claim, beside what all claims take away together."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.verdict.verdict import claims_of
from thermodata.report.words.numbers import percent

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis

_NO_CAUSE = "which by itself names no cause"


def explainable(found: Diagnosis) -> str:
    """'the best candidate alone, lag:T, takes away 53 % of the squared residual, ...'; '' where nothing is known of it.
    Below several claims stands what all take away, or one alone would seem to do as much."""
    if not found.explainable:
        return ""
    claims, which = claims_of(found), found.explainable_by
    alone = "the best candidate alone" + (f", {which}," if which else "")
    together = _together(found, len(claims))
    if together:
        names = "one of them" if which in {c.id for c in claims} else _NO_CAUSE
        return f"{together} of the squared residual, {alone} {percent(found.explainable)}, {names}"
    said = f"{alone} takes away {percent(found.explainable)} of the squared residual"
    known = {name for c in claims for name in (c.id, *c.equivalent)}
    return said if claims and (which is None or which in known) else f"{said}, {_NO_CAUSE}"


def _together(found: Diagnosis, claims: int) -> str:
    """'both together take away 75 %'; '' of less than two, or where it is not known."""
    before, after = found.rmse_um, found.named_rmse_um
    if claims < 2 or not before or after is None:
        return ""
    taken = percent(max(1 - (after / before) ** 2, 0.0))
    return f"{'both' if claims == 2 else f'all {claims}'} together take away {taken}"
