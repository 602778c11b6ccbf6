"""From a model file to terms that stand on channels: names checked, drivers found by place, tests by role."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from thermodata.effect import effect as find_effect
from thermodata.effect.binding import ANY, bindings, family_of
from thermodata.effect.places import holds
from thermodata.errors import SpecError, UsageError, unknown_name
from thermodata.modelling import prediction, transfer
from thermodata.modelling.drivers import has_drivers, make_drivers, names_of
from thermodata.plugin import Bool1D, Drivers, Effect, Float2D
from thermodata.schema.model import Driver, EffectSpec, Model, Place, Response
from thermodata.view.dataset import ChannelInfo, Dataset, TestData

Key = tuple[str, str]
KEPT_TESTS = 1024               # drivers a term keeps; changed copies of tests count too


@dataclass(frozen=True)
class BoundTerm:
    """An effect on its channels. bindings: campaign -> role -> channel or expression (names may differ)."""

    id: str
    effect: Effect
    spec: EffectSpec
    bindings: Mapping[str, Mapping[str, str]]
    family: str
    only: frozenset[Key] | None = None                      # the tests it exists in; None: all
    calibrate: frozenset[Key] | None = None                 # identified on these first, then held
    _drivers: dict[int, tuple[TestData, Drivers]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def binding(self) -> Mapping[str, str]:
        return next(iter(self.bindings.values()), {})

    def covers(self, test: TestData) -> bool:
        return self.only is None or test.key in self.only

    def has(self, test: TestData) -> bool:
        """Whether the test has what the term reads (a term that does not cover a test needs nothing there)."""
        if not self.covers(test):
            return True
        if isinstance(self.effect, prediction.Prediction):
            return self.effect.has(test)
        return has_drivers(test, self._binding_of(test))

    def drivers(self, test: TestData) -> Drivers:
        """Made once a test; a changed copy of a test is another test."""
        kept = self._drivers.get(id(test))
        if kept is None or kept[0] is not test:
            if len(self._drivers) >= KEPT_TESTS:
                self._drivers.clear()
            kept = self._drivers[id(test)] = (test, make_drivers(test, self.effect, self._binding_of(test)))
        return kept[1]

    def columns(self, test: TestData, params: Mapping[str, float]) -> Float2D:
        """shape (n, gains); zeros where the term does not cover the test."""
        if not self.covers(test):
            return np.zeros((len(test.t_s), len(self.effect.gains)))
        if isinstance(self.effect, prediction.Prediction):
            return self.effect.column(test)
        return self.effect.basis(self.drivers(test), params)

    def known(self, test: TestData) -> Bool1D | None:
        """Where all drivers were measured, or nearly; None: everywhere."""
        if not self.covers(test):
            return None
        if isinstance(self.effect, prediction.Prediction):
            return np.isfinite(self.effect.column(test)[:, 0])
        if not self.effect.needs:
            return None
        masks = list(self.drivers(test).valid.values())
        out = masks[0].copy()
        for mask in masks[1:]:
            out &= mask
        return out

    def group(self, test: TestData) -> str:
        """The value that its gain belongs to ('' where one gain serves all)."""
        by = self.spec.gain_by
        if by is None:
            return ""
        name = by.removeprefix("conditions.")
        if by in ("test", "machine", "campaign"):
            return str(getattr(test, by))
        if name not in test.conditions:
            raise unknown_name("condition", name, [*test.conditions, "test", "machine", "campaign"],
                               where=f"gain_by of effect '{self.id}', test {test.campaign}/{test.test}")
        value = test.conditions[name]
        return f"{value:g}" if isinstance(value, float | int) else str(value)

    def _binding_of(self, test: TestData) -> Mapping[str, str]:
        found = self.bindings.get(test.campaign)
        return self.binding if found is None else found


@dataclass(frozen=True)
class BoundResponse:
    """name: its channel (in the first campaign); channels: campaign -> channel."""

    name: str
    unit: str
    channels: Mapping[str, str]
    terms: tuple[BoundTerm, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of every channel, by name

    def channel_of(self, test: TestData) -> str:
        return self.channels.get(test.campaign, self.name)


@dataclass(frozen=True)
class Roles:
    """Keys (campaign, test) by what they are used for; a test has one role."""

    calibrate: tuple[Key, ...]
    verify: tuple[Key, ...]
    locked: tuple[Key, ...]

    def role(self, key: Key) -> str:
        for name, keys in (("calibration", self.calibrate), ("verification", self.verify), ("locked", self.locked)):
            if key in keys:
                return name
        return "none"


def resolve(spec: Model, data: Dataset, base: Path | None = None) -> tuple[Roles, tuple[BoundResponse, ...]]:
    """Everything that the spec names, found. base: folder that `file` of an effect is relative to."""
    roles = resolve_roles(spec, data)
    by_campaign = {c: _channels(data, c) for c in dict.fromkeys(t.campaign for t in data.tests)}
    responses = []
    for response in spec.responses:
        names = {c: find_response(response, channels, c) for c, channels in by_campaign.items()}
        first = next(iter(names))
        responses.append(BoundResponse(names[first], by_campaign[first][names[first]].unit, names,
                                       bind_terms(spec.effects, data, by_campaign, base),
                                       {n: i.unit for infos in by_campaign.values() for n, i in infos.items()}))
    return roles, tuple(responses)


def resolve_roles(spec: Model, data: Dataset) -> Roles:
    """Named tests, else by the tests' own roles. SpecError where nothing is left to calibrate on or roles overlap."""
    explicit = {name: None if names is None else find_tests(names, data, name)
                for name, names in (("calibrate_on", spec.calibrate_on), ("verify_on", spec.verify_on),
                                    ("locked", spec.locked))}
    taken: dict[Key, str] = {}
    for name, keys in explicit.items():
        for key in keys or ():
            if taken.setdefault(key, name) != name:
                raise SpecError(f"test '{'/'.join(key)}' has two roles", where=f"model '{spec.name}'",
                                got=f"{taken[key]} and {name}", hint="a locked or verification test is not fitted to")

    def default(role: str) -> tuple[Key, ...]:
        return tuple(t.key for t in data.tests if t.role == role and t.key not in taken)

    found = [default(role) if explicit[name] is None else explicit[name] or ()
             for name, role in (("calibrate_on", "calibration"), ("verify_on", "verification"), ("locked", "locked"))]
    if not found[0]:
        raise SpecError("no test to calibrate on", where=f"model '{spec.name}'",
                        expected="calibrate_on: [...], or tests with role: calibration",
                        got=", ".join(f"{t.test} ({t.role})" for t in data.tests) or "no tests at all")
    return Roles(*found)


