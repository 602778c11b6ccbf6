"""A model fitted beside its slips: a probe that was knocked must not bend the effects that are asked of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.diagnosis.steps.step import Step
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.bound import BoundResponse
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData


def levelled(steps: Sequence[Step], response: BoundResponse, data: Dataset) -> Dataset:
    """With the steps taken out of the response, each by the size that it was found with: one of a free size would take
    what a missing effect does after it."""

    def without(test: TestData) -> TestData:
        own = [s for s in steps if s.test.key == test.key]
        if not own:
            return test
        name = response.channel_of(test)
        jumps = sum(s.size * (test.t_s >= s.at_s) for s in own)
        return replace(test, values={**test.values, name: test.values[name] - jumps})

    return replace(data, tests=tuple(map(without, data.tests)))


def fitted_beside(level: Dataset, fitted: FittedModel, spec: Model, index: int) -> FittedModel:
    """The same effects, of the response at `index`, as they are beside its steps.

    spec: calibrated on the tests that are asked of. level: these without the steps, which stay in what is asked.
    """
    found = fit_model(spec, level, uncertainty=False).responses[index]
    return replace(fitted, responses=(*fitted.responses[:index], found, *fitted.responses[index + 1 :]))
