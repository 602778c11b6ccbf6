"""From a model file to terms that stand on channels: names checked, drivers found by place, tests by role."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from thermodata.effect.binding import family_of
from thermodata.errors import SpecError, UsageError, unknown_name
from thermodata.modelling.inputs.roles import Roles, find_tests, resolve_roles
from thermodata.modelling.model_file import nested, shaped
from thermodata.modelling.model_file.channels.bind import bind
from thermodata.modelling.model_file.channels.responses import (
    first_names,
    known_responses,
    response_by_campaign,
    where_it_is,
)
from thermodata.modelling.model_file.make_effect import make_effect, refuse_unknown_effects
from thermodata.modelling.model_file.prediction import as_effect as prediction
from thermodata.modelling.model_file.transfer import as_effect as transfer
from thermodata.modelling.model_file.values.own_units import in_own_units
from thermodata.modelling.model_file.values.possible_values import (
    refuse_impossible,
    refuse_no_name,
    refuse_unknown_groups,
)
from thermodata.modelling.model_file.values.said_conditions import refuse_unsaid_of
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.nuisance import known_weights
from thermodata.plugin import Effect
from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset


def resolve(
    spec: Model, data: Dataset, base: Path | None = None, fit_inside: nested.FitInside | None = None
) -> tuple[Roles, tuple[BoundResponse, ...]]:
    """Everything that the spec names, found. base: folder that `file` of an effect is relative to; fit_inside: fits a
    model that the spec holds as an effect to the same data."""
    refuse_unknown_effects(spec)
    roles = resolve_roles(spec, data)
    by_campaign = {c: _channels(data, c) for c in dict.fromkeys(t.campaign for t in data.tests)}
    known_weights(spec, data)
    known_responses(spec, by_campaign)
    responses = []
    for response in spec.responses:
        names = response_by_campaign(response, by_campaign)
        first = next(iter(names))
        responses.append(
            BoundResponse(
                names[first],
                by_campaign[first][names[first]].unit,
                names,
                bind_terms(spec.effects, data, by_campaign, names, base, fit_inside),
                {n: i.unit for infos in by_campaign.values() for n, i in infos.items()},
                spec.weights,
            )
        )
    asked = [t for t in data.tests if roles.role(t.key) != "none"]
    for bound in responses:
        refuse_unsaid_of(bound, asked)
    return roles, tuple(responses)


def bind_terms(
    effects: Sequence[EffectSpec],
    data: Dataset,
    by_campaign: Mapping[str, Mapping[str, ChannelInfo]],
    response: Mapping[str, str],
    base: Path | None = None,
    fit_inside: nested.FitInside | None = None,
) -> tuple[BoundTerm, ...]:
    """The effects that act on a response. response: campaign -> its channel."""
    named = enumerate(zip(term_ids(effects), effects, strict=True))
    there = _BoundTo(data, by_campaign, response, base, fit_inside)
    return tuple(there.term(name, given, f"effects[{i}]") for i, (name, given) in named if there.acts(given))


@dataclass(frozen=True, slots=True)
class _BoundTo:
    """What the effects of a model are bound to. channels: campaign -> name -> what it is. response: campaign -> its
    channel. base, fit_inside: as in `resolve`."""

    data: Dataset
    channels: Mapping[str, Mapping[str, ChannelInfo]]
    response: Mapping[str, str]
    base: Path | None
    fit_inside: nested.FitInside | None

    @property
    def channel(self) -> str:
        """The response in the first campaign that has it."""
        return next(iter(self.response.values()))

    @property
    def unit(self) -> str | None:
        """Of the response."""
        return _unit_of(self.channels[next(iter(self.response))].get(self.channel))

    def acts(self, given: EffectSpec) -> bool:
        """Whether it acts on this response."""
        return given.acts_on is None or self.channel in first_names(given.acts_on, self.channels)

    def term(self, name: str, given: EffectSpec, place: str) -> BoundTerm:
        """name: its id. place: where it stands in the file."""
        spec, where = as_it_was_made(given), f"effect '{name}'"
        effect = self._effect(name, spec, place)
        bound_by = where_it_is(
            self.channels, lambda c, channels: bind(effect, spec.drivers, channels, f"{where}, campaign {c}")
        )
        first = next(iter(bound_by))
        seen_at = None if spec.response is None else response_by_campaign(spec.response, self.channels)
        only = self._tests(spec.tests, f"{where}: tests")
        calibrate = self._tests(spec.calibrate_on, f"{where}: calibrate_on")
        _refuse_unknown_parameters(spec, effect, where)
        driver = _unit_of(self.channels[first].get(bound_by[first].get("u", "")))
        spec = in_own_units(spec, effect, where, driver, self.unit)
        refuse_impossible(given, spec, effect, place)
        refuse_unknown_groups(spec, self.data, place)
        family = family_of(effect, bound_by[first], self.channels[first])
        return BoundTerm(name, effect, spec, bound_by, family, only, calibrate, seen_at)

    def _effect(self, name: str, spec: EffectSpec, place: str) -> Effect:
        if spec.effect == nested.NAME:
            refuse_no_name(spec, place)
            inside = nested.model_output(spec, self.channel, tuple(self.channels), _fitter(self.fit_inside), name)
            effect = cast(Effect, inside)
        else:
            effect = make_effect(spec, name, self.base, self.response, self.unit)
        return cast(Effect, shaped.Shaped(effect, spec.also, f"effect '{name}': also")) if spec.also else effect

    def _tests(self, wanted: Sequence[str] | None, where: str) -> frozenset[tuple[str, str]] | None:
        return None if wanted is None else frozenset(find_tests(wanted, self.data, where))


def _refuse_unknown_parameters(spec: EffectSpec, effect: Effect, where: str) -> None:
    known = [p.name for p in effect.params] + [g.name for g in effect.gains]
    shared = [] if spec.shared == "none" else spec.shared
    for key in [*spec.fixed, *spec.start, *spec.bounds, *shared]:
        if key not in known and not (spec.effect == transfer.NAME and transfer.is_coefficient(key)):
            raise unknown_name("parameter", key, known, where=where)


def _unit_of(info: ChannelInfo | None) -> str | None:
    return None if info is None else info.unit


def term_ids(effects: Sequence[EffectSpec]) -> list[str]:
    """The given id, else the effect's name, numbered from the second on."""
    return ids_of((spec.effect, spec.id) for spec in effects)


