"""A temperature sensor or a probe that freezes while it is logged: it flickered by a count or more all the time, and
from one moment on reads the same to the last digit.

Nothing jumps where it freezes, and nothing needs to come back. What tells it is its own noise: a reading that changes
every few samples, in its calmest stretches too, does not stand for half an hour by chance. One that counts coarsely, or
whose noise comes from the drives and goes with them, does: where it stands while the drives do, and was never seen to
flicker at rest, it may be either.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from thermodata.calibration.quality.value import RunStats, true_runs
from thermodata.plugin import Array, Bool1D, Float1D

LEAST_S = 1800.0
LEAST_SAMPLES = 100
_STRETCH = 50  # samples that tell how often it changes
_LEAST_STRETCHES = 4
_MOST_EQUAL = 0.6  # of the neighbours, in every stretch: noise of half a count's standard deviation makes fewer
# counts, root mean square of the second differences: noise of 0.45 counts makes so much, and a smooth course that
# counts coarsely never more than 1; in all stretches but the calmest tenth
_NOISE, _CALMEST = 1.3, 0.1
_GO_ON = 0.5  # of the other temperatures go on: they change half as often as elsewhere, at least
# up to which a drive stands, in the canonical unit [rpm, m/min]
_STANDS = {"rotational_speed": 5.0, "feed": 0.01}
# typical changes by which the first readings behind a rest may be off: a frozen sensor leaps by what it missed
_BACK, _FIRST = 4.0, 5


def drives_stand(drives: Sequence[tuple[str, Array]]) -> Bool1D | None:
    """Where all speeds and feeds that are logged with a temperature stand, shape (n,); None where none is. drives:
    (quantity, values) of columns, of which the others are left out."""
    known = [
        np.abs(np.asarray(v, np.float64)) <= _STANDS[q] for q, v in drives if q in _STANDS and v.dtype.kind in "iuf"
    ]
    return np.logical_and.reduce(known) if known else None


def frozen_runs(
    x: Float1D, t_ns: Array, own: RunStats, others: Mapping[str, Array], stand: Bool1D | None
) -> Iterator[tuple[int, int, str]]:
    """(start, stop, why) of stretches in which a temperature or a probe x, shape (n,), is frozen. others: those of its
    kind that are logged with it; where there is none, or most of them rest as well, nothing is told. stand: see
    `drives_stand`."""
    long = own.lengths >= LEAST_SAMPLES
    runs = [
        (start, start + length)
        for start, length in zip(own.starts[long].tolist(), own.lengths[long].tolist(), strict=True)
        if t_ns[start + length - 1] - t_ns[start] >= LEAST_S * 1e9
    ]
    if not runs or not others:
        return
    if not flickers(x, own.finest, runs):
        return
    quiet = stand is not None and not _flickers_at_rest(stand, runs)
    for start, stop in runs:
        if quiet and stand is not None and _goes_with_drives(x, start, stop, stand, own.step):
            continue
        if np.mean([_goes_on(y, start, stop) for y in others.values()]) >= _GO_ON:
            yield start, stop, f"exactly {x[start]:.6g} for {stop - start} samples; elsewhere it changes all the time"


def flickers(x: Float1D, count: float, runs: list[tuple[int, int]]) -> bool:
    """Whether a channel x, shape (n,), changes every few samples, by noise of its own, all the time outside of some
    runs. count: its least change."""
    equal = _equal_in_noise(x, count, runs)
    return equal is not None and equal <= _MOST_EQUAL


def _equal_in_noise(x: Float1D, count: float, runs: list[tuple[int, int]]) -> float | None:
    """The largest share of equal neighbours in any stretch outside of the runs; None where too few tell it, or
    they show no noise. count: the least change."""
    edges = [0, *(row for run in runs for row in run), len(x)]
    equal, noise = [np.empty(0)], [np.empty(0)]
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        many = (last - first) // _STRETCH
        d = np.diff(x[first : first + many * _STRETCH].reshape(many, _STRETCH), axis=1)
        d = d[np.isfinite(d).all(axis=1)]
        equal.append(np.mean(d == 0, axis=1))
        noise.append(np.sqrt(np.mean(np.diff(d, axis=1) ** 2, axis=1)))
    shares, rms = np.concatenate(equal), np.concatenate(noise)
    if len(shares) < _LEAST_STRETCHES or np.quantile(rms, _CALMEST) < _NOISE * count:
        return None
    return float(shares.max())


def _flickers_at_rest(stand: Bool1D, runs: list[tuple[int, int]]) -> bool:
    """Whether a channel, which flickers in every stretch outside of the runs, was seen at rest for a stretch there."""
    rest = stand.copy()
    for start, stop in runs:
        rest[start:stop] = False
    starts, stops = true_runs(rest)
    return bool((stops - starts >= _STRETCH).any())


def _goes_with_drives(x: Float1D, start: int, stop: int, stand: Bool1D, step: float) -> bool:
    """Whether x stands no longer than the drives do, and goes on from where it stood."""
    back = x[stop : stop + _FIRST]
    return bool(
        np.count_nonzero(~stand[start:stop]) < _STRETCH
        and (not back.size or abs(float(np.median(back)) - x[start]) <= _BACK * step)
    )


def _goes_on(y: Array, start: int, stop: int) -> bool:
    """Whether y changes in rows [start, stop) half as often as outside of them, at least."""
    changes = y[1:] != y[:-1]
    within = changes[start : stop - 1]
    outside = np.concatenate([changes[:start], changes[stop - 1 :]])
    return bool(within.any() and (not outside.size or within.mean() >= outside.mean() / 2))
