"""The rows of a page: each test with its conditions and its error, and the table of all errors."""

from __future__ import annotations

from typing import Any

from thermodata.report.collected.data import ReportData, TestPart
from thermodata.report.words.numbers import duration, number, typeset


def test_row(data: ReportData, part: TestPart, key: str) -> dict[str, Any]:
    """A test as the page heads it. key: of its chart."""
    row = next(
        (
            s
            for s in data.scores
            if (s.campaign, s.test, s.response, s.phase) == (part.campaign, part.test, part.response, "all")
        ),
        None,
    )
    title = part.test if len(data.campaigns) == 1 else f"{part.campaign} / {part.test}"
    conditions = ", ".join(f"{k} {number(v) if isinstance(v, float) else v}" for k, v in part.conditions.items())
    length = duration(part.step_s * len(part.measured))
    facts = f"RMSE {number(row.rmse_um)} {data.unit_of(part.response)} · FIT {number(row.fit)} %" if row else ""
    return {
        "part": part,
        "key": key,
        "title": title if len(data.responses) == 1 else f"{title} · {part.response}",
        "about": typeset(" · ".join(filter(None, [part.kind.replace("_", " "), length, conditions]))),
        "facts": typeset(facts),
    }


def score_rows(data: ReportData) -> dict[str, Any]:
    """The errors of all tests beside those of the version before, those of phases, and the largest of each, which its
    bars are drawn to."""
    before = {(s.campaign, s.test, s.response): s.rmse_um for s in data.before if s.phase == "all"}
    rows = [{"row": s, "before": before.get((s.campaign, s.test, s.response))} for s in data.scores if s.phase == "all"]
    most: dict[str, float] = {}
    for s in data.scores:
        if s.phase == "all":
            unit, both = data.unit_of(s.response), (before.get((s.campaign, s.test, s.response)), s.rmse_um)
            most[unit] = max([most.get(unit, 0.0), *(e for e in both if e is not None)])
    found = [c for d in (data.diagnosis, data.reason) if d for c in d.candidates]
    tried = [e for c in found for e in (c.rmse_um_before, c.rmse_um_after) if e]
    phased = [s for s in data.scores if s.phase != "all"]
    return {"whole": rows, "phased": phased, "most_score": most, "most_candidate": max(tried, default=1.0)}
