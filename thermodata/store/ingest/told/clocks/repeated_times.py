"""Rows that stand at the time of the row before: stamps that were cut to whole minutes or seconds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermodata.schema.words.sentences import in_percent

MANY = 0.2  # of the samples: fewer are single rows that were written twice


def said_of_repeats(test: str, source: str, meta: Mapping[str, Any], rows: int) -> list[str]:
    """What is told of a stream most of whose samples don't count for their times alone. meta: of its tidy file."""
    samples, repeated = meta.get("samples", 0), meta.get("flags", {}).get("duplicate_time", 0)
    if not samples or repeated < MANY * samples or meta.get("held"):  # what is written on change comes at once
        return []
    period_s = meta.get("to_s", 0.0) / max(1, rows - 1)
    about = f", which is about {period_s:.2g} s by their number" if period_s > 0 else ""
    return [
        f"{test}, {source}: {in_percent(repeated / samples)} of the samples stand at the time of the row before, "
        "and count nowhere: times in whole minutes or seconds? Where rows are evenly spaced, in the source: "
        f"table: {{time: {{period: ...}}}}{about}, and in the test when it began, such as start: 2026-03-02 08:00"
    ]
