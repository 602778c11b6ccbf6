"""What the other axes of the same place say: heat that moves the tool along one axis mostly moves it along another too,
and each axis has a probe, a noise and a model's error of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.claims.rules_together import surely
from thermodata.diagnosis.question.once import each_once
from thermodata.diagnosis.question.present import CONTROL, GENERIC
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.errors import ThermodataError
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Effect
from thermodata.schema.files.model import Model, Response
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

MOST_AXES = 2

# of a fitted response and the tests that it can predict, the sound causes that are missing there
Causes = Callable[[FittedResponse, Sequence[TestData]], Sequence[Scored]]


@dataclass
class OtherAxes:
    """Asked only where it matters: each axis is a diagnosis of its own. spec: the model, calibrated on what takes part
    in the choice. response: the channel that is asked about."""

    spec: Model
    response: str
    data: Dataset
    library: Mapping[str, Effect]
    _found: dict[str, Sequence[Scored]] = field(default_factory=dict, repr=False)

    def say(self, one: Scored, causes: Causes) -> tuple[tuple[str, float], ...]:
        """(channel, probability there) of each other axis on which the same cause is missing; of the first ones only
        where these are enough for a claim."""
        if not _goes_for_any_axis(self.spec, self.library):
            return ()
        told: tuple[tuple[str, float], ...] = ()
        for channel in beside(self.response, self.data.channels):
            if channel not in self._found:
                self._found[channel] = self._missing_on(channel, causes)
            same = [probability(s) for s in self._found[channel] if is_same(one.candidate, s.candidate)]
            if same:
                told = (*told, (channel, max(same)))
                if surely(replace(one, also_on=told)).holds:
                    break
        return told

    def _missing_on(self, channel: str, causes: Causes) -> Sequence[Scored]:
        spec = self.spec.model_copy(update={"response": Response(channel=channel)})
        asked = [t for t in self.data.tests if "/".join(t.key) in (spec.calibrate_on or ())]
        data, _, _ = each_once(self.data, asked, lambda test: channel)
        try:
            fitted = fit_model(spec, data, uncertainty=False)
        except ThermodataError:
            return ()  # it was not measured where the model's drivers were
        response = fitted.responses[0]
        return causes(response, [t for t in fitted.tests(data) if response.can_predict(t)])


def is_same(one: CandidateEffect, other: CandidateEffect) -> bool:
    """Whether two candidates are one heat: by the same channels, or of one family that has a name."""
    named = one.family == other.family and one.family not in (GENERIC, CONTROL)
    return named or set(one.channels) == set(other.channels)


def beside(response: str, channels: Mapping[str, ChannelInfo]) -> list[str]:
    """A displacement along each other axis at the same place, `MOST_AXES` at most; none of a response that is none."""
    own = channels[response]
    if own.quantity != "displacement" or own.axis is None or own.at is None:
        return []
    found: dict[str, str] = {}
    for name, info in channels.items():
        alike = (info.quantity, info.at, info.relative_to) == (own.quantity, own.at, own.relative_to)
        if alike and info.axis not in (None, own.axis) and info.faulty is None:
            found.setdefault(str(info.axis), name)
    return list(found.values())[:MOST_AXES]


def _goes_for_any_axis(spec: Model, library: Mapping[str, Effect]) -> bool:
    """Whether its effects can be fitted to another axis: none has its gains given, or is of one response."""

    def free(effect: str, fixed: Mapping[str, float]) -> bool:
        return not fixed or (effect in library and not {g.name for g in library[effect].gains} & set(fixed))

    return all(
        e.file is None and e.name is None and e.response is None and e.acts_on is None and free(e.effect, e.fixed)
        for e in spec.effects
    )
