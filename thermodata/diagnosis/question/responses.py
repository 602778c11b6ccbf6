"""Which response of a model is asked about, and how much of each is left."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.errors import unknown_name
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.view.grid.dataset import TestData


def response_index(fitted: FittedModel, tests: Sequence[TestData], name: str | None) -> int:
    """The number of the named response, of the worst one where none is named. UsageError for an unknown one."""
    if name is None:
        return worst_response(fitted, tests)
    names = [response.name for response in fitted.responses]
    if name not in names:
        raise unknown_name("response", name, names, where=f"model '{fitted.spec.name}'")
    return names.index(name)


def worst_response(fitted: FittedModel, tests: Sequence[TestData]) -> int:
    """The number of the response with the largest share of its variance left."""
    return int(np.argmax([-1.0 if left is None else left for left in shares_left(fitted, tests)]))


def shares_left(fitted: FittedModel, tests: Sequence[TestData]) -> list[float | None]:
    """Of each response the share of its variance, test by test, that is left."""
    left: list[float | None] = []
    for response in fitted.responses:
        over, under = 0.0, 0.0
        for test in tests:
            if response.can_predict(test) and (m := response.mask(test)).any():
                y, r = response.measured(test)[m], response.residual(test)[m]
                over += float(np.sum((r - r.mean()) ** 2))
                under += float(np.sum((y - y.mean()) ** 2))
        left.append(over / under if under > 0 else None)
    return left
