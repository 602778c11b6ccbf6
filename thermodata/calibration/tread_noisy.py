"""The tread of a staircase that carries noise of its own: levels a common spacing apart, on which a reading stands
within its noise (a gauge of 2 um behind a converter that counts in 0.09 um)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.plugin import Float1D

MOST = 1e30  # beyond which a number is what an instrument writes for none
PART = 500  # samples with a zero of their own, so that a slip of the probe costs one part only
MOST_PARTS = 40  # evenly taken
RISER = 6.0  # of the usual change of neighbours: what is more is no noise
LEAST_LEVEL = 3  # samples that stand together
LEAST_RISES = 8  # between levels, or nothing is proved
LEAST_LEVELS = 3  # of a staircase: two levels are a switch
SINGLE = 0.6  # least share of the rises that are one tread
ON = 0.15  # of a tread: a level so near to a multiple is on it, by chance three of ten
ON_TREAD = 0.75  # least share of the levels' samples that are on it
STANDING = 0.5  # least share of all samples that stand on a level
FLAT = 0.15  # of a tread: a level may wander by so much, from its first half to its second one; four of five do not


def noisy_tread_of(stretches: Sequence[Float1D]) -> float:
    """The largest spacing of flat levels that a reading jumps between, in its unit; 0 where there is none.

    stretches: of one channel, each of shape (n,) and with a zero of its own. A machine that is switched drifts on each
    of its levels and comes back to none exactly, so it is no staircase.
    """
    parts = [p for x in stretches if len(x) for p in np.array_split(x, max(1, len(x) // PART))]
    if not parts:
        return 0.0
    parts = [parts[i] for i in np.unique(np.linspace(0, len(parts) - 1, MOST_PARTS).astype(int))]
    found = [levels for p in parts if (levels := _levels(p[np.abs(p) < MOST])) is not None]
    samples = sum(len(p) for p in parts)
    if not found or sum(int(lengths.sum()) for _, lengths, _, _ in found) < STANDING * samples:
        return 0.0
    zeroed = np.concatenate([m - m[np.argmax(lengths)] for m, lengths, _, _ in found])
    weight = np.concatenate([lengths for _, lengths, _, _ in found])
    wander = np.concatenate([w for _, _, w, _ in found])
    rises = np.concatenate([r for _, _, _, r in found])
    # a slow signal climbs a staircase tread by tread, so most rises are one
    tread = float(np.median(rises)) if len(rises) >= LEAST_RISES else 0.0
    if tread <= 0:
        return 0.0
    tread = _fitted(zeroed, tread)
    single = np.abs(rises / tread - 1) < ON
    k = zeroed / tread
    on = np.abs(k - np.round(k)) < ON
    holds = (
        weight[on].sum() >= ON_TREAD * weight.sum()
        and float(np.mean(single)) >= SINGLE
        and len(np.unique(np.round(k[on]))) >= LEAST_LEVELS
        and float(np.quantile(wander, 0.8)) < FLAT * tread
    )
    return tread if holds else 0.0


def _levels(x: Float1D) -> tuple[Float1D, Float1D, Float1D, Float1D] | None:
    """(mean, samples, wander) of each stretch without a riser, shape (levels,); and the rises between them."""
    if len(x) < 2 * LEAST_LEVEL:
        return None
    d = np.abs(np.diff(x))
    usual = float(np.median(d))
    riser = max(RISER * usual, 1e-9 * float(np.ptp(x)))
    edges = np.flatnonzero(d > riser) + 1
    if not len(edges):
        return None
    starts, stops = np.concatenate([[0], edges]), np.concatenate([edges, [len(x)]])
    long = stops - starts >= LEAST_LEVEL
    starts, stops = starts[long], stops[long]
    if not len(starts):
        return None
    total = np.concatenate([[0.0], np.cumsum(x - x[0])])
    middle = (starts + stops) // 2
    first = (total[middle] - total[starts]) / (middle - starts)
    second = (total[stops] - total[middle]) / (stops - middle)
    mean = (total[stops] - total[starts]) / (stops - starts)
    rises = np.abs(np.diff(mean))
    # it flickers about a riser, and is on the level before again
    return mean, (stops - starts).astype(np.float64), np.abs(second - first), rises[rises > riser / 2]


def _fitted(zeroed: Float1D, tread: float) -> float:
    """The spacing by least squares over the levels near to a multiple of it."""
    for reach in (5, 50):
        k = zeroed / tread
        near = np.round(k)
        used = (np.abs(near) <= reach) & (np.abs(k - near) < 2 * ON)
        power = float(near[used] @ near[used])
        if power > 0:
            tread = float(near[used] @ zeroed[used]) / power
    return tread
