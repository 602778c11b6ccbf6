"""How coarse a reading is: the tread of its staircase, from the values alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.calibration.tread_noisy import LEAST_LEVELS, MOST, PART, noisy_tread_of
from thermodata.plugin import Float1D

MOST_ROWS = 20_000  # of a stretch: its middle tells as much
SAME = 1e-9  # of the range: means of equal readings differ in their last bits
LEAST_STANDING = 20  # samples, or there is nothing to say
MOST_RISES = 12  # that a spacing is sought among, the commonest ones
OFF = 0.05  # of a tread: a value so near to a multiple is on it, by chance one of ten
ON_TREAD = 0.5  # least share of the standing samples that are on it
FINER = 0.1  # more than chance: a finer spacing that holds so many more is the tread
MOVES = 0.04  # of a tread, the mean of what moves, a tread at most: bins spread a riser over few moves
FILLED = 0.5  # of a tread, the same over all samples, one that stands as a whole one
COARSER = 1.5  # than the exact tread, or levels with noise are the same ones, known less exactly
NEAR, FAR = 10, 1000  # treads from the commonest level that the spacing is fitted over, first and then


def tread_of(stretches: Sequence[Float1D]) -> float:
    """The spacing that a reading moves by at once, in its unit, be it exact or with noise of its own; 0 where it is
    finer than what it reads. stretches: of one channel, each of shape (n,) and with a zero of its own (a test)."""
    exact, noisy = exact_tread_of(stretches), noisy_tread_of(stretches)
    return noisy if noisy > COARSER * exact else exact


def exact_tread_of(stretches: Sequence[Float1D]) -> float:
    """The largest common spacing of the values at which a reading stands still, in its unit; 0 where there is none.

    stretches: of one channel, each of shape (n,) and with a zero of its own (a test); raw readings, or means over bins:
    a bin that a riser falls into lies between two treads, but the next one seldom reads the same. A reading finer
    than its noise stands by chance only: its tread is its last digit, or 0 where it hardly ever stands.
    """
    parts = [part for x in stretches for part in _parts(x)]
    standing = [s for part in parts if len(s := _repeated_samples(part))]
    if sum(map(len, standing)) < LEAST_STANDING:
        return 0.0
    zeroed = np.concatenate([s - _commonest(s) for s in standing])
    # from the finest up: a multiple of the tread holds some of its levels only
    best, held = 0.0, 0.0
    for candidate in _candidate_treads(standing):
        tread = _fitted(zeroed, candidate)
        k = zeroed / tread
        on = np.abs(k - np.round(k)) < OFF
        if on.mean() > max(FINER, held - FINER):
            best, held = tread, max(held, float(on.mean()))
    k = np.round(zeroed / best) if best else np.zeros(1)
    holds = held >= ON_TREAD and len(np.unique(k)) >= LEAST_LEVELS and _moves_by(parts, best)
    return best if holds else 0.0


def _moves_by(parts: Sequence[Float1D], tread: float) -> bool:
    """Whether the reading moves by such treads: it stands or moves by one at least. Readings of a fine one that are
    alike by chance, a few of thousands, may have a spacing too, but what lies between them moves by far less."""
    moves = [np.minimum(np.abs(np.diff(part)) / tread, 1.0) for part in parts]
    all_of_them = np.concatenate(moves)
    moved = np.concatenate([m > SAME * np.ptp(part) / tread for m, part in zip(moves, parts, strict=True) if len(m)])
    filled = np.where(moved, all_of_them, 1.0)
    return bool(filled[moved].mean() >= MOVES and filled.mean() >= FILLED)


def _parts(x: Float1D) -> list[Float1D]:
    x = x[np.abs(x) < MOST]
    start = max(0, (len(x) - MOST_ROWS) // 2)
    x = x[start : start + MOST_ROWS]
    return np.array_split(x, max(1, len(x) // PART))


def _repeated_samples(x: Float1D) -> Float1D:
    """The samples that equal the one before."""
    return x[1:][np.abs(np.diff(x)) <= SAME * np.ptp(x)] if len(x) > 1 else x[:0]


def _commonest(x: Float1D) -> float:
    values, counts = np.unique(x, return_counts=True)
    return float(values[np.argmax(counts)])


def _candidate_treads(standing: Sequence[Float1D]) -> list[float]:
    """Rises between levels that follow each other, and differences of such rises; the smallest first."""
    rises = np.concatenate([np.abs(np.diff(s)) for s in standing])
    span = max(float(np.ptp(s)) for s in standing)
    rises = np.round(rises[rises > SAME * span], 9)
    values, counts = np.unique(rises, return_counts=True)
    common = values[np.argsort(-counts, kind="stable")[:MOST_RISES]]
    between = np.round(np.abs(common[:, None] - common), 9).ravel()
    both = np.unique(np.concatenate([common, between]))
    return [float(c) for c in both[both > 1e-6 * span]]


def _fitted(zeroed: Float1D, tread: float) -> float:
    """The spacing by least squares over the levels: one rise is known to the last digit only."""
    for reach in (NEAR, FAR):
        k = np.round(zeroed / tread)
        used = (np.abs(k) <= reach) & (np.abs(zeroed / tread - k) < OFF)
        power = float(k[used] @ k[used])
        if power > 0:
            tread = float(k[used] @ zeroed[used]) / power
    return tread
