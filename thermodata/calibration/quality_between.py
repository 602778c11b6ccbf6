"""A temperature sensor that fails between two tests: from one day on it reads many kelvin more than its neighbours.

Within a test such a sensor looks sound. Its difference from the median of all other temperatures gives it away: it
lies beyond all that was seen before, in every later test and throughout, even at the start of a test before which the
machine stood long enough for its parts to level out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from thermodata.plugin import Array, Bool1D, Float1D, Float2D

POINTS = 24  # of a test, evenly spread over it
_LEAST_K = 8.0
_RESTED_S = 4 * 3600.0  # bearings and motors cool in one to two hours
_LEAST_OTHERS = 3


@dataclass(frozen=True, slots=True)
class Levels:
    """Temperatures of a test at POINTS moments; channel -> shape (POINTS,), degC, NaN where nothing valid is."""

    test: str
    start_s: float
    end_s: float
    series: Mapping[str, Float1D]


def offsets_between_tests(tests: Sequence[Levels]) -> dict[tuple[str, str], float]:
    """(test, channel) -> by how much the channel is off [K], for every test from the failure on.

    start_s, end_s: on one absolute clock [s]. A channel needs three others to be compared with. Nothing is said where
    no later test began after a rest, for then a part that stays hot would look the same.
    """
    ordered = sorted(tests, key=lambda t: t.start_s)
    ends = accumulate((t.end_s for t in ordered), max)
    rested = [False] * bool(ordered) + [t.start_s - end >= _RESTED_S for t, end in zip(ordered[1:], ends, strict=False)]
    offsets: dict[tuple[str, str], float] = {}
    for channel, spans in _differences(ordered).items():
        told = np.flatnonzero(np.isfinite(spans[:, 0]))
        change = _change(spans[told], np.array(rested, bool)[told])
        if change is None:
            continue
        at, size = change
        offsets |= {(ordered[i].test, channel): size for i in told[at:]}
    return offsets


def _differences(tests: Sequence[Levels]) -> dict[str, Float2D]:
    """Channel -> shape (tests, 3): lowest, highest and median difference [K] from the median of the others; NaN where
    untold."""
    spans = {c: np.full((len(tests), 3), np.nan) for c in dict.fromkeys(c for t in tests for c in t.series)}
    alike: dict[tuple[str, ...], list[int]] = {}
    for i, test in enumerate(tests):
        alike.setdefault(tuple(test.series), []).append(i)
    for names, at in alike.items():
        stacked = np.array([[tests[i].series[name] for name in names] for i in at])
        for k, name in enumerate(names):
            own, others = stacked[:, k], np.delete(stacked, k, axis=1)
            enough = np.isfinite(own) & (np.isfinite(others).sum(axis=1) >= _LEAST_OTHERS)
            some = enough.any(axis=1)
            if not some.any():
                continue
            d = np.where(enough, own - _median(others, 1), np.nan)[some]
            spans[name][np.array(at)[some]] = np.stack(
                [np.nanmin(d, axis=1), np.nanmax(d, axis=1), _median(d, 1)], axis=1
            )
    return spans


def _median(values: Array, axis: int) -> Array:
    """The median of what is finite; NaN where nothing is. numpy's own takes 0.4 ms a call for the few values of a
    test."""
    ordered = np.sort(np.where(np.isfinite(values), values, np.nan), axis=axis)  # NaN goes to the end
    count = np.isfinite(ordered).sum(axis=axis, keepdims=True)
    low = np.take_along_axis(ordered, np.maximum((count - 1) // 2, 0), axis)
    high = np.take_along_axis(ordered, np.minimum(count // 2, ordered.shape[axis] - 1), axis)
    return np.where(count > 0, (low + high) / 2, np.nan).squeeze(axis)


def _change(spans: Float2D, rested: Bool1D) -> tuple[int, float] | None:
    """(first test that is off, by how much): where all differences after lie beyond all before. spans: shape (n, 3),
    nothing of it NaN."""
    if len(spans) < 2:
        return None
    low, high, middle = spans.T
    # of a split before test i: the extremes of those before it, and from it on
    up = np.minimum.accumulate(low[::-1])[::-1][1:] - np.maximum.accumulate(high)[:-1]
    down = np.minimum.accumulate(low)[:-1] - np.maximum.accumulate(high[::-1])[::-1][1:]
    size = np.maximum(up, down)
    size[~np.logical_or.accumulate(rested[::-1])[::-1][1:]] = -np.inf
    split = int(np.argmax(size)) + 1
    if size[split - 1] <= _LEAST_K:
        return None
    return split, float(np.median(middle[split:]) - np.median(middle[:split]))
