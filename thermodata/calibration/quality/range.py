"""The end of a range that nobody declared: a channel's tests come to the very same extreme, and none goes beyond; or it
stands on its own extreme within the noise of its converter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.quality.still import Reading
from thermodata.plugin import Float1D

_LEAST_AT = 10  # readings of a test at its extreme
_LEAST_TESTS = 2
_LEAST_ROWS, _LEAST_S = 100, 1800.0  # of a plateau
_BAND = 8.0  # of its noise, between the extremes of a plateau of thousands of rows
_FLAT = 6.0  # standard errors that the means of its eighths differ by
_EDGE, _SHARP = 0.02, 10.0  # so shortly before it begins, as a share of it, it lay so many times the noise away
_AT_ONCE = 3.0  # standard errors that it lies off its level in as short a time behind its begin
_SPANS = 50.0  # times the noise, that the channel moves by elsewhere

Limits = tuple[float | None, float | None]  # lower and upper; None where none is known


def ends_of_ranges(readings: Mapping[tuple[str, str], Reading]) -> dict[tuple[str, str], Limits]:
    """(test, channel) -> the limits of its range that the test comes to. readings: by test and channel.

    A fine and noisy reading comes to its extreme once. Where two tests stand on the same one, to the last digit, it is
    where the sensor ends. A rest at zero is none, nor is what only a channel shows that stands throughout.
    """
    found: dict[tuple[str, str], Limits] = {}
    for channel in dict.fromkeys(c for _, c in readings):
        own = {t: r for (t, c), r in readings.items() if c == channel}
        if not any(r.is_fine for r in own.values()):
            continue
        lower = _end({t: (-r.low, r.low_n) for t, r in own.items() if r.low is not None}, own)
        upper = _end({t: (r.high, r.high_n) for t, r in own.items() if r.high is not None}, own)
        low = None if lower is None else -lower
        for test, r in own.items():
            limits = (low if low == r.low else None, upper if upper == r.high else None)
            if limits != (None, None):
                found[test, channel] = limits
    return found


def _end(extremes: Mapping[str, tuple[float, int]], readings: Mapping[str, Reading]) -> float | None:
    """The largest extreme of all tests, where enough of them stand on it. extremes: test -> (value, readings there)."""
    if not extremes:
        return None
    end = max(value for value, _ in extremes.values())
    shown = [t for t, (value, n) in extremes.items() if value == end and n >= _LEAST_AT and readings[t].has_moved]
    return end if len(shown) >= _LEAST_TESTS and end != 0.0 else None


@dataclass(frozen=True, slots=True)
class Plateau:
    """Rows start to stop of a record stand on one level, its extreme. side: -1 for its lowest, 1 for its highest."""

    start: int
    stop: int
    level: float
    side: int


def plateau_at_extreme(t_s: Float1D, x: Float1D) -> Plateau | None:
    """Where a noisy reading stands for half an hour and more on its own extreme, within its noise, and came there at a
    corner: a machine that warms comes to rest slowly. None where it does not. t_s, x: shape (n,), finite, in order."""
    if x.size < 2 * _LEAST_ROWS:
        return None
    noise = float(np.median(np.abs(np.diff(x)))) / (0.6745 * np.sqrt(2))
    if not 0 < noise * _SPANS < np.ptp(x):
        return None
    found = [_plateau(t_s, side * x, noise, side) for side in (-1, 1)]
    return max((p for p in found if p is not None), key=lambda p: p.stop - p.start, default=None)


def _plateau(t_s: Float1D, x: Float1D, noise: float, side: int) -> Plateau | None:
    """The longest one at the highest readings of x."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], (x >= x.max() - _BAND * noise).astype(np.int8), [0]))))
    start, stop = max(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True), key=lambda run: run[1] - run[0])
    n = stop - start
    edge = max(3, round(_EDGE * n))
    before = start - edge
    if n < _LEAST_ROWS or t_s[stop - 1] - t_s[start] < _LEAST_S or before < 0:
        return None
    level = float(np.median(x[start:stop]))
    means = [float(part.mean()) for part in np.array_split(x[start + n // 20 : stop - n // 20], 8)]
    flat = max(means) - min(means) <= _FLAT * noise / np.sqrt(0.9 * n / 8)
    # what comes to rest as fast as it began still sinks into its level here
    at_once = abs(float(x[start : start + edge].mean()) - level) <= _AT_ONCE * noise / np.sqrt(edge)
    corner = at_once and level - x[before] >= _SHARP * noise
    return Plateau(start, stop, side * level, side) if flat and corner else None