def as_it_was_made(spec: EffectSpec) -> EffectSpec:
    """Another program's prediction is scored as that program made it, unless the model frees its gain; a model's
    output takes the gain that stands beside its name."""
    if spec.effect == nested.NAME:
        held = {nested.GAIN: float(spec.gain)} if isinstance(spec.gain, float) else {}
        return spec.model_copy(update={"fixed": {**held, **spec.fixed}})
    freed = "gain" in spec.bounds or "gain" in spec.start or spec.gain_by is not None
    if spec.effect != prediction.NAME or freed or "gain" in spec.fixed:
        return spec
    return spec.model_copy(update={"fixed": {**spec.fixed, "gain": 1.0}})


def _fitter(given: nested.FitInside | None) -> nested.FitInside:
    if given is None:
        raise SpecError("a model inside of a model is not fitted here")
    return given


def _channels(data: Dataset, campaign: str) -> dict[str, ChannelInfo]:
    shared: dict[str, ChannelInfo] = {}
    for test in data.tests:
        if test.campaign == campaign:
            infos: Mapping[str, Any] = test.channels or data.channels
            for name, info in infos.items():
                if name in test.values:
                    shared.setdefault(name, info)
    if not shared:
        raise UsageError(
            f"campaign '{campaign}' has no channels with data",
            hint="'thermodata ingest CAMPAIGN.yaml' brings them in; 'thermodata tests' lists what the store holds",
        )
    return shared
