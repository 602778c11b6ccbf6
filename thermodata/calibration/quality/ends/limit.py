"""Readings that no sensor of the kind can give, and those at the end of a sensor's range that nobody declared."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from thermodata.calibration.quality.value import RunStats, is_staircase, refreshed, run_stats, true_runs
from thermodata.plugin import Array, Bool1D, Float1D

# of the declared range: a signal that is cut off stands within noise and a code or two of its limit, and a converter
# ends before its nominal full scale by its gain error, up to 0.1 % (19.98 V of 20 V)
AT_END = 1.5e-3
# What can be measured in a lab, in canonical units: heaters and cuts are hot, no machine is colder than -60 degC.
_POSSIBLE = {
    "temperature": (-60.0, 1500.0),
    "humidity": (-5.0, 110.0),
    "rotational_speed": (-500_000.0, 500_000.0),
    "temperature_difference": (-1500.0, 1500.0),
    "irradiance": (-100.0, 3000.0),
    "flow": (-1e5, 1e5),
    # no machine is so long, strong or fast, in whatever unit of its kind somebody took the log to be; a multimeter's
    # overload of 1E+9 is none of it
    **dict.fromkeys(("displacement", "position", "tilt", "angle", "voltage"), (-1e8, 1e8)),
    **dict.fromkeys(("power", "load", "current", "torque", "feed"), (-1e6, 1e6)),
    "pressure": (-1e7, 1e7),
}
# What loggers write for "no value": full scale of their counters (with one decimal too), and rows of nines, with and
# without decimals, also as a number of single precision holds these.
_COUNTER = [32767.0, -32768.0, 3276.7, -3276.8, 6553.5, 65535.0]
# ... those of 32 bits in tenths to thousandths, as double and as single precision, and what multimeters write for an
# overload (Fluke +001.00E+9, others 9E+9 and 9.9E+9)
_LONG = np.outer([2147483647.0, -2147483648.0, 4294967295.0], [1.0, 0.1, 0.01, 0.001]).round(3).ravel()
_OVERLOAD = [1e9, -1e9, 9e9, -9e9, 9.9e9, -9.9e9]
_FULL_SCALE = np.concatenate([_COUNTER, _LONG, _LONG.astype(np.float32).astype(np.float64), _OVERLOAD])
_NINES = np.array(
    [
        *(float(f"{sign}{'9' * n}") for sign in ("", "-") for n in (4, 5, 6)),
        -999.0,  # as a reading 999 may be anything
        *(float(f"{sign}{'9' * n}.{'9' * k}") for sign in ("", "-") for n in (3, 4, 5, 6) for k in range(1, 7)),
    ]
)
_SINGLE = _NINES.astype(np.float32).astype(np.float64)
_NINES = np.union1d(_NINES, _SINGLE[_SINGLE % 1 != 0])
_CAMPBELL = [6999.0, -6999.0, 7999.0, -7999.0]  # beyond its range, in numbers of two bytes
_SENTINELS = np.concatenate([_FULL_SCALE, _NINES, _CAMPBELL])
# a byte's full scale is no share of what is rated, and a row of nines may be what somebody commands: see `no_values`
_CODES = {
    "load": np.append(_SENTINELS, 255.0),
    **dict.fromkeys(("rotational_speed", "feed", "position", "angle"), _FULL_SCALE),
}
_SPEEDS = [6999.0, 7999.0, 9999.0]  # that spindles have, and rapid feeds
_FAR, _SELDOM = 10.0, 0.05  # spans of the rest, beyond which no drive goes; the share of samples that are codes
_HUGE = 1e30
_HOT, _LEAP_K = 250.0, 100.0  # a broken Pt100 reads 850 degC from one sample to the next
_PILES_UP = 2.0  # times as many samples at the end of a range as on the reading next to it
NO_VALUE = "a logger's code for 'no value'"
SAY_RANGE = "the end of a range? say it in 'sensor: {range: ...}'"
_ANALOG_FULL_SCALE = frozenset({"displacement", "voltage", "tilt"})


def impossible(x: Float1D, quantity: str, own: RunStats | None = None) -> Bool1D:
    """Where x, shape (n,), in the quantity's canonical unit, is no reading of it."""
    low, high = _POSSIBLE.get(quantity, (-_HUGE, _HUGE))
    if (
        own is not None
        and own.low >= low
        and own.high <= (_HOT if quantity == "temperature" else high)
        and own.low > -_HUGE
        and own.high < _HUGE
    ):
        return np.zeros(len(x), dtype=bool)
    with np.errstate(invalid="ignore"):
        beyond = np.abs(x) >= _HUGE
        if quantity in _POSSIBLE:
            low, high = _POSSIBLE[quantity]
            beyond |= (x < low) | (x > high)
        if quantity == "temperature":
            beyond |= _leaps(x, (x > _HOT) & ~beyond)
    return beyond


def _leaps(x: Float1D, hot: Bool1D) -> Bool1D:
    """Those stretches of `hot` that begin or end with a leap: what is heated passes through the values between."""
    mask = np.zeros_like(hot)
    for start, stop in zip(*true_runs(hot), strict=True):
        into = abs(x[start] - x[start - 1]) if start else 0.0
        out = abs(x[stop - 1] - x[stop]) if stop < len(x) else 0.0
        if max(into, out) > _LEAP_K:
            mask[start:stop] = True
    return mask


def codes_of(quantity: str) -> Float1D:
    """A logger's codes for "no value" of a quantity, as it writes them: in the unit that it logs in. Shape (codes,)."""
    return _CODES.get(quantity, _SENTINELS)


