"""Where a prediction goes beyond the tests that its model is fitted to: an effect is known as far as it was seen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
    found: list[Beyond] = []
    for response in fitted.responses:
        tests = [t for t in own.tests if t.key in response.fitted_on and response.can_predict(t)]
        ranges = {term.id: _range(term, tests) for term in response.terms}
        for prediction in made:
            if prediction.response == response.name:
                found += [one for term in response.terms for one in _of_term(term, prediction, *ranges[term.id])]
    return found


def _of_term(term: FittedTerm, prediction: Predicted, low: float, high: float) -> Iterator[Beyond]:
    """On either side of what it does in the tests of the fit. low, high: the least and the most of that [unit]."""
    least = max(OF_PREDICTED * _width(prediction.predicted[prediction.known]), OF_FITTED * (high - low))
    does = prediction.contributions[term.id][prediction.known]
    for reaches, seen in ((does.min(initial=0.0), low), (does.max(initial=0.0), high)):
        if abs(reaches) - abs(seen) > least:
            yield Beyond(
                campaign=prediction.campaign,
                test=prediction.test,
                response=prediction.response,
                unit=prediction.unit,
                effect=term.id,
                drivers=tuple(term.binding.values()),
                reaches=float(reaches),
                fitted=float(seen),
            )


def _range(term: FittedTerm, tests: Sequence[TestData]) -> tuple[float, float]:
    """The least and the most that it does in some tests, 0 among them."""
    does = np.concatenate([np.zeros(1), *(term.contribution(t)[t.in_window] for t in tests if term.bound.covers(t))])
    return float(np.nanmin(does)), float(np.nanmax(does))


def _width(values: np.ndarray) -> float:
    return float(values.max() - values.min()) if len(values) else 0.0
