"""The end of a range that nobody declared: a channel's tests come to the very same extreme, to the last digit or
within the noise of its converter, and none goes beyond."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.quality.ends.stays import BAND
from thermodata.calibration.quality.ends.still import Reading, Shown
from thermodata.plugin import Float1D

_LEAST_AT = 10  # readings of a test at its extreme
_LEAST_TESTS = 2
_LEAST_TIMES, LONG_TIMES = 4, 2  # that all tests stand on one level in noise, and what a stay of _LEAST_S counts
_LEAST_ROWS, _LEAST_S = 100, 1800.0  # of a plateau
_FLAT = 6.0  # standard errors that the means of its eighths differ by
_CAME = 10.0, 20.0  # times the noise: the last two distances from its level that it is timed between
_SHORTLY = 0.1  # of a plateau, in which it came from one to the other
_OFF, _AT_ONCE = 0.3, 3.0  # times the noise, and standard errors, that it lies off its level where it is due there
_SPANS = 50.0  # times the noise, that the channel moves by elsewhere

_SAME = 0.5  # times the noise, between the levels that two tests stand on: a shift by the speed differs by more


@dataclass(frozen=True, slots=True)
class End:
    """Where a range ends, and how far about it a reading stands there, both in the reading's unit."""

    level: float
    within: float = 0.0


Limits = tuple[End | None, End | None]  # lower and upper; None where none is known


def ends_of_ranges(readings: Mapping[tuple[str, str], Reading]) -> dict[tuple[str, str], Limits]:
    """(test, channel) -> the limits of its range that the test comes to. readings: by test and channel.

    A fine and noisy reading comes to its extreme once. Where two tests stand on the same one, to the last digit or
    within the noise of a converter, or one jumps there again and again, it is where the sensor ends. A rest at zero is
    none, nor is what only a channel shows that stands throughout.
    """
    found: dict[tuple[str, str], Limits] = {}
    for channel in dict.fromkeys(c for _, c in readings):
        own = {t: r for (t, c), r in readings.items() if c == channel}
        if not any(r.is_fine or r.jumps_to_one_reading for r in own.values()):
            continue
        lower, upper = _end(own, -1), _end(own, 1)
        for test, r in own.items():
            limits = (lower if _comes_to(lower, r.low) else None, upper if _comes_to(upper, r.high) else None)
            if limits != (None, None):
                found[test, channel] = limits
    return found


def _comes_to(end: End | None, extreme: float | None) -> bool:
    return end is not None and extreme is not None and abs(extreme - end.level) <= end.within


def _end(readings: Mapping[str, Reading], side: int) -> End | None:
    """The furthest extreme of all tests on a side, where enough of them stand on it. readings: by test."""
    extremes = {
        t: (value, n)
        for t, r in readings.items()
        for value, n in [(r.low, r.low_n) if side < 0 else (r.high, r.high_n)]
        if value is not None
    }
    if not extremes:
        return None
    end = side * max(side * value for value, _ in extremes.values())
    shown = [t for t, (value, n) in extremes.items() if value == end and n >= _LEAST_AT and readings[t].has_moved]
    if len(shown) >= _LEAST_TESTS and end != 0.0:
        return End(end)
    return _end_in_noise([r.plateau for r in readings.values() if r.plateau and r.plateau[2] == side], end)


def _end_in_noise(plateaus: Sequence[Shown], furthest: float) -> End | None:
    """The level that tests stand on often enough within the noise, beyond which none goes. plateaus: see `Reading`;
    furthest: of all tests."""
    if not plateaus:
        return None
    level, noise, *_ = min(plateaus, key=lambda p: abs(p[0] - furthest))
    times = sum(p[3] for p in plateaus if abs(p[0] - level) <= _SAME * noise)
    return End(level, BAND * noise) if times >= _LEAST_TIMES and abs(level - furthest) <= BAND * noise else None


@dataclass(frozen=True, slots=True)
class Plateau:
    """Rows start to stop of a record stand on one level, its extreme. side: -1 for its lowest, 1 for its highest.
    noise: its standard deviation."""

    start: int
    stop: int
    level: float
    side: int
    noise: float


def plateau_at_extreme(t_s: Float1D, x: Float1D) -> Plateau | None:
    """Where a noisy reading stands for half an hour and more on its own extreme, within its noise, and came there at a
    corner: a machine that warms comes to rest slowly. None where it does not. t_s, x: shape (n,), finite, in order."""
    if x.size < 2 * _LEAST_ROWS:
        return None
    noise = float(np.median(np.abs(np.diff(x)))) / (0.6745 * np.sqrt(2))
    if not 0 < noise * _SPANS < np.ptp(x):
        return None
    found = [_longest_plateau(t_s, side * x, noise, side) for side in (-1, 1)]
    return max((p for p in found if p is not None), key=lambda p: p.stop - p.start, default=None)


def _longest_plateau(t_s: Float1D, x: Float1D, noise: float, side: int) -> Plateau | None:
    """The longest one at the highest readings of x."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], (x >= x.max() - BAND * noise).astype(np.int8), [0]))))
    start, stop = max(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True), key=lambda run: run[1] - run[0])
    n = stop - start
    if n < _LEAST_ROWS or t_s[stop - 1] - t_s[start] < _LEAST_S:
        return None
    level = float(np.median(x[start:stop]))
    first = _behind_corner(x[:stop], start, level, noise)
    if first is None:
        return None
    rest = x[max(first, start + n // 20) : stop - n // 20]
    means = [float(part.mean()) for part in np.array_split(rest, 8)]
    flat = max(means) - min(means) <= _FLAT * noise / np.sqrt(rest.size / 8)
    return Plateau(start, stop, side * level, side, noise) if flat else None


def _behind_corner(x: Float1D, start: int, level: float, noise: float) -> int | None:
    """The row from which on x stands on its level, where it went on towards it as it came, and then stood at once: what
    comes to rest by itself slows down, and still sinks into its level there. None where it does not. start: about where
    it comes there."""
    near, far = (np.flatnonzero(x[:start] <= level - times * noise) for times in _CAME)
    if not near.size or not far.size:
        return None
    came = max(3, int(near[-1] - far[-1]))
    due = int(near[-1]) + came  # at the pace of before it is at its level from here on
    within = x[due : due + came]
    if came > _SHORTLY * (x.size - start) or start - near[-1] > came or within.size < came:
        return None
    at_once = abs(float(within.mean()) - level) <= (_OFF + _AT_ONCE / np.sqrt(came)) * noise
    return due + came if at_once else None
