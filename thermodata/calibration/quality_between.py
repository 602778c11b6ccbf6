"""A temperature sensor that fails between two tests: from one day on it reads many kelvin more than its neighbours.

Within a test such a sensor looks sound. Its difference from the median of all other temperatures gives it away: it
lies beyond all that was seen before, in every later test and throughout, even at the start of a test before which the
machine stood long enough for its parts to level out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D

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
    rested = [
        i > 0 and ordered[i].start_s - max(t.end_s for t in ordered[:i]) >= _RESTED_S for i in range(len(ordered))
    ]
    offsets: dict[tuple[str, str], float] = {}
    for channel in dict.fromkeys(c for t in ordered for c in t.series):
        spans = [_difference(t, channel) for t in ordered]
        change = _change(spans, rested)
        if change is None:
            continue
        at, size = change
        offsets |= {(t.test, channel): size for t, s in zip(ordered[at:], spans[at:], strict=True) if s is not None}
    return offsets


def _difference(test: Levels, channel: str) -> tuple[float, float, float] | None:
    """(lowest, highest, median) difference [K] of a channel from the median of the others; None where untold."""
    own = test.series.get(channel)
    others = [x for name, x in test.series.items() if name != channel and np.isfinite(x).any()]
    if own is None or len(others) < _LEAST_OTHERS:
        return None
    stacked = np.stack(others)
    enough = np.isfinite(own) & (np.isfinite(stacked).sum(axis=0) >= _LEAST_OTHERS)
    if not enough.any():
        return None
    d = own[enough] - np.nanmedian(stacked[:, enough], axis=0)
    return float(d.min()), float(d.max()), float(np.median(d))


def _change(spans: Sequence[tuple[float, float, float] | None], rested: Sequence[bool]) -> tuple[int, float] | None:
    """(first test that is off, by how much): where all differences after lie beyond all before."""
    told = [i for i, s in enumerate(spans) if s is not None]
    best: tuple[int, float] | None = None
    widest = _LEAST_K
    for split in range(1, len(told)):
        before = [s for i in told[:split] if (s := spans[i]) is not None]
        after = [s for i in told[split:] if (s := spans[i]) is not None]
        if not any(rested[i] for i in told[split:]):
            continue
        up = min(s[0] for s in after) - max(s[1] for s in before)
        down = min(s[0] for s in before) - max(s[1] for s in after)
        if max(up, down) > widest:
            widest = max(up, down)
            size = float(np.median([s[2] for s in after]) - np.median([s[2] for s in before]))
            best = told[split], size
    return best
