"""The counts as text, for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.report.text.table import fields, table
from thermodata.virtual.blind.counted import Counted
from thermodata.virtual.blind.rivals import RIVALS
from thermodata.virtual.blind.tally import Row

SORTS = {"first": "ranked first", "claim": "claims"}
SHORT = dict(zip(RIVALS, ("raw", "delay", "BIC", "LASSO", "SINDy"), strict=True))


def text(found: Counted) -> str:
    """All of a run: its tables, then how good its probabilities are, its seeds and its rules."""
    tables = [with_a_cause(found.summary), without(found.summary), goals(found.goals)]
    shown = [table(rows, [(key, key) for key in rows[0]]) for rows in tables if rows]
    said = [
        (
            f"probabilities, {SORTS[r.of]}",
            f"{r.statements} stated, Brier {r.brier:.3f} (base rate {r.base_brier:.3f}), "
            f"calibration error {r.calibration_error:.3f}",
        )
        for r in found.stated
    ] or [("probabilities", "none stated")]
    return "\n\n".join([*shown, fields([*said, ("seeds", found.seeds), ("rules", found.rules)])])


def with_a_cause(found: Sequence[Row]) -> list[Row]:
    """Rows where something could be named rightly. drop: median / mean share of the drop, of all machines."""
    return [
        {
            "with a cause": r["stratum"],
            "n": r["asked"],
            "named right": interval(r["named"]),
            "exact": r["exact"],
            "told": r["told"],
            "alike": r["alike"],
            "family": r["family"],
            "some": r["some"],
            "wrong": r["wrong"],
            "silent": r["abstained"],
            "none": r["verdicts_asked"]["none"]["hits"],
            "refine": r["verdicts_asked"]["refine"]["hits"],
            "first": interval(r["ranked_first"]),
            "drop": middle(r["share"]),
            "of claims": middle(r["share_of_claims"]),
            "faults": f"{r['faults_found']}/{r['faults']}" if r["faults"] else "",
            "broken claimed": f"{r['broken_claimed']}/{r['broken']}" if r["broken"] else "",
            "s": f"{r['seconds']:.1f}",
            **{short: _percent(r["rivals"].get(m, 0), r["rivals_of"]) for m, short in SHORT.items()},
        }
        for r in found
        if r["asked"]
    ]


def without(found: Sequence[Row]) -> list[Row]:
    """Rows where nothing could be: what is said instead. beside it: claims that name what is not logged, or its family,
    beside something else. beside: refinements of nothing that the model has."""
    return [
        {
            "without": r["stratum"],
            "n": r["nothing_to_name"],
            "false claim": interval(r["false_claims"]),
            "beside it": r["claimed_beside"],
            **{v.replace("_", " "): interval(r["verdicts"][v]) for v in ("none", "refine", "unknown", "not_testable")},
            "known again": r["known_again"],
            "beside": r["refined_beside_the_base"],
            "by speed": r["by_speed"],
            "s": f"{r['seconds']:.1f}",
        }
        for r in found
        if r["nothing_to_name"]
    ]


def goals(found: Sequence[Row]) -> list[Row]:
    """Each question with what was measured of it beside its goal, as a page prints them."""
    return [
        {
            "question": r["question"],
            "measured": interval(r["value"]) if "hits" in r["value"] else middle(r["value"]),
            "goal": r["goal"],
        }
        for r in found
    ]


def interval(share: Row) -> str:
    """'27/42 (49%-77%)'; nothing of none."""
    if share["interval"] is None:
        return ""
    low, high = share["interval"]
    return f"{share['hits']}/{share['of']} ({low:.0%}-{high:.0%})"


def middle(value: Row | None) -> str:
    return "" if value is None else f"{value['median']:.2f} / {value['mean']:.2f} of {value['of']}"


def _percent(hits: int, of: int) -> str:
    return f"{hits / of:.0%}" if of else ""
