"""The clock of one log against another's, from events that a person saw in both (a start, a knock at the probe)."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.clock.estimate import ClockEstimate
from thermodata.errors import CalibrationError
from thermodata.plugin import Int1D

_LEAST_SPAN_S = 3600.0  # closer events give an offset, but no rate
_MOST_PPM = 500.0  # a bad quartz drifts by 100 ppm; beyond is a mistake
_TYPED_S = 1.0  # how well an event's time is known: typed to the second
_MOST_OFF_S = 30.0  # from one line, before an event is another event


def offset_from_events(here_ns: Int1D, there_ns: Int1D) -> ClockEstimate:
    """Offset and drift of the clock of `here` against that of `there`.

    here_ns, there_ns: the same events on both clocks, shape (n,), n >= 1. One event gives an offset; two or more at
    least an hour apart a drift too. uncertainty_ns: by how far the events are off the line, at least a second over
    the root of their number, for that is how times are typed. correlation: nan, for none was made.
    Raises CalibrationError where the events contradict each other.
    """
    here, there = np.asarray(here_ns, np.int64), np.asarray(there_ns, np.int64)
    if not here.size or here.shape != there.shape:
        raise CalibrationError(
            "clock: no events to align by",
            expected="events: [{here: ..., there: ...}]",
            got=f"{here.size} and {there.size} times",
            hint="list moments that were seen in both logs, two far apart for the drift, too",
        )
    order = np.argsort(here, kind="stable")
    here, there = here[order], there[order]
    origin = int(here[0])
    at = (here - origin) / 1e9
    base = int(there[0] - here[0])
    off = (there - here - base) / 1e9
    typed = _TYPED_S / np.sqrt(len(off))
    if float(at[-1]) < _LEAST_SPAN_S:
        mean = float(off.mean())
        _refuse_contradiction(off - mean, at)
        return _estimate(base, mean, max(float(np.abs(off - mean).max()), typed), 0.0, origin, len(off))
    slope, start = np.polyfit(at, off, 1)
    left = off - (start + slope * at)
    if abs(slope) > _MOST_PPM * 1e-6:
        raise CalibrationError(
            "clock: the declared events contradict each other",
            expected=f"a drift of at most {_MOST_PPM:.0f} ppm",
            got=f"offsets that change by {off[-1] - off[0]:+.1f} s in {at[-1] / 3600:.1f} h ({slope * 1e6:+.0f} ppm)",
            hint="check which event is which, and the day of each time; a clock that was reset needs 'resets: allow'",
        )
    _refuse_contradiction(left, at)
    return _estimate(base, float(start), max(float(np.abs(left).max()), typed), float(slope) * 1e6, origin, len(off))


def _refuse_contradiction(left: np.ndarray, at: np.ndarray) -> None:
    worst = int(np.argmax(np.abs(left)))
    if abs(float(left[worst])) > _MOST_OFF_S:
        raise CalibrationError(
            "clock: the declared events contradict each other",
            expected="all within half a minute of one line",
            got=f"event {worst + 1} ({at[worst] / 3600:.2f} h after the first) is off by {left[worst]:+.0f} s",
            hint="check which event is which",
        )


def _estimate(
    base_ns: int, offset_s: float, uncertainty_s: float, drift_ppm: float, origin: int, events: int
) -> ClockEstimate:
    return ClockEstimate(
        base_ns + round(offset_s * 1e9), round(uncertainty_s * 1e9), drift_ppm, float("nan"), origin, events
    )
