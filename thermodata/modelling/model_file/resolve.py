"""From a model file to terms that stand on channels: names checked, drivers found by place, tests by role."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, TypeVar, cast

from thermodata.effect.binding import ANY, family_of, unnamed
from thermodata.effect.places import holds, shown
from thermodata.errors import SpecError, ThermodataError, UsageError, unknown_channel, unknown_name
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.inputs.roles import Roles, find_tests, resolve_roles
from thermodata.modelling.model_file import nested, prediction, shaped, transfer
from thermodata.modelling.model_file.driver_quantity import refuse_another_quantity
from thermodata.modelling.model_file.make_effect import make_effect, refuse_unknown_effects
from thermodata.modelling.model_file.own_units import in_own_units
from thermodata.modelling.model_file.possible_values import refuse_impossible, refuse_no_name, refuse_unknown_groups
from thermodata.modelling.model_file.said_conditions import refuse_unsaid_of
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.nuisance import known_weights
from thermodata.plugin import Effect
from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.schema.files.model import Driver, EffectSpec, Model, Place, Response
from thermodata.schema.words.sentences import counted
from thermodata.view.grid.dataset import ChannelInfo, Dataset

Found = TypeVar("Found")


class MissingChannelError(SpecError):
    """A campaign has no channel for something: another campaign may have it."""


def resolve(
    spec: Model, data: Dataset, base: Path | None = None, fit_inside: nested.FitInside | None = None
) -> tuple[Roles, tuple[BoundResponse, ...]]:
    """Everything that the spec names, found. base: folder that `file` of an effect is relative to; fit_inside: fits a
    model that the spec holds as an effect to the same data."""
    refuse_unknown_effects(spec)
    roles = resolve_roles(spec, data)
    by_campaign = {c: _channels(data, c) for c in dict.fromkeys(t.campaign for t in data.tests)}
    known_weights(spec, data)
    _known_responses(spec, by_campaign)
    responses = []
    for response in spec.responses:
        names = _response_by_campaign(response, by_campaign)
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


def _known_responses(spec: Model, by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> None:
    """SpecError where an effect acts on what is no response of the model, or on nothing."""
    modelled = _first_names(spec.responses, by_campaign)
    for name, effect in zip(term_ids(spec.effects), spec.effects, strict=True):
        acted_on = modelled if effect.acts_on is None else _first_names(effect.acts_on, by_campaign)
        if not acted_on or set(acted_on) - set(modelled):
            raise SpecError(
                "an effect acts on responses of its model",
                where=f"effect '{name}': acts_on",
                expected=f"some of {', '.join(modelled)}",
                got=", ".join(acted_on) or "none",
            )


def _first_names(responses: Sequence[Response], by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> list[str]:
    """The channel that each response is in the first campaign that has it."""
    return [next(iter(_response_by_campaign(r, by_campaign).values())) for r in responses]


def _response_by_campaign(response: Response, by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> dict[str, str]:
    """campaign -> channel. A campaign without the response can't be predicted, and is no error while another has it."""
    return _where_it_is(by_campaign, lambda campaign, channels: find_response(response, channels, campaign))


def _where_it_is(
    by_campaign: Mapping[str, Mapping[str, ChannelInfo]], find: Callable[[str, Mapping[str, ChannelInfo]], Found]
) -> dict[str, Found]:
    found: dict[str, Found] = {}
    missing: list[ThermodataError] = []
    for campaign, channels in by_campaign.items():
        try:
            found[campaign] = find(campaign, channels)
        except MissingChannelError as error:
            missing.append(error)
    if not found:
        raise missing[0]
    return found


def find_response(response: Response, channels: Mapping[str, ChannelInfo], campaign: str) -> str:
    """The channel that a response means. Ambiguity is an error that lists the choices."""
    if response.channel is not None:
        if response.channel not in channels:
            raise _no_channel(response.channel, channels, f"response, campaign {campaign}")
        return response.channel
    moving = {n: i for n, i in channels.items() if i.quantity in ("displacement", "tilt")}
    hits = [
        n
        for n, i in moving.items()
        if i.axis == response.axis and (response.at is None or i.at == response.at or holds(response.at, i.at))
    ]
    exact = [n for n in hits if response.at is not None and moving[n].at == response.at]
    hits = exact or hits
    wanted = f"{{axis: {response.axis}{f', at: {response.at}' if response.at else ''}}}"
    if not hits:
        raise MissingChannelError(
            f"no displacement is {wanted}",
            where=f"response, campaign {campaign}",
            expected=", ".join(f"{n} (axis {i.axis}, at {i.at})" for n, i in moving.items())
            or "a displacement channel",
            got=None if moving else f"no displacement among {counted(len(channels), 'channel')} with data",
            hint=None if moving else "ingest again: its losses tell which source had no file or no calibration",
        )
    if len(hits) > 1:
        raise SpecError(
            f"several displacements are {wanted}",
            where=f"response, campaign {campaign}",
            expected="one of them",
            got=", ".join(f"{n} (at {moving[n].at})" for n in hits),
            hint=f"name one: response: {{channel: {hits[0]}}}",
        )
    return hits[0]


