"""A temperature sensor that fails between two tests, or slowly within one: from one day on it reads many kelvin more
than its neighbours.

Within a test such a sensor looks sound. Its difference from the median of all other temperatures gives it away: it
lies beyond all that was seen before, in every later test and throughout, even at the start of a test before which the
machine had levelled out. Where it drifted there, the drift is flagged with it.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.between_tests.levels import LEAST_OTHERS, Levels, differences_of
from thermodata.calibration.between_tests.starts import Start, off_from_start
from thermodata.plugin import Bool1D, Float1D, Int1D

_LEAST_K = 8.0
_LEAVES_K = 2.0  # a drift begins where it leaves by more what was usual, and does not come back
_RESTED_S = 4 * 3600.0  # bearings and motors cool in one to two hours
_START_S = 600.0  # what is seen later than the others may be warm by then
_LEVEL_K = 2.0  # four of five others within so much of their median: without a clock, a machine at rest
_LEVEL_SHARE = 0.8
_FOLLOWS_SHARE = (
    0.6  # of the others suffices in two tests and more, where the sensor does as before, but for a constant
)
_FOLLOWS_K = 2.0
_SET_POINTS, _SET_APART_K = 4, 5.0
_STARTS_ALIKE_K = 2.0  # beyond what starts lay apart before: a sensor that wanders comes back to no start
_MOVES_K = 2.0  # one that hardly moves may as well stick
_ROUGH_TIMES, _ROUGH_K = 2.0, 2.0  # a bend of what wanders, beyond those of all that is sound
_UNTOLD: tuple[Float1D, Float1D] = np.empty(0), np.empty(0)
_LEAST_BEFORE = 3  # points, or nobody knows what was usual


@dataclass(frozen=True, slots=True)
class Off:
    """By how much a sensor is off [K] in a test, and from when on [s]; None: throughout. constant: by one number in all
    tests, as far as they tell: what counts from a test's start knows nothing of it."""

    size: float
    since_s: float | None = None
    constant: bool = False


def offsets_between_tests(tests: Sequence[Levels]) -> dict[tuple[str, str], Off]:
    """(test, channel) -> by how much the channel is off, for every test from the failure on.

    tests: in the order of the campaign file, which counts where one of them has no absolute clock; else their clocks
    do. A channel needs three others to be compared with. Nothing is said where no later test began with a machine
    that had levelled out, for then a part that stays hot would look the same. It had after a rest of 4 h; without
    clocks, where most temperatures are alike and it is not said to start warm. Nothing is said of what is powered
    either: from the day on which it is switched on it looks so. With clocks a channel is also off whose starts after a
    rest say so (`starts`).
    """
    dated = all(t.start_s is not None and t.end_s is not None for t in tests)
    ordered = sorted(tests, key=lambda t: t.start_s or 0.0) if dated else list(tests)
    differences = differences_of(ordered)
    rested = _rested(ordered) if dated else None
    offsets: dict[tuple[str, str], Off] = {}
    asked = (c for t in ordered for c, x in t.series.items() if x.quantity == "temperature" and not x.powered)
    for channel in dict.fromkeys(asked):
        spans = [d.get(channel, _UNTOLD) for d in differences]
        level = [_level(t, channel) if rested is None or not i else rested[i] for i, t in enumerate(ordered)]
        offsets |= _from_the_failure_on(ordered, channel, spans, level)
    if rested is not None:
        starts = [_starts(test, d, {c for _, c in offsets}) for test, d in zip(ordered, differences, strict=True)]
        for channel, (begin, size) in off_from_start(starts, [r > 0 for r in rested]).items():
            # it cools to the same start in each of them
            offsets |= {(t.test, channel): Off(size, constant=True) for t in ordered[begin:] if channel in t.series}
    return offsets


def _starts(test: Levels, differences: Mapping[str, tuple[Float1D, Float1D]], off: Container[str]) -> dict[str, Start]:
    """How channels start a test, and go on; not those that are known to be off."""
    first_s = min((float(t_s[0]) for t_s, _ in differences.values()), default=0.0)
    return {
        name: Start(
            t_s,
            d,
            asked=not (test.series[name].powered or test.series[name].around),
        )
        for name, (t_s, d) in differences.items()
        if name not in off and t_s[0] - first_s <= _START_S
    }


def _rested(tests: Sequence[Levels]) -> list[float]:
    """Of each test 1 where the clocks tell that the machine rested before it, else 0: what is warm was run while nobody
    logged. tests: by their clocks."""
    rested, end_s = [], -np.inf
    for test in tests:
        rested.append(float((test.start_s or 0.0) - end_s >= _RESTED_S and not test.warm))
        end_s = max(end_s, test.end_s or 0.0)
    return rested


