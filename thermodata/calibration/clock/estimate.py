"""The clock of one log against another's, from a quantity that both logged (spindle speed, position).

First all lags at once, by a masked and normalised cross-correlation on a coarse common grid (Padfield 2012,
doi:10.1109/TIP.2011.2181402); then each stretch with events is refined below a sample, and a line through the
stretches' offsets gives offset, drift and what they are worth. Thin evidence is refused: a wrong clock is worse
than none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.calibration.clock.refine import refine, stretches_with_events
from thermodata.errors import CalibrationError
from thermodata.plugin import Array, Float1D, Int1D

_MOST_CELLS = 2**16
_LEAST_CORRELATION = 0.8
_RIVAL = 0.97  # another peak as high as this is a rival
_LEAST_OVERLAP = 0.25
_LEAST_SAMPLES = 10
_LEAST_EVENTS = 2


@dataclass(frozen=True, slots=True)
class ClockEstimate:
    """t_there = t_here + offset_ns + drift_ppm * 1e-6 * (t_here - origin_ns).

    offset_ns is what `sources.*.clock.offset` adds to the times of `here`, at its first sample (origin_ns).
    uncertainty_ns: standard (k = 1), by the agreement of stretches. correlation: of the aligned logs.
    """

    offset_ns: int
    uncertainty_ns: int
    drift_ppm: float
    correlation: float
    origin_ns: int = 0
    stretches: int = 0

    def apply(self, t_here_ns: Int1D) -> Int1D:
        """Times of `here` on the clock of `there`; shape (n,)."""
        drift: Int1D = np.rint((t_here_ns - self.origin_ns) * (self.drift_ppm * 1e-6)).astype(np.int64)
        there: Int1D = t_here_ns + self.offset_ns + drift
        return there


def estimate_offset(t_here_ns: Int1D, here: Array, t_there_ns: Int1D, there: Array) -> ClockEstimate:
    """Offset and drift of the clock of `here` against that of `there`.

    Times: shape (n,), ns; values: shape (n,), any two signals in proportion to the same quantity, NaN where
    missing. Clocks may be years apart: only shapes are compared. Raises CalibrationError where a signal never
    changes, where the logs don't look alike, or where several offsets fit equally well (a periodic programme).
    """
    t_a, a, origin_a = _prepared(t_here_ns, here, "here")
    t_b, b, origin_b = _prepared(t_there_ns, there, "there")
    period = max(float(np.median(np.diff(t_a))), float(np.median(np.diff(t_b))))
    cell = max(period, (t_a[-1] + t_b[-1]) / _MOST_CELLS)
    lag_s, correlation = _coarse(_grid(t_a, a, cell), _grid(t_b, b, cell), cell)
    refuse_logs_that_do_not_look_alike(correlation)
    parts = stretches_with_events(t_a, a, lag_s, t_b)
    refuse_logs_without_a_common_event(len(parts))
    estimates = [f for f in (refine(t_a[s], a[s], t_b, b, lag_s, 3 * cell) for s in parts) if f is not None]
    refuse_a_single_event(len(estimates))
    at, lags, weights, matches = (np.array(x) for x in zip(*estimates, strict=True))
    offset, uncertainty, drift_ppm = _line(at, lags, weights, period)
    common = _common_phase(lags, [float(np.median(np.diff(t))) for t in (t_a, t_b)])
    if common and all(_sudden(a[s]) and _sudden(_within_span(t_b, b, t_a[s] + lag_s)) for s in parts):
        uncertainty = float(np.hypot(uncertainty, common))
    return ClockEstimate(
        offset_ns=origin_b - origin_a + round(offset * 1e9),
        uncertainty_ns=max(1, round(uncertainty * 1e9)),
        drift_ppm=drift_ppm,
        correlation=float(np.average(matches, weights=weights)),
        origin_ns=origin_a,
        stretches=len(estimates),
    )


def refuse_logs_that_do_not_look_alike(correlation: float) -> None:
    """correlation: of the logs at their best offset."""
    if correlation < _LEAST_CORRELATION:
        raise _thin(
            "the logs don't look alike at any offset",
            f"a correlation of {_LEAST_CORRELATION} or more",
            f"{correlation:.2f}",
            "are 'here' and 'there' the same quantity?",
        )


def refuse_logs_without_a_common_event(stretches: int) -> None:
    """stretches: those with events within both logs."""
    if stretches == 0:
        raise _thin(
            "no event that both logs saw",
            "at least two changes within both",
            "none",
            "choose a quantity that changes, e.g. the spindle's speed",
        )


def refuse_a_single_event(events: int) -> None:
    """events: stretches whose own offset could be told."""
    if events < _LEAST_EVENTS:
        raise _thin(
            "one event is not enough to tell which event it is in the other log", "at least two events", str(events)
        )


def _thin(what: str, expected: str, got: str, hint: str | None = None) -> CalibrationError:
    return CalibrationError(
        f"clock offset: {what}",
        expected=expected,
        got=got,
        hint=hint or "give 'clock: {offset: ...}' by hand, from a common event",
    )


def _prepared(t_ns: Int1D, values: Array, label: str) -> tuple[Float1D, Float1D, int]:
    """(seconds from the first sample, standardised values, first time): finite, increasing, with some change."""
    t_ns, values = np.asarray(t_ns), np.asarray(values, dtype=np.float64)
    if t_ns.shape != values.shape:
        raise _thin(f"'{label}' has times and values of different length", str(t_ns.shape), str(values.shape))
    fine = np.isfinite(values)
    t_ns, values = t_ns[fine], values[fine]
    order = np.argsort(t_ns, kind="stable")
    t_ns, values = t_ns[order], values[order]
    fresh = np.concatenate([[True], np.diff(t_ns) > 0]) if len(t_ns) else np.zeros(0, bool)
    t_ns, values = t_ns[fresh], values[fresh]
    if len(t_ns) < _LEAST_SAMPLES:
        raise _thin(f"'{label}' has hardly any samples", f"at least {_LEAST_SAMPLES}", str(len(t_ns)))
    spread = float(values.std())
    if spread <= 1e-9 * max(float(np.abs(values).max()), 1e-300):
        raise _thin(
            f"'{label}' never changes",
            "a signal with events",
            f"{values[0]:g} all along",
            "choose a quantity that changes, e.g. the spindle's speed",
        )
    return (t_ns - t_ns[0]) / 1e9, (values - values.mean()) / spread, int(t_ns[0])


def _grid(t: Float1D, x: Float1D, cell: float) -> tuple[Float1D, Float1D]:
    """(values, weights) on the grid; a cell's mean, held over cells up to the next sample (logs on change)."""
    n = int(t[-1] // cell) + 1
    index = np.minimum((t / cell).astype(np.int64), n - 1)
    count = np.bincount(index, minlength=n)
    total = np.bincount(index, weights=x, minlength=n)
    last = np.maximum.accumulate(np.where(count > 0, np.arange(n), 0))
    # a cell without a sample holds the last sample before it, not that cell's mean
    newest = np.searchsorted(t, (np.arange(n) + 1) * cell, side="left") - 1
    values = np.where(count > 0, total / np.maximum(count, 1), x[np.maximum(newest, 0)])
    # a long silence is no evidence: drop out after 20 typical pauses
    pause = 20 * max(float(np.median(np.diff(t))), float(np.quantile(np.diff(t), 0.99)), cell)
    weights = ((np.arange(n) - last) * cell <= pause).astype(np.float64)
    return values * weights, weights


def _coarse(a: tuple[Float1D, Float1D], b: tuple[Float1D, Float1D], cell: float) -> tuple[float, float]:
    """(lag [s] that `here` must be shifted by, its correlation); refuses rivals."""
    (x, wx), (y, wy) = a, b
    size = 1 << int(np.ceil(np.log2(len(x) + len(y))))
    ft = {k: np.fft.rfft(v, size) for k, v in {"x": x, "xx": x * x, "wx": wx, "y": y, "yy": y * y, "wy": wy}.items()}

    def over(p: str, q: str) -> Float1D:
        full: Float1D = np.fft.irfft(np.conj(ft[p]) * ft[q], size)
        return np.concatenate([full[size - len(x) + 1 :], full[: len(y)]])

    n = over("wx", "wy")
    enough = n >= max(_LEAST_OVERLAP * min(wx.sum(), wy.sum()), 8)
    n = np.maximum(n, 1.0)
    sx, sy = over("x", "wy") / n, over("wx", "y") / n
    vx, vy = over("xx", "wy") / n - sx**2, over("wx", "yy") / n - sy**2
    # where the overlap holds only a flat part, the correlation is noise over noise
    lively = enough & (vx > 0.05) & (vy > 0.05)
    r = np.where(lively, (over("x", "y") / n - sx * sy) / np.sqrt(np.maximum(vx * vy, 1e-12)), -1.0)
    best = int(np.argmax(r))
    _refuse_rivals(r, best, cell)
    return (best - (len(x) - 1)) * cell, float(min(r[best], 1.0))


def _refuse_rivals(r: Float1D, best: int, cell: float) -> None:
    if r[best] < _LEAST_CORRELATION:
        return
    left, right = best, best  # the peak's own flanks are no rivals
    while left > 0 and r[left - 1] < r[left] + 1e-3 and r[left] > 0.5 * r[best]:
        left -= 1
    while right < len(r) - 1 and r[right + 1] < r[right] + 1e-3 and r[right] > 0.5 * r[best]:
        right += 1
    outside = r.copy()
    outside[left : right + 1] = -1.0
    # at the same height, a longer overlap is better evidence
    rival = int(np.argmax(outside))
    if outside[rival] >= _RIVAL * r[best]:
        raise _thin(
            "several offsets fit equally well",
            "one offset",
            f"{outside[rival]:.3f} at {(rival - best) * cell:+.0f} s from the best ({r[best]:.3f})",
            "a periodic programme can't tell the clocks apart: give 'clock: {offset: ...}', or align by a "
            "quantity that isn't periodic",
        )


def _sudden(x: Float1D) -> bool:
    """Whether a stretch changes from one sample to the next: when between the two nobody saw."""
    return len(x) > 1 and float(np.abs(np.diff(x)).max()) > 0.5 * float(np.ptp(x))


def _within_span(t: Float1D, x: Float1D, span: Float1D) -> Float1D:
    first, last = np.searchsorted(t, [span[0], span[-1]])
    return x[first : last + 1]


def _common_phase(lags: Float1D, periods: list[float]) -> float:
    """Standard uncertainty [s] that all events share: a step is seen up to a sample late in each log, and where steps
    come at multiples of the samples' period (a programme of whole minutes), always by the same. What of that
    variance the lags do not show as scatter no number of events takes away."""
    late = sum(p**2 for p in periods) / 12
    scatter = 1.4826 * float(np.median(np.abs(lags - np.median(lags))))
    return float(np.sqrt(max(late - scatter**2, 0.0)))


def _line(at: Float1D, lags: Float1D, weights: Float1D, period: float) -> tuple[float, float, float]:
    """(offset [s] at time 0, its standard uncertainty [s], drift [ppm]); the drift only where it is significant."""
    floor = period / np.sqrt(12.0)  # a sample's own time is no better known
    middle = float(np.median(lags))
    keep = np.abs(lags - middle) <= max(6 * 1.4826 * float(np.median(np.abs(lags - middle))), 2 * period)
    at, lags, weights = at[keep], lags[keep], weights[keep]
    mean = float(np.average(lags, weights=weights))
    effective = float(weights.sum() ** 2 / np.sum(weights**2))
    if len(lags) >= 4 and np.ptp(at) > 0:
        centre = float(np.average(at, weights=weights))
        sxx = float(np.sum(weights * (at - centre) ** 2))
        slope = float(np.sum(weights * (at - centre) * (lags - mean)) / sxx)
        rest = lags - mean - slope * (at - centre)
        scatter = float(np.sqrt(np.sum(weights * rest**2) / weights.sum() * len(lags) / (len(lags) - 2)))
        sigma = float(np.hypot(scatter, 0.3 * floor))
        error = sigma * float(np.sqrt(np.sum(weights**2 * (at - centre) ** 2))) / sxx
        if abs(slope) > 4 * error and abs(slope) * np.ptp(at) > 0.5 * floor:
            return (mean - slope * centre, float(np.sqrt(sigma**2 / effective + (error * centre) ** 2)), slope * 1e6)
    scatter = float(np.sqrt(np.average((lags - mean) ** 2, weights=weights)))
    return mean, float(np.hypot(scatter, floor) / np.sqrt(max(effective, 1.0))), 0.0
