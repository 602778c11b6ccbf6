"""Where the moves of jump tests lie in a test: in the file of the jump test itself, or seen again at the head of
another recording, as where a lab moves its probes before each test."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import PurePosixPath

import numpy as np

from thermodata.calibration.jump.evaluate import readings
from thermodata.calibration.jump.plateaus import Match, find_steps, match_moves
from thermodata.calibration.result import CalibrationResult
from thermodata.errors import ThermodataError
from thermodata.plugin import Float1D
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import first_ns, last_ns, recorded
from thermodata.store.tidy.plan.plan import Bound, SourcePlan, TestPlan
from thermodata.store.tidy.values.series import TestSeries

_LONGEST_S = 1800.0  # of a jump test at the head of a recording
_LATER = 1.5  # by which it may end later than the one that is known
_ALIKE = 0.1  # of a move: the same probe shows it again
_FEWEST_MOVES = 2  # one step of a probe may be anything


@dataclass(frozen=True, slots=True)
class Moves:
    """From the first to the last move of a jump test, from the start of the recording [s]. ends_s: of its file; seen:
    by the values alone, in another file than the jump test's."""

    name: str
    file: str
    from_s: float
    to_s: float
    ends_s: float
    seen: bool = False


def moves_in(plan: TestPlan, begin_ns: int, series: TestSeries) -> list[Moves]:
    """Of all jump tests whose moves lie in the recordings of a test that begins at begin_ns."""
    found = []
    for name, spec in plan.campaign.calibrations.items():
        result = series.calibrations.get(name)
        source = plan.sources.get(spec.source) if isinstance(spec, JumpCalibration) else None
        if (
            source is None
            or result is None
            or not isinstance(spec, JumpCalibration)
            or source.name not in series.clocks
        ):
            continue
        if len(result.detail.get("plateaus") or []) < 2 or not _is_measured(plan, source.name):
            continue
        raw = next((r for r in source.raws if _is_of(r, spec.file)), None)
        if raw is not None:
            found.append(_of_own_file(name, spec.file, result, raw, source, begin_ns, series))
        elif not source.shared:
            found += _seen_again(name, spec, result, source, begin_ns, series)
    return found


def _of_own_file(
    name: str,
    file: str,
    result: CalibrationResult,
    raw: RawStream,
    source: SourcePlan,
    begin_ns: int,
    series: TestSeries,
) -> Moves:
    dwells = result.detail["plateaus"]
    began = _since(recorded(raw)[0], source, begin_ns, series)
    moved = (began + dwells[0]["to_s"], began + dwells[-1]["from_s"])
    return Moves(name, file, *moved, _since(last_ns(source), source, begin_ns, series))


def _seen_again(
    name: str, spec: JumpCalibration, result: CalibrationResult, source: SourcePlan, begin_ns: int, series: TestSeries
) -> Iterator[Moves]:
    """What the channels with a calibration show of its moves, in [um], about when they came in its own file."""
    until_s = _LATER * result.detail["plateaus"][-1]["to_s"]
    if len(result.detail["moves_um"]) < _FEWEST_MOVES or until_s > _LONGEST_S:
        return
    for bound in series.plan.bound.values():
        if bound.source != source.name or bound.signal is None or not _uses(bound, name):
            continue
        line = series.timeline((bound.source, bound.stream))
        if not line.rows:
            continue
        first = int(line.times(0, 1)[0])
        stop = line.find(first + round(until_s * 1e9))
        try:
            values = np.asarray(series.values(bound, 0, stop)[0], dtype=np.float64)
        except ThermodataError:  # told where it was tidied
            continue
        keep = readings(line.times(0, stop), values)
        t: Float1D = (line.times(0, stop)[keep] - first) / 1e9
        match = _same_moves(t, values[keep], result.detail["moves_um"], spec.dwell)
        if match is not None:
            began = (first - begin_ns) / 1e9
            file = source.streams[bound.stream][0].source_path
            ends = _since(last_ns(source), source, begin_ns, series)
            yield Moves(name, file, began + match.steps[0].from_s, began + match.steps[-1].to_s, ends, seen=True)


def _same_moves(t_s: Float1D, um: Float1D, moves_um: list[float], dwell_s: float) -> Match | None:
    """The steps of a calibrated probe that are the moves by size and sign. t_s, um: shape (n,)."""
    match = match_moves(find_steps(t_s, um, dwell_s)[0], moves_um, dwell_s) if t_s.size else None
    if match is None or match.misfit > _ALIKE or abs(match.volts_per_um - 1.0) > _ALIKE:
        return None
    return match


def _since(at_ns: int, source: SourcePlan, begin_ns: int, series: TestSeries) -> float:
    """A recorded time of a source, from the start of the test's recording [s]."""
    return float(series.clocks[source.name].correct(np.array([at_ns]), first_ns(source))[0] - begin_ns) / 1e9


def _uses(bound: Bound, calibration: str) -> bool:
    named = bound.channel.calibration
    return calibration == named or (isinstance(named, list) and calibration in named)


def _is_of(raw: RawStream, file: str) -> bool:
    return PurePosixPath(raw.source_path) == PurePosixPath(file)


def _is_measured(plan: TestPlan, source: str) -> bool:
    """Whether a source gives displacements of the test."""
    return any(b.source == source and b.channel.quantity == "displacement" for b in plan.bound.values())
