"""Another model's output as an effect: the frame as found at the stator, times a gain at the tool ([mares2017])."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from thermodata.errors import SpecError, unknown_name
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.plugin import Float2D, Gain
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import TestData

NAME = "model"
GAIN = "gain"
FitInside = Callable[[Model], FittedModel]


class ModelOutput(OfTests):
    """Free run of a fitted response, without its offset."""

    name = NAME
    family = "model"
    source = "docs/model.md#the-model"

    def __init__(self, response: FittedResponse, label: str, gain: str = GAIN) -> None:
        self.response = response
        self.meaning = f"what the model '{label}' predicts"
        self.gains = (Gain(gain, "1", (0.0, float("inf")), "any", "factor on the model's output"),)

    def has(self, test: TestData) -> bool:
        return all(term.can_predict(test) for term in self.response.terms)

    def lacks(self, test: TestData) -> str:
        return "; ".join(why for term in self.response.terms if (why := term.why_not(test)))

    def reads(self, test: TestData) -> tuple[str, ...]:
        """The channels that its own effects read."""
        return tuple(dict.fromkeys(n for term in self.response.terms for n in term.bound.reads(test)))

    def column(self, test: TestData) -> Float2D:
        out = self.response.predict(test)
        for term in self.response.terms:
            known = term.bound.known(test)
            if known is not None:
                out = np.where(known, out, np.nan)
        return out.reshape(-1, 1)


def model_output(spec: EffectSpec, channel: str, campaigns: tuple[str, ...], fit: FitInside, where: str) -> ModelOutput:
    """The effect that `{effect: model, name: ...}` means. channel: the response that it is used for; campaigns: whose
    data are at hand. SpecError where the model was not looked up, or has no response to take."""
    if spec.inside is None:
        raise SpecError(
            "an effect 'model' needs the name of a model",
            where=where,
            expected="name: frame",
            hint="'thermodata models' lists them",
        )
    inside = Model.model_validate(spec.inside)
    if missing := [c for c in inside.campaign_ids if c not in campaigns]:
        raise SpecError(
            f"the model '{inside.name}' was fitted to other campaigns",
            where=where,
            expected=f"campaigns: [{', '.join(dict.fromkeys((*campaigns, *inside.campaign_ids)))}]",
            got=f"without {', '.join(missing)}",
            hint="list its campaigns in this model, too",
        )
    try:
        responses = fit(inside).responses
    except SpecError as error:  # its places are those of another file
        raise error.at(f"model '{inside.name}', {error.where}") from None
    same = [r for r in responses if r.name == channel] or list(responses)
    if len(same) > 1:
        raise SpecError(
            f"the model '{inside.name}' has several responses",
            where=where,
            expected="one, or one that is the response here",
            got=", ".join(r.name for r in responses),
            hint="fit a model of that one response by itself, and name it here",
        )
    word = spec.gain if isinstance(spec.gain, str) else GAIN
    taken = same[0] if spec.parts is None else _parts(same[0], spec.parts, f"effect '{where}': parts")
    return ModelOutput(taken, spec.name or inside.name, word)


def _parts(response: FittedResponse, parts: Sequence[str], where: str) -> FittedResponse:
    """The sum of some effects only: a spindle's function, without the hall that stood beside it."""
    known = [term.id for term in response.terms]
    for name in parts:
        if name not in known:
            raise unknown_name("effect", name, known, where=where)
    terms = tuple(term for term in response.terms if term.id in parts)
    return replace(response, bound=replace(response.bound, terms=tuple(t.bound for t in terms)), terms=terms)
