"""A fitted model on other logs: tests of any campaign, with or without the displacement that it was fitted to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from thermodata.errors import ThermodataError, UsageError
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.model_file.channels.bind import bind
from thermodata.modelling.model_file.channels.responses import find_response
from thermodata.modelling.model_file.nested import ModelOutput
from thermodata.modelling.predictions.bands import bands
from thermodata.modelling.predictions.carried_on import CarriedOn, carried_on
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.plugin import Bool1D, Effect, Float1D
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData


@dataclass(frozen=True)
class Predicted:
    """One response in one test; arrays of shape (n,), in the test's window.

    predicted: from 0 at the test's start, in the response's unit. t_s: where each mean begins. known: where every
    driver was measured, or nearly; held: drivers that count as known beyond the ends of their logs. deviation: standard
    deviation by the parameters; half: half of the band of 95 % (`ahead`); None where they are not known.
    contributions: effect -> its share. measured: on the prediction's zero, that of the first minutes; None where the
    test has no such displacement, or is locked: a look at that is counted, and belongs to `confirm`. locked: whether
    the test is, and has one.
    """

    campaign: str
    test: str
    response: str
    unit: str
    t_s: Float1D
    predicted: Float1D
    known: Bool1D
    contributions: Mapping[str, Float1D]
    measured: Float1D | None = None
    held: tuple[CarriedOn, ...] = ()
    deviation: Float1D | None = None
    half: Float1D | None = None
    machine: str = ""
    locked: bool = False

    @property
    def ends(self) -> tuple[Float1D | None, Float1D | None]:
        """Of the band of 95 %."""
        return (None, None) if self.half is None else (self.predicted - self.half, self.predicted + self.half)

    @property
    def rmse(self) -> float | None:
        """Of measured minus predicted, where both are known; None without a measurement."""
        if self.measured is None:
            return None
        gap = (self.measured - self.predicted)[self.known]
        gap = gap[np.isfinite(gap)]
        return float(np.sqrt(np.mean(gap**2))) if len(gap) else None


def predict(fitted: FittedModel, data: Dataset) -> tuple[list[Predicted], list[str]]:
    """(predictions, why tests are left out). Channels are found as the model file names them; UsageError where several
    fit."""
    made, why = list[Predicted](), list[str]()
    responses = [rebound(r, fitted, data) for r in fitted.responses]
    for test in data.tests:
        for response in responses:
            reason = _why_not(response, test)
            if reason is None:
                made.append(_predicted(response, test, locked="locked" in (test.role, fitted.roles.role(test.key))))
            else:
                why.append(f"{test.campaign}/{test.test}: {reason}")
    return made, list(dict.fromkeys(why))


def rebound(response: FittedResponse, fitted: FittedModel, data: Dataset) -> FittedResponse:
    """The response with its terms on the channels of other campaigns."""
    by_campaign = {c: _channels(data, c) for c in dict.fromkeys(t.campaign for t in data.tests)}
    place = [r.name for r in fitted.responses].index(response.name)
    names = dict(response.bound.channels)
    for campaign, channels in by_campaign.items():
        try:
            names[campaign] = find_response(fitted.spec.responses[place], channels, campaign)
        except UsageError:  # logs without displacement are what this is for
            names.setdefault(campaign, response.name)
    terms = tuple(_rebound(t, by_campaign) for t in response.terms)
    bound = replace(response.bound, channels=names, terms=tuple(t.bound for t in terms))
    return replace(response, bound=bound, terms=terms)


def _rebound(term: FittedTerm, by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> FittedTerm:
    old, effect = term.bound, term.effect
    bindings = dict(old.bindings)
    if isinstance(effect, ModelOutput):
        inner = tuple(_rebound(t, by_campaign) for t in effect.response.terms)
        made = ModelOutput(replace(effect.response, terms=inner), old.id, effect.gains[0].name)
        return replace(term, bound=replace(old, effect=cast(Effect, made), _drivers={}))
    for campaign, channels in by_campaign.items():
        if campaign not in bindings:
            given = old.spec.drivers or dict(old.binding)  # what was found by place in the fit goes by its name
            try:
                bindings[campaign] = bind(effect, given, channels, f"effect '{old.id}', campaign {campaign}")
            except UsageError:
                # what no test of it has, each test lacks: it is left out by the name that the fit knows
                needed = {n for text in old.binding.values() for n in names_of(text)}
                if needed <= channels.keys():
                    raise
                bindings[campaign] = dict(old.binding)
    return replace(term, bound=replace(old, bindings=bindings, _drivers={}))


def _why_not(response: FittedResponse, test: TestData) -> str | None:
    for term in response.terms:
        try:
            why = term.why_not(test)
        except ThermodataError as error:
            why = f"{term.id}: {error.what}; known: {', '.join(term.groups)}{_say_it(term)}"
        if why is not None:
            return why
    return None


def _say_it(term: FittedTerm) -> str:
    """How a test of logs without a campaign file comes to have the condition that a gain differs by."""
    by = term.bound.spec.gains_by
    if len(by) != 1 or by[0] in ("test", "campaign", "place"):
        return ""
    one = next(iter(term.groups))
    in_python = f"conditions={{'{by[0]}': '{one}'}} in Python"
    return f"; predict --set {by[0]}={one} says it of all tests ({in_python})"


def _predicted(response: FittedResponse, test: TestData, locked: bool) -> Predicted:
    parts = {t.id: t.contribution(test) for t in response.terms}
    predicted = np.sum(list(parts.values()), axis=0) if parts else np.zeros(len(test.t_s))
    known = np.ones(len(test.t_s), bool)
    for term in response.terms:
        mask = term.bound.known(test)
        known &= True if mask is None else mask
    window = test.in_window
    name = response.bound.channel_of(test)
    measured = None
    is_measured = name in test.values and bool(np.isfinite(test.values[name]).any())
    if is_measured and not locked:
        measured = (response.measured(test) - response.offset(test, "zero"))[window]
        valid = test.valid.get(name)
        if valid is not None:
            measured = np.where(valid[window], measured, np.nan)
    return Predicted(
        test.campaign,
        test.test,
        response.name,
        response.unit,
        test.t_s[window],
        predicted[window],
        known[window],
        {k: v[window] for k, v in parts.items()},
        measured,
        tuple(carried_on([t.bound for t in response.terms], test)),
        None if (spread := bands(response, test, from_start=True).predicted) is None else spread[window],
        machine=test.machine,
        locked=is_measured and locked,
    )


def _channels(data: Dataset, campaign: str) -> dict[str, ChannelInfo]:
    found: dict[str, ChannelInfo] = {}
    for test in data.tests:
        if test.campaign == campaign:
            found |= {n: i for n, i in test.channels.items() if n in test.values and n not in found}
    return found
