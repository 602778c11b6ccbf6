"""Whether a contribution acts alike in all tests: a cause does, what only goes with it does not.

A contribution gets a factor of its own in each test, f_i ~ N(mean, spread^2), and the spread is integrated over its
likelihood (a random-effects meta-analysis [dersimonian1986], restricted likelihood). Invariance of a cause under
changes that do not touch it: [peters2016].
"""

from __future__ import annotations

import numpy as np

from thermodata.diagnosis.question.known import Known, solved
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D

SPREADS = np.array([0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5])


def spread_of_gain(known: Known, white: Float1D, acts: Bool1D) -> float:
    """Standard deviation of the factor between tests, as a share of 1: the mean over its likelihood, flat over
    `SPREADS`. white: the contribution in all tests, whitened, shape (rows,). acts: in which tests it does something,
    shape (tests,).

    Of all tests, or of those in which it acts, the factors of the others left free, whichever is less: where it rests
    its gain may speak for it, and not against it, for what else moves there it hardly moves.
    """
    size = known.space.each(white**2)
    moves = size > 1e-6 * size.max()
    if moves.sum() < 2:
        return 1.0
    both = known.space.each(known.both * white[:, None])
    cross, right = both[:, :-1], both[:, -1]
    precision = np.diag(size) - cross @ solved(known.factor(known.every), cross.T)
    right = right - cross @ known.mean(known.every)
    precision[np.diag_indices_from(precision)] += 1e-9 * size.max()
    asked = {tuple(np.flatnonzero(some)) for some in (moves, moves & acts) if some.sum() > 1}
    return min(_spread(*_of_some(precision, right, np.array(some), moves)) for some in asked)


def _spread(precision: Float2D, right: Float1D) -> float:
    weight = _log_likelihood(precision, right)
    weight = np.exp(weight - weight.max())
    return float(weight @ SPREADS / weight.sum())


def _of_some(precision: Float2D, right: Float1D, some: Int1D, moves: Bool1D) -> tuple[Float2D, Float1D]:
    """What the data say of some factors; those of the other tests in which it moves are free."""
    free = np.setdiff1d(np.flatnonzero(moves), some)
    own, across = precision[np.ix_(some, some)], precision[np.ix_(some, free)]
    if not len(free):
        return own, right[some]
    held = np.linalg.solve(precision[np.ix_(free, free)], np.column_stack([across.T, right[free]]))
    return own - across @ held[:, :-1], right[some] - across @ held[:, -1]


def _log_likelihood(precision: Float2D, right: Float1D) -> Float1D:
    """Of the factors' estimates under each of the spreads, their common mean integrated out; relative to free factors,
    shape (spreads,). Along the directions of the precision P the factors are apart."""
    sure, directions = np.linalg.eigh(precision)
    one, along = directions.sum(axis=0), directions.T @ right
    # (P^-1 + s^2)^-1 without inverting P: P / (1 + s^2 P)
    inner = 1.0 + SPREADS[:, None] ** 2 * sure
    weight, toward = (one**2 * sure / inner).sum(axis=1), (one * along / inner).sum(axis=1)
    # quad of the estimates f = P^-1 r under the shared model, less that under P alone, which all spreads share
    quad = SPREADS**2 * (along**2 / inner).sum(axis=1)
    return np.asarray(0.5 * (quad + toward**2 / weight - np.log(inner).sum(axis=1) - np.log(weight)))
