"""Which channels drive an effect: those that the model file names, else those that lie where the effect needs them."""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import cast

from thermodata.effect.binding import ANY, unnamed
from thermodata.effect.places import holds, readable_place
from thermodata.errors import SpecError, unknown_name
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.model_file.channels.driver_quantity import refuse_another_quantity
from thermodata.modelling.model_file.channels.responses import MissingChannelError, no_channel
from thermodata.plugin import Effect
from thermodata.schema.files.model import Driver, Place
from thermodata.view.grid.dataset import ChannelInfo


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
                f"{n.role}: {n.quantity} at {' or '.join(map(readable_place, n.places)) or 'any place'}" for n in rest
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
            raise no_channel(name, channels, where)
    return driver