def bind_terms(
    effects: Sequence[EffectSpec],
    data: Dataset,
    by_campaign: Mapping[str, Mapping[str, ChannelInfo]],
    response: Mapping[str, str],
    base: Path | None = None,
    fit_inside: nested.FitInside | None = None,
) -> tuple[BoundTerm, ...]:
    """The effects that act on a response. response: campaign -> its channel."""
    ids = term_ids(effects)
    campaign, channel = next(iter(response.items()))
    unit = _unit_of(by_campaign[campaign].get(channel))
    terms = []
    for i, (name, given) in enumerate(zip(ids, effects, strict=True)):
        if given.acts_on is not None and channel not in _first_names(given.acts_on, by_campaign):
            continue
        place = f"effects[{i}]"
        spec = as_it_was_made(given)
        if spec.effect == nested.NAME:
            refuse_no_name(spec, place)
            effect: Effect = cast(
                Effect, nested.model_output(spec, channel, tuple(by_campaign), _fitter(fit_inside), name)
            )
        else:
            effect = make_effect(spec, name, base, response, unit)
        if spec.also:
            effect = cast(Effect, shaped.Shaped(effect, spec.also, f"effect '{name}': also"))
        bound_by = _where_it_is(
            by_campaign,
            lambda c, channels, e=effect, s=spec, n=name: bind(  # type: ignore[misc]
                e, s.drivers, channels, f"effect '{n}', campaign {c}"
            ),
        )
        first = next(iter(bound_by))
        seen_at = None if spec.response is None else _response_by_campaign(spec.response, by_campaign)
        only = None if spec.tests is None else frozenset(find_tests(spec.tests, data, f"effect '{name}': tests"))
        calibrate = (
            None
            if spec.calibrate_on is None
            else frozenset(find_tests(spec.calibrate_on, data, f"effect '{name}': calibrate_on"))
        )
        known = [p.name for p in effect.params] + [g.name for g in effect.gains]
        shared = [] if spec.shared == "none" else spec.shared
        for key in [*spec.fixed, *spec.start, *spec.bounds, *shared]:
            if key not in known and not (spec.effect == transfer.NAME and transfer.is_coefficient(key)):
                raise unknown_name("parameter", key, known, where=f"effect '{name}'")
        driver = _unit_of(by_campaign[first].get(bound_by[first].get("u", "")))
        spec = in_own_units(spec, effect, f"effect '{name}'", driver, unit)
        refuse_impossible(given, spec, effect, place)
        refuse_unknown_groups(spec, data, place)
        family = family_of(effect, bound_by[first], by_campaign[first])
        terms.append(BoundTerm(name, effect, spec, bound_by, family, only, calibrate, seen_at))
    return tuple(terms)


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


def bind(
    effect: Effect, given: Mapping[str, Driver], channels: Mapping[str, ChannelInfo], where: str
) -> dict[str, str]:
    """role -> channel or expression. What is not given is found by place; several fits are an error."""
    needs = {n.role: n for n in effect.needs}
    binding: dict[str, str] = {}
    for role, driver in given.items():
        if role not in needs:
            raise unknown_name("driver role", role, list(needs), where=where)
        binding[role] = _driver(driver, needs[role].quantity, channels, where)
        refuse_another_quantity(effect, needs[role], binding[role], channels, where)
    rest = tuple(n for n in effect.needs if n.role not in binding)
    if not rest or (binding and all(n.optional for n in effect.needs)):
        return binding
    if binding and all(n.optional for n in rest):
        return binding
    choices = unnamed(cast(Effect, SimpleNamespace(needs=rest)), channels)
    if not choices:
        raise MissingChannelError(
            f"no channel fits what '{effect.name}' needs",
            where=where,
            expected="; ".join(
                f"{n.role}: {n.quantity} at {' or '.join(map(shown, n.places)) or 'any place'}" for n in rest
            ),
            got=", ".join(f"{n} ({i.quantity} at {i.at})" for n, i in channels.items()),
            hint=f"name it: drivers: {{{rest[0].role}: CHANNEL}}",
        )
    if len(choices) > 1:
        raise SpecError(
            f"several channels fit what '{effect.name}' needs",
            where=where,
            got="; ".join(", ".join(f"{r}: {c}" for r, c in choice.items()) for choice in choices[:20]),
            hint=f"name one: drivers: {{{', '.join(f'{r}: {c}' for r, c in choices[0].items())}}}",
        )
    return {**binding, **choices[0]}


def _driver(driver: Driver, quantity: str, channels: Mapping[str, ChannelInfo], where: str) -> str:
    if isinstance(driver, Place):
        hits = [
            n
            for n, i in channels.items()
            if holds(driver.at, i.at)
            and (i.quantity == quantity if quantity != ANY else i.quantity not in ("displacement", "label"))
        ]
        if len(hits) != 1:
            kind = SpecError if hits else MissingChannelError
            places = sorted({i.at for i in channels.values() if i.at})
            raise kind(
                f"{len(hits) or 'no'} channels lie at '{driver.at}'",
                where=where,
                expected="one",
                got=", ".join(hits) or f"places: {', '.join(places)}",
                hint="name the channel" if hits else None,
            )
        return hits[0]
    for name in names_of(driver):
        if name not in channels:
            raise _no_channel(name, channels, where)
    return driver


def _no_channel(name: str, channels: Mapping[str, ChannelInfo], where: str) -> MissingChannelError:
    said = unknown_channel(name, list(channels), where=where)
    return MissingChannelError(said.what, where=said.where, expected=said.expected, got=name, hint=said.hint)


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
        raise UsageError(f"campaign '{campaign}' has no channels with data")
    return shared
