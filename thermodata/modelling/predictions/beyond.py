"""Where a prediction goes beyond the tests that its model is fitted to: an effect is known as far as it was seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.predictions.predict import Predicted
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedTerm
from thermodata.view.grid.dataset import Dataset, TestData

# of what an effect does in fitted tests, and of what is predicted: less is within what a fit is uncertain by anyway
OF_FITTED, OF_PREDICTED = 0.1, 0.05


@dataclass(frozen=True, slots=True)
class Beyond:
    """What an effect does in a predicted test, from its start, and at most in fitted ones on that side [unit]."""

    campaign: str
    test: str
    response: str
    unit: str
    effect: str
    drivers: tuple[str, ...]
    reaches: float
    fitted: float


def beyond(fitted: FittedModel, own: Dataset, made: Sequence[Predicted]) -> list[Beyond]:
    """own: the data of the model. Of each prediction the effects that do more than in any test of the fit."""
    found = []
    for response in fitted.responses:
        tests = [t for t in own.tests if t.key in response.fitted_on and response.can_predict(t)]
        ranges = {term.id: _range(term, tests) for term in response.terms}
        for p in (p for p in made if p.response == response.name):
            least = OF_PREDICTED * _width(p.predicted[p.known])
            for term in response.terms:
                low, high = ranges[term.id]
                does = p.contributions[term.id][p.known]
                for reaches, seen in ((does.min(initial=0.0), low), (does.max(initial=0.0), high)):
                    if abs(reaches) - abs(seen) > max(least, OF_FITTED * (high - low)):
                        drivers = tuple(term.binding.values())
                        where = p.campaign, p.test, p.response, p.unit
                        found.append(Beyond(*where, term.id, drivers, float(reaches), float(seen)))
    return found


def _range(term: FittedTerm, tests: Sequence[TestData]) -> tuple[float, float]:
    """The least and the most that it does in some tests, 0 among them."""
    does = np.concatenate([np.zeros(1), *(term.contribution(t)[t.in_window] for t in tests if term.bound.covers(t))])
    return float(np.nanmin(does)), float(np.nanmax(does))


def _width(values: np.ndarray) -> float:
    return float(values.max() - values.min()) if len(values) else 0.0
