"""A jump test within a test: its moves are stored as displacement, and look like drift."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

import numpy as np

from thermodata.calibration.result import CalibrationResult
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.schema.words.sentences import listed
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock, Span, first_ns, last_ns, recorded
from thermodata.store.tidy.plan.plan import TestPlan

_NEARLY_S = 1.0  # a window that begins in the last move's ramp


@dataclass(frozen=True, slots=True)
class _Moves:
    """From the first to the last move of a jump test, from the start of the recording [s]. ends_s: of its file."""

    name: str
    file: str
    from_s: float
    to_s: float
    ends_s: float


def tell_jumps_inside(
    plan: TestPlan, where: Span, clocks: Mapping[str, Clock], calibrations: Mapping[str, CalibrationResult]
) -> None:
    """Tells of a test whose measurement holds the moves of jump tests, with the window that leaves them out: a problem,
    or a note where its `measuring` may leave them out. where: the test on its time line; clocks: of its sources."""
    window = plan.test.window
    begin_ns = where.zero_ns - (round(window[0] * 1e9) if window is not None else 0)
    low, high = window if window is not None else (-math.inf, math.inf)
    found = [
        m
        for m in _moves_by_file(plan, begin_ns, clocks, calibrations)
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
    told = (
        f"the moves of the jump test{'s' if many else ''} {names} lie in this test, {first:.0f} to {last:.0f} s from "
        f"its start in {found[0].file}, and are stored as if the machine had grown"
        f"{', but for what its measuring leaves out' if measures else ''}; try: "
        f"window: [{kept[0]} s, {kept[1]} s] in the test"
    )
    if measures:
        plan.notes.append(f"test '{plan.test.id}': {told}")
    else:
        plan.problems.append(told)


def _moves_by_file(
    plan: TestPlan, begin_ns: int, clocks: Mapping[str, Clock], calibrations: Mapping[str, CalibrationResult]
) -> list[_Moves]:
    found = []
    for name, spec in plan.campaign.calibrations.items():
        result = calibrations.get(name)
        source = plan.sources.get(spec.source) if isinstance(spec, JumpCalibration) else None
        if source is None or result is None or not isinstance(spec, JumpCalibration) or source.name not in clocks:
            continue
        raw = next((r for r in source.raws if _is_of(r, spec.file)), None)
        plateaus = result.detail.get("plateaus") or []
        if raw is None or len(plateaus) < 2 or not _is_measured(plan, source.name):
            continue

        def since(at_ns: int, first: int = first_ns(source), clock: Clock = clocks[source.name]) -> float:
            return float(clock.correct(np.array([at_ns]), first)[0] - begin_ns) / 1e9

        began = since(recorded(raw)[0])
        moved = (began + plateaus[0]["to_s"], began + plateaus[-1]["from_s"])
        found.append(_Moves(name, spec.file, *moved, since(last_ns(source))))
    return found


def _is_of(raw: RawStream, file: str) -> bool:
    return PurePosixPath(raw.source_path) == PurePosixPath(file)


def _is_measured(plan: TestPlan, source: str) -> bool:
    """Whether a source gives displacements of the test."""
    return any(b.source == source and b.channel.quantity == "displacement" for b in plan.bound.values())