def _level(test: Levels, channel: str) -> float:
    """How far a machine had levelled out before a test: the share of other temperatures that begin alike."""
    if test.warm:
        return 0.0
    first = [
        float(sound[0])
        for name, x in test.series.items()
        if name != channel
        and x.quantity == "temperature"
        and len(sound := x.sound[np.isfinite(x.sound)])
        and not _is_set_point(sound)
    ]
    if len(first) < LEAST_OTHERS:
        return 0.0
    return float(np.mean(np.abs(np.array(first) - np.median(first)) <= _LEVEL_K))


def _is_set_point(x: Float1D) -> bool:
    """A few values, far apart: what the machine was told, not what a sensor read."""
    return len(np.unique(x)) <= _SET_POINTS and float(np.ptp(x)) > _SET_APART_K


def _from_the_failure_on(
    tests: Sequence[Levels], channel: str, spans: Sequence[tuple[Float1D, Float1D]], level: Sequence[float]
) -> dict[tuple[str, str], Off]:
    d = np.concatenate([x for _, x in spans])
    of = np.repeat(np.arange(len(spans)), [len(x) for _, x in spans])
    begin, off = max((_change(sign * d, of, level) for sign in (1.0, -1.0)), key=lambda c: c[1] > 0)
    if not off or abs(np.median(d[:begin])) > abs(np.median(d[off:])):
        return {}
    size = float(np.median(d[off:]) - np.median(d[:begin]))
    at = int(of[begin])
    within = begin - int(np.searchsorted(of, at))
    since = float(spans[at][0][within - 1]) if within else None
    after = np.unique(of[begin:]).tolist()
    drifts = bool(within) or off > begin
    constant = not drifts and _is_constant(tests, channel, spans, np.unique(of[:begin]).tolist(), after, level)
    return {(tests[i].test, channel): Off(size, since if i == at else None, constant) for i in after}


def _is_constant(
    tests: Sequence[Levels],
    channel: str,
    spans: Sequence[tuple[Float1D, Float1D]],
    before: Sequence[int],
    after: Sequence[int],
    level: Sequence[float],
) -> bool:
    """Whether a channel that is off through whole tests is so by one number: after each rest it starts as far from the
    others, its course is no rougher than sound ones, and it moves."""
    starts = [[float(spans[i][1][0]) for i in some if level[i] >= _FOLLOWS_SHARE] for some in (before, after)]
    if len(starts[1]) < 2 or np.ptp(starts[1]) > np.ptp(starts[0] or [0.0]) + _STARTS_ALIKE_K:
        return False
    moves = [tests[i].series[channel].values for i in after]
    if max(float(np.nanmax(x) - np.nanmin(x)) for x in moves) < _MOVES_K:
        return False
    sound = [spans[i][1] for i in before]
    sound += [
        x.sound[np.isfinite(x.sound)]
        for i in after
        for name, x in tests[i].series.items()
        if name != channel and x.quantity == "temperature" and not _is_set_point(x.sound[np.isfinite(x.sound)])
    ]
    usual = max((_bend(x) for x in sound), default=0.0)
    return max(_bend(spans[i][1]) for i in after) <= _ROUGH_TIMES * usual + _ROUGH_K


def _bend(x: Float1D) -> float:
    """The largest second difference."""
    return float(np.abs(np.diff(x, n=2)).max()) if len(x) > 2 else 0.0


def _change(d: Float1D, of: Int1D, level: Sequence[float]) -> tuple[int, int]:
    """(first point that is off, first one after the drift) where all differences after lie above all before; (0, 0)
    where none do. d: shape (m,), in order; of: shape (m,), the test of each.

    Between the last sound point and the first one that is off it may drift, within one test.
    """
    if len(d) <= _LEAST_BEFORE:
        return 0, 0
    highest = np.maximum.accumulate(d)
    lowest_after = np.minimum.accumulate(d[::-1])[::-1]
    begins = np.arange(_LEAST_BEFORE, len(d))
    before = highest[begins - 1]
    # where it stays beyond the limit from then on; the first point that leaves what was usual for good
    off = np.searchsorted(lowest_after, before + _LEAST_K, side="right")
    leaves = lowest_after[begins] > before + _LEAVES_K
    ok: Bool1D = leaves & (off < len(d))
    ok &= np.where(off > begins, of[np.clip(off - 1, 0, len(d) - 1)] == of[begins], True)
    for b, o in zip(begins[ok].tolist(), off[ok].tolist(), strict=True):
        whole = [i for i in np.unique(of[o:]).tolist() if int(np.searchsorted(of, i)) >= o]
        if any(level[i] >= _LEVEL_SHARE for i in whole):  # off from its first point on, though the machine had rested
            return b, o
        follows = float(np.ptp(d[o:])) <= float(np.ptp(d[:b])) + _FOLLOWS_K
        if len(whole) > 1 and follows and all(level[i] >= _FOLLOWS_SHARE for i in whole):
            return b, o
    return 0, 0
