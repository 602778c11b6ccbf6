"""Whether what cools a machine ran in some tests and in others not: what it cools answers by another factor then."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.schema.words.places import cools
from thermodata.view.grid.dataset import TestData

SWITCHED = ("state", "flow")


def cooled_otherwise(before: Sequence[TestData], after: Sequence[TestData]) -> bool:
    """Whether coolant, a chiller, oil or a fan ran in all tests of one side, and in none of the other."""
    names = [n for n, c in before[0].channels.items() if c.quantity in SWITCHED and cools(c.at)]
    sides = [({_ran(t, n) for t in before}, {_ran(t, n) for t in after}) for n in names]
    return any(side in (({True}, {False}), ({False}, {True})) for side in sides)


def _ran(test: TestData, name: str) -> bool | None:
    """Whether something was on at any time; None where it was not logged."""
    values = test.values.get(name, np.empty(0))
    known = values[np.isfinite(values)]
    return bool(np.any(known != 0)) if len(known) else None
