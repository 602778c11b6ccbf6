"""Differences between models, test by test and over the tests of a role, each with its interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from thermodata.modelling.compare.difference import Difference, difference, difference_of_tests
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import Dataset

Course = tuple[str, str, str]
"""(campaign, test, response)."""


@dataclass(frozen=True)
class TestDifference:
    """One model's error in a test less that of the pinned one, in the response's unit. low, high: 95 %, None where the
    test has too few independent samples."""

    __test__ = False
    campaign: str
    test: str
    response: str
    model: str
    against: str
    difference_um: float
    low: float | None
    high: float | None

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def between(pinned: Mapping[Course, Float1D], other: Mapping[Course, Float1D]) -> dict[Course, Difference]:
    """Of each course that both have on one grid."""
    found = {
        key: difference(course, other[key])
        for key, course in pinned.items()
        if key in other and len(other[key]) == len(course)
    }
    return {key: d for key, d in found.items() if d is not None}


def over_tests(
    pinned: Mapping[Course, Float1D], other: Mapping[Course, Float1D], tests: Sequence[tuple[str, str]]
) -> Difference | None:
    """Over the (campaign, test) of a role."""
    wanted = set(tests)
    pairs = [
        (course, other[key])
        for key, course in pinned.items()
        if key[:2] in wanted and key in other and len(other[key]) == len(course)
    ]
    return difference_of_tests(pairs)


def differences(models: Sequence[tuple[str, FittedModel, Dataset]]) -> list[TestDifference]:
    """Of all models to the first, over the open tests that both predict. models: (id, model, its data)."""
    courses = [(identity, _courses(fitted, data)) for identity, fitted, data in models]
    against, pinned = courses[0]
    return [
        TestDifference(*key, identity, against, d.value, d.low, d.high)
        for identity, other in courses[1:]
        for key, d in between(pinned, other).items()
    ]


def _courses(fitted: FittedModel, data: Dataset) -> dict[Course, Float1D]:
    return {
        (t.campaign, t.test, r.name): np.where(r.mask(t), r.residual(t), np.nan)[t.in_window]
        for t in fitted.tests(data)
        for r in fitted.responses
        if r.can_predict(t)
    }