def find_tests(names: Sequence[str], data: Dataset, where: str) -> tuple[Key, ...]:
    """Each as 'test', or 'campaign/test' where several campaigns have it."""
    found: list[Key] = []
    for name in names:
        hits = [t.key for t in data.tests if name in (t.test, f"{t.campaign}/{t.test}")]
        if not hits:
            raise unknown_name("test", name, [t.test for t in data.tests], where=where)
        if len(hits) > 1:
            raise SpecError(f"test '{name}' is in several campaigns", where=where,
                            expected=" or ".join("/".join(h) for h in hits))
        found.append(hits[0])
    return tuple(dict.fromkeys(found))


def find_response(response: Response, channels: Mapping[str, ChannelInfo], campaign: str) -> str:
    """The channel that a response means. Ambiguity is an error that lists the choices."""
    if response.channel is not None:
        if response.channel not in channels:
            raise unknown_name("channel", response.channel, list(channels), where=f"response, campaign {campaign}")
        return response.channel
    moving = {n: i for n, i in channels.items() if i.quantity in ("displacement", "tilt")}
    hits = [n for n, i in moving.items() if i.axis == response.axis
            and (response.at is None or i.at == response.at or holds(response.at, i.at))]
    exact = [n for n in hits if response.at is not None and moving[n].at == response.at]
    hits = exact or hits
    wanted = f"{{axis: {response.axis}{f', at: {response.at}' if response.at else ''}}}"
    if not hits:
        raise SpecError(f"no displacement is {wanted}", where=f"response, campaign {campaign}", expected=", ".join(
            f"{n} (axis {i.axis}, at {i.at})" for n, i in moving.items()) or "a displacement channel")
    if len(hits) > 1:
        raise SpecError(f"several displacements are {wanted}", where=f"response, campaign {campaign}",
                        got=", ".join(f"{n} (at {moving[n].at})" for n in hits),
                        hint=f"name one: response: {{channel: {hits[0]}}}")
    return hits[0]


def bind_terms(effects: Sequence[EffectSpec], data: Dataset, by_campaign: Mapping[str, Mapping[str, ChannelInfo]],
               base: Path | None = None) -> tuple[BoundTerm, ...]:
    ids = term_ids(effects)
    terms = []
    for name, spec in zip(ids, effects, strict=True):
        made = make_effect(spec, name, base)
        found = {c: bind(made, spec.drivers, channels, f"effect '{name}', campaign {c}")
                 for c, channels in by_campaign.items()}
        first = next(iter(by_campaign))
        only = None if spec.tests is None else frozenset(find_tests(spec.tests, data, f"effect '{name}': tests"))
        calibrate = (None if spec.calibrate_on is None
                     else frozenset(find_tests(spec.calibrate_on, data, f"effect '{name}': calibrate_on")))
        known = [p.name for p in made.params] + [g.name for g in made.gains]
        for key in [*spec.fixed, *spec.start, *spec.bounds, *spec.shared]:
            if key not in known and not (spec.effect == transfer.NAME and transfer.is_coefficient(key)):
                raise unknown_name("parameter", key, known, where=f"effect '{name}'")
        family = family_of(made, found[first], by_campaign[first])
        terms.append(BoundTerm(name, made, spec, found, family, only, calibrate))
    return tuple(terms)


