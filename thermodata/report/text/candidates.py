"""The table of candidates of a diagnosis, as text for a person, with what its columns mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.text.table import table
from thermodata.report.verdict.candidate_errors import beside
from thermodata.report.verdict.verdict import probability
from thermodata.schema.words.sentences import listed, with_count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.candidate import Candidate

_MOST_TWINS = 3
_WIDEST = 200  # characters of a cell: none of these rows is cut
BOTH_WITH = (
    "both with: the model has these effects too, before and after. Each row is fitted anew, its samples weighed by the "
    "noise that its own effects leave, so that errors before differ between rows, and may exceed the model's own"
)
_LEAST_P = 0.005
LEAST_P = (
    "p: of responses in which nothing is missing, the share on which chance does as well; 0.005 is the least that can "
    "come out, so rows that have it are told apart by their errors"
)
AS_MODELLED = (
    "before and after are of the model as it stands, one lag an effect; in the other rows its effects may act otherwise"
)


def _twins(ids: Sequence[str]) -> str:
    """'feed_motor:T_motor_Z, lag:T_motor_Z, lag:feed_Z, and 3 more': names are whole, or nobody could ask for them."""
    return with_count(ids, _MOST_TWINS, ", and")


def _without_row(candidates: Sequence[Candidate], left: float | None) -> str:
    """Of what stands beside others and is itself in no row."""
    rows = {c.id for c in candidates}
    names = list(dict.fromkeys(name for c in candidates for name in beside(c, left) if name not in rows))
    if not names:
        return ""
    have, were = ("has", "was") if len(names) == 1 else ("have", "were")
    return f". {listed(names)} {have} no row here: {'it' if len(names) == 1 else 'they'} {were} among what was asked"


def candidates_text(candidates: Sequence[Candidate], left: float | None) -> str:
    rows = [
        {
            **c.model_dump(),
            "claimed": "yes" if c.claimed else "refines" if c.refinement else "",
            "probability": probability(c.probability),
            "beside": beside(c, left),
            "p_value": None if c.p_value is None else f"{c.p_value:.3g}",
            "equivalent": _twins(c.equivalent),
        }
        for c in candidates
    ]
    columns = [
        ("rank", "#"),
        ("id", "candidate"),
        ("family", "family"),
        ("claimed", "claimed"),
        ("probability", "probability"),
        ("p_value", "p"),
        ("rmse_um_before", "before [um]"),
        ("rmse_um_after", "after [um]"),
        *([("beside", "both with")] if any(r["beside"] for r in rows) else []),
        ("equivalent", "can't be told from"),
    ]
    told = f"\n\n{LEAST_P}" if sum(c.p_value is not None and c.p_value <= _LEAST_P for c in candidates) > 1 else ""
    told += f"\n\n{BOTH_WITH}{_without_row(candidates, left)}" if any(r["beside"] for r in rows) else ""
    told += "".join(f"\n\n{c.id}: {AS_MODELLED}" for c in candidates if c.as_modelled)
    return table(rows, columns, widest=_WIDEST) + told