def no_values(x: Float1D, quantity: str, written: Float1D | None = None) -> Bool1D:
    """The same of a drive or a flow, which may leave where it is and come back within a few samples: a ramp to a code,
    or what is commanded so, is a reading. x: shape (n,), in the quantity's canonical unit; written: the codes as they
    are in it, where x was logged in another."""
    codes = _with_written(codes_of(quantity), written)
    ends = np.array([np.fmin.reduce(x), np.fmax.reduce(x)]) if len(x) else np.zeros(2)
    never = _never_commanded(x, ends) if quantity in _CODES else np.zeros(len(x), dtype=bool)
    if not (np.isin(ends, codes) | (np.abs(ends) >= _HUGE)).any():
        return never
    return never | sentinels(x, run_stats(x), codes)


def _never_commanded(x: Float1D, ends: Float1D) -> Bool1D:
    """Where a code that may be commanded, as a row of nines, is none of it, shape (n,): seldom, without a ramp to it,
    and below zero where the rest never is, or many spans beyond the rest. ends: the least and the largest of x."""
    none: Bool1D = np.zeros(len(x), dtype=bool)
    if not np.isin(ends, _SENTINELS).any():
        return none
    coded: Bool1D = np.isin(x, _SENTINELS)
    rest = x[~coded & np.isfinite(x)]
    if len(rest) < 10 or np.count_nonzero(coded) > _SELDOM * len(x):
        return none
    low, high = float(rest.min()), float(rest.max())
    span = max(high - low, abs(high), 1.0)
    below = (x < 0) & (low >= 0) & ~np.isin(-x, x[x > 0])
    far = (x > high + _FAR * span) & ~np.isin(x, _SPEEDS) | (x < low - _FAR * span)
    return coded & (below | far)


def _with_written(codes: Float1D, written: Float1D | None) -> Float1D:
    return codes if written is None or not len(written) else np.union1d(codes, written)


def sentinels(x: Float1D, own: RunStats, codes: Float1D = _SENTINELS, written: Float1D | None = None) -> Bool1D:
    """Where x, shape (n,), is a logger's code for "no value", far outside of what the channel reads else."""
    codes = _with_written(codes, written)
    none: Bool1D = np.zeros(len(x), dtype=bool)
    ends = np.array([own.low, own.high])
    if np.isfinite(own.leap) and not (np.isin(ends, codes) | (np.abs(ends) >= _HUGE)).any():
        return none
    with np.errstate(invalid="ignore"):
        rest = x[np.abs(x) < _HUGE]  # an overflow beside them is no reading either
    coded: list[float] = []
    # a code is an extreme, once those beyond it are left out; between others it is a reading
    while len(rest) >= 10 and len(at := np.intersect1d([rest.min(), rest.max()], codes)):
        coded += at.tolist()
        rest = rest[~np.isin(rest, at)]
    if not coded or len(rest) < 10:
        return none
    middle, spread = float(np.median(rest)), float(np.ptp(rest))
    return np.isin(x, coded) & (np.abs(x - middle) > 3 * max(spread, own.step))


def clipped(
    x: Float1D, own: RunStats, quantity: str, *, rests_below: float | None = None
) -> Iterator[tuple[Bool1D, float, str]]:
    """(where, limit, why) for each end of the range that x, shape (n,), runs into.

    A fine and noisy channel does not repeat its extreme by chance. A smooth one must come to the very same value
    more than once. A jump to the limit is told apart from a held or stuck reading by coming back to it, and only
    for sensors that have a full scale in reach (displacement, voltage). rests_below: a lowest reading under that is
    where it rests.
    """
    if not own.float_like or own.step <= 0:
        return
    values = x if np.isfinite(own.leap) else x[np.isfinite(x)]
    if len(values) < 50:
        return
    every, _ = refreshed(own.lengths, len(x))  # a reading is one, however often it is logged
    for limit, side in ((float(values.max()), "upper"), (float(values.min()), "lower")):
        at: Bool1D = x == limit
        count = int(at.sum())
        if side == "lower" and rests_below is not None and limit <= rests_below:
            continue
        if count < 10 * every or limit == 0.0 or count > 0.5 * len(values) or is_staircase(x, own):
            continue
        # what is cut off piles up there; an extreme that was only reached is seldomer than the reading next to it
        inside = values[values != limit]
        beside = int((values == (inside.max() if side == "upper" else inside.min())).sum())
        if count <= _PILES_UP * beside:
            continue
        starts, stops = true_runs(at)
        creeps = _approach(x, starts, stops) < 20 * own.step
        noisy = own.alternates >= 0.2
        if quantity not in _ANALOG_FULL_SCALE:
            if not (noisy and creeps.mean() > 0.5 and len(starts) > 1):
                continue
        elif not (len(starts) > 2 or (noisy and bool(creeps.all()) and starts[0] > 0)):
            continue  # from the first row on, it may as well be held
        yield (
            at,
            limit,
            f"{side} limit {limit:.6g}, {len(starts)} times exactly: {SAY_RANGE}",
        )


def _approach(x: Float1D, starts: Array, stops: Array) -> Float1D:
    """The smaller one of the steps into and out of each stretch, shape (stretches,)."""
    n = len(x)
    before = np.abs(x[starts] - x[np.maximum(starts - 1, 0)])
    after = np.abs(x[np.minimum(stops, n - 1)] - x[stops - 1])
    before[starts == 0], after[stops == n] = np.inf, np.inf
    return np.asarray(np.fmin(before, after))
