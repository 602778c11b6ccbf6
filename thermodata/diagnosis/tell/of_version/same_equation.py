"""Candidates of several names that are one equation: a lag of a channel, and an effect that is a lag of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Float2D
from thermodata.view.grid.dataset import TestData

ALIKE = 1e-6  # of the largest value: columns that differ by less are one


def may_be(one: Scored, other: Scored, tests: Sequence[TestData]) -> bool:
    """Whether it can do all that another does at its likeliest point of the grid, by parameters that it may have: there
    both are one equation of the same channels, but for the unit of a gain."""
    a, b = one.candidate, other.candidate
    if set(a.channels) != set(b.channels) or a.within or b.within or not one.columns.points:
        return False
    at = other.columns.points[other.weighed.best[0]]
    ours, theirs = ({p.name: p for p in c.effect.params} for c in (a, b))
    shared = {n: at[n] for n in ours if n in theirs and n in at and ours[n].unit == theirs[n].unit}
    ends = {n: ours[n].reach or (ours[n].lower, ours[n].upper) for n in shared}
    if any(not ends[n][0] <= value <= ends[n][1] for n, value in shared.items()):
        return False
    does = [b.in_test(t)(at) for t in tests]
    points = {tuple({**p, **shared}.items()) for p in one.columns.points}
    return any(_in_proportion([a.in_test(t)(dict(point)) for t in tests], does) for point in sorted(points))


def _in_proportion(some: Sequence[Float2D], others: Sequence[Float2D]) -> bool:
    """Whether columns of tests are others times one number each."""
    ours, theirs = np.vstack(some), np.vstack(others)
    if ours.shape != theirs.shape:
        return False
    size = np.abs(theirs).max(axis=0)
    if not np.all(size > 0) or not np.all(np.isfinite(ours)):
        return False
    times = (ours * theirs).sum(axis=0) / (theirs**2).sum(axis=0)
    return bool(np.all(np.abs(ours - times * theirs).max(axis=0) <= ALIKE * np.abs(times) * size))
