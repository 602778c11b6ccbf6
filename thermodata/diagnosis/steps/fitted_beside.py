"""A model fitted beside its slips: a probe that was knocked must not bend the effects that are asked of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.diagnosis.steps.step import Step
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset


def fitted_beside(steps: Sequence[Step], fitted: FittedModel, spec: Model, index: int, data: Dataset) -> FittedModel:
    """The same effects, of the response at `index`, as they are beside the steps; these stay in its residual.

    spec: calibrated on the tests that are asked of. Each step is held at its time and size: one of a free size takes
    what a missing effect does after it.
    """
    slips = [
        EffectSpec(
            effect="step",
            tests=["/".join(step.test.key)],
            acts_on=[spec.responses[index]],
            fixed={"at": step.at_s / 60.0, "gain": step.size},
        )
        for step in steps
    ]
    found = fit_model(spec.model_copy(update={"effects": [*spec.effects, *slips]}), data, uncertainty=False)
    own = set(term_ids(spec.effects))
    asked = found.responses[index]
    beside = replace(fitted.responses[index], terms=tuple(t for t in asked.terms if t.id in own))
    return replace(fitted, responses=(*fitted.responses[:index], beside, *fitted.responses[index + 1 :]))
