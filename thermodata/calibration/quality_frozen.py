"""A temperature sensor that freezes while it is logged: it flickered by a count or more all the time, and from one
moment on reads the same to the last digit.

Nothing jumps where it freezes, and nothing needs to come back. What tells it is its own noise: a reading that changes
every few samples, in its calmest stretches too, does not stand for half an hour by chance. One that counts coarsely, or
whose noise comes from the drives and goes with them, does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from thermodata.calibration.quality_value import RunStats
from thermodata.plugin import Array, Float1D

_LEAST_S = 1800.0
_LEAST_SAMPLES = 100
_STRETCH = 50  # samples that tell how often it changes
_LEAST_STRETCHES = 4
_MOST_EQUAL = 0.6  # of the neighbours, in every stretch: noise of half a count's standard deviation makes fewer
# counts, root mean square of the second differences: noise of 0.45 counts makes so much, and a smooth course that
# counts coarsely never more than 1; in all stretches but the calmest tenth
_NOISE, _CALMEST = 1.3, 0.1
_GO_ON = 0.5  # of the other temperatures go on: they change half as often as elsewhere, at least


def frozen_runs(x: Float1D, t_ns: Array, own: RunStats, others: Mapping[str, Array]) -> Iterator[tuple[int, int, str]]:
    """(start, stop, why) of stretches in which a temperature x, shape (n,), is frozen. others: the temperatures
    that are logged with it; where there is none, or most of them rest as well, nothing is told."""
    long = own.lengths >= _LEAST_SAMPLES
    runs = [
        (start, start + length)
        for start, length in zip(own.starts[long].tolist(), own.lengths[long].tolist(), strict=True)
        if t_ns[start + length - 1] - t_ns[start] >= _LEAST_S * 1e9
    ]
    if not runs or not others:
        return
    equal = _equal_in_noise(x, own.finest, runs)
    if equal is None or equal > _MOST_EQUAL:
        return
    for start, stop in runs:
        if np.mean([_goes_on(y, start, stop) for y in others.values()]) >= _GO_ON:
            yield start, stop, f"exactly {x[start]:.6g} for {stop - start} samples; elsewhere it changes all the time"


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


def _goes_on(y: Array, start: int, stop: int) -> bool:
    """Whether y changes in rows [start, stop) half as often as outside of them, at least."""
    changes = y[1:] != y[:-1]
    within = changes[start : stop - 1]
    outside = np.concatenate([changes[:start], changes[stop - 1 :]])
    return bool(within.any() and (not outside.size or within.mean() >= outside.mean() / 2))
