"""A jump test within a test: its moves are stored as displacement, and look like drift."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from thermodata.calibration.result import CalibrationResult
from thermodata.schema.words.sentences import listed
from thermodata.store.ingest.told.channels.moves_of_jumps import moves_in
from thermodata.store.tidy.clock.source_clock import Clock, Span
from thermodata.store.tidy.plan.plan import TestPlan
from thermodata.store.tidy.values.series import TestSeries

_NEARLY_S = 1.0  # a window that begins in the last move's ramp


def tell_jumps_inside(
    store: Path,
    plan: TestPlan,
    where: Span,
    clocks: Mapping[str, Clock],
    calibrations: Mapping[str, CalibrationResult],
) -> None:
    """Tells of a test whose measurement holds the moves of jump tests, with the window that leaves them out: a problem,
    or a note where its `measuring` may leave them out. where: the test on its time line; clocks: of its sources."""
    window = plan.test.window
    begin_ns = where.zero_ns - (round(window[0] * 1e9) if window is not None else 0)
    low, high = window if window is not None else (-math.inf, math.inf)
    found = [
        m
        for m in moves_in(plan, begin_ns, TestSeries(store, plan, clocks, where, calibrations))
        if m.to_s > low + _NEARLY_S and m.from_s < high - _NEARLY_S
    ]
    if not found:
        return
    first, last = min(m.from_s for m in found), max(m.to_s for m in found)
    a, b = max(low, 0.0), min(high, max(m.ends_s for m in found))
    # what is longer, before the moves or behind them, is the test
    kept = (math.ceil(last), math.floor(b)) if b - last >= first - a else (math.ceil(a), math.floor(first))
    names = listed([m.name for m in found])
    many = len(found) > 1
    measures = plan.test.measuring is not None
    seen = "moves as those" if all(m.seen for m in found) else "the moves"
    told = (
        f"{seen} of the jump test{'s' if many else ''} {names} lie in this test, {first:.0f} to {last:.0f} s from "
        f"its start in {found[0].file}, and are stored as if the machine had grown"
        f"{', but for what its measuring leaves out' if measures else ''}; try: "
        f"window: [{kept[0]} s, {kept[1]} s] in the test"
    )
    if measures:
        plan.notes.append(f"test '{plan.test.id}': {told}")
    else:
        plan.problems.append(told)