def term_ids(effects: Sequence[EffectSpec]) -> list[str]:
    """The given id, else the effect's name, numbered from the second on."""
    ids: list[str] = []
    taken = {s.id for s in effects if s.id}
    for spec in effects:
        name, k = spec.id or spec.effect, 1
        if spec.id and name in ids:
            raise SpecError(f"two effects have the id '{name}'", hint="give each its own id")
        while not spec.id and (name in ids or name in taken):
            k += 1
            name = f"{spec.effect}_{k}"
        ids.append(name)
    return ids


def make_effect(spec: EffectSpec, where: str, base: Path | None) -> Effect:
    """The plugin's effect, or one of the two that the model file itself spells out."""
    if spec.effect == transfer.NAME:
        function = transfer.given(spec.fixed, where)
        if function is not None:
            return cast(Effect, function)
        return cast(Effect, transfer.FreeFunction(spec.method or "varpro", spec.orders or (2, 2)))
    if spec.effect == prediction.NAME:
        if spec.file is None:
            raise SpecError("an effect 'prediction' needs 'file'", where=where, expected="file: theirs.csv")
        return cast(Effect, prediction.read_prediction((base or Path()) / spec.file))
    for key in ("method", "orders", "file"):
        if getattr(spec, key) is not None:
            raise SpecError(f"'{key}' belongs to {transfer.NAME} or {prediction.NAME}", where=f"effect '{where}'")
    return find_effect(spec.effect)


def bind(effect: Effect, given: Mapping[str, Driver], channels: Mapping[str, ChannelInfo],
         where: str) -> dict[str, str]:
    """role -> channel or expression. What is not given is found by place; several fits are an error."""
    needs = {n.role: n for n in effect.needs}
    found: dict[str, str] = {}
    for role, driver in given.items():
        if role not in needs:
            raise unknown_name("driver role", role, list(needs), where=where)
        found[role] = _driver(driver, needs[role].quantity, channels, where)
    rest = tuple(n for n in effect.needs if n.role not in found)
    if not rest or (found and all(n.optional for n in effect.needs)):
        return found
    if found and all(n.optional for n in rest):
        return found
    choices = bindings(cast(Effect, SimpleNamespace(needs=rest)), channels)
    if not choices:
        raise SpecError(f"no channel fits what '{effect.name}' needs", where=where, expected="; ".join(
            f"{n.role}: {n.quantity} at {' or '.join(n.places) or 'any place'}" for n in rest),
            got=", ".join(f"{n} ({i.quantity} at {i.at})" for n, i in channels.items()),
            hint=f"name it: drivers: {{{rest[0].role}: CHANNEL}}")
    if len(choices) > 1:
        raise SpecError(f"several channels fit what '{effect.name}' needs", where=where,
                        got="; ".join(", ".join(f"{r}: {c}" for r, c in choice.items()) for choice in choices[:20]),
                        hint=f"name one: drivers: {{{', '.join(f'{r}: {c}' for r, c in choices[0].items())}}}")
    return {**found, **choices[0]}


def _driver(driver: Driver, quantity: str, channels: Mapping[str, ChannelInfo], where: str) -> str:
    if isinstance(driver, Place):
        hits = [n for n, i in channels.items() if holds(driver.at, i.at)
                and (i.quantity == quantity if quantity != ANY else i.quantity not in ("displacement", "label"))]
        if len(hits) != 1:
            places = sorted({i.at for i in channels.values() if i.at})
            raise SpecError(f"{len(hits) or 'no'} channels lie at '{driver.at}'", where=where, expected="one",
                            got=", ".join(hits) or f"places: {', '.join(places)}",
                            hint="name the channel" if hits else None)
        return hits[0]
    for name in names_of(driver):
        if name not in channels:
            raise unknown_name("channel", name, list(channels), where=where)
    return driver


def _channels(data: Dataset, campaign: str) -> dict[str, ChannelInfo]:
    found: dict[str, ChannelInfo] = {}
    for test in data.tests:
        if test.campaign == campaign:
            infos: Mapping[str, Any] = test.channels or data.channels
            for name, info in infos.items():
                if name in test.values:
                    found.setdefault(name, info)
    if not found:
        raise UsageError(f"campaign '{campaign}' has no channels with data")
    return found
