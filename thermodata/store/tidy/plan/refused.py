"""Refuses expressions of derived channels and of `measuring` that could be evaluated in no test, before anything is
read for them: what a `measuring` should have masked would count."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from thermodata.calibration.expression.parser import parse
from thermodata.calibration.measuring import long_form
from thermodata.errors import UsageError, unknown_channel
from thermodata.schema.files.campaign import Campaign, Channel, Test
from thermodata.schema.units.quantity import canonical
from thermodata.store.tidy.plan import derive
from thermodata.store.tidy.plan.bind import effective

RATED = "position"  # the one quantity that has a rate


def check_derived(campaign: Campaign) -> None:
    """UsageError at the first `derive` that is no expression, names no channel of the campaign, or derives from
    itself. A channel that is only absent in a test is there: what derives from it is absent then too."""
    for prefix, channels in _places_of_channels(campaign):
        for name, channel in channels.items():
            if channel.derive is not None:
                _check_derive(campaign, channels, name, f"{prefix}channels.{name}.derive")


def check_measuring(campaign: Campaign) -> None:
    """UsageError at the first that is no expression, names no channel of the campaign, or compares what has no unit in
    common. A channel that is only absent in a test is there: that test then measures nowhere, and says so."""
    for i, test in enumerate(campaign.tests):
        if test.measuring is not None:
            _check_rule(campaign, effective(campaign, test), test, f"tests[{i}].measuring")


def _places_of_channels(campaign: Campaign) -> Iterator[tuple[str, Mapping[str, Channel]]]:
    """(place of what they are declared in, channels): of the campaign, and of each test that derives otherwise."""
    yield "", campaign.channels
    for i, test in enumerate(campaign.tests):
        own = [name for name, override in test.channels.items() if "derive" in override.model_fields_set]
        if own:
            channels = effective(campaign, test)
            yield f"tests[{i}].", {n: channels[n] for n in (*own, *(c for c in channels if c not in own))}


def _check_derive(campaign: Campaign, channels: Mapping[str, Channel], name: str, where: str) -> None:
    for used in _names_in(channels[name].derive or "", where):
        if used not in campaign.channels:
            raise unknown_channel(used, list(campaign.channels), where=where)
    for rated in sorted(derive.rated(channels[name].derive or "")):
        _check_rated(rated, channels.get(rated, campaign.channels[rated]), where)
    circle = _circle(channels, (name,), where, set())
    if circle:
        raise UsageError(
            "derived channels form a circle",
            where=where,
            expected="an expression over channels that are logged in the end",
            got=" -> ".join(circle),
            hint=f"derive '{circle[-2]}' from something else",
        )


def _check_rated(name: str, channel: Channel, where: str) -> None:
    """UsageError where the rate of a channel would be none of a movement."""
    if channel.signal is None:
        raise UsageError(
            f"rate({name}) is of no logged channel",
            where=where,
            expected="a channel with 'signal': a rate is of the samples of one log",
            got=f"'{name}' is {'derived' if channel.derive is not None else 'scheduled'}",
            hint="take the rate of what it derives from, as a channel of its own" if channel.derive else None,
        )
    if channel.quantity != RATED:
        raise UsageError(
            f"rate({name}) is of a {channel.quantity.replace('_', ' ')}",
            where=where,
            expected="a position: the rate of what a sensor reads is mostly that of its noise and its steps, and an "
            "angle starts anew",
            got=f"quantity: {channel.quantity}",
            hint="log the position of the axis, or take the channel itself as a driver",
        )


def _circle(channels: Mapping[str, Channel], above: tuple[str, ...], where: str, seen: set[str]) -> tuple[str, ...]:
    """The way from a channel back to itself; empty where there is none. seen: channels that lead to none, which grows:
    several ways may lead to one."""
    text = channels[above[-1]].derive if above[-1] in channels else None
    for name in sorted(_names_in(text, where)) if text is not None else ():
        if name in above:
            return (*above[above.index(name) :], name)
        if name not in seen and (found := _circle(channels, (*above, name), where, seen)):
            return found
        seen.add(name)
    return ()


def _names_in(text: str, where: str) -> frozenset[str]:
    """The channels of an expression; UsageError with `where` before its own place."""
    try:
        return derive.names(text)
    except UsageError as error:
        raise error.at(f"{where}, {error.where}" if error.where else where) from error


def _names_of_rule(text: str, where: str) -> frozenset[str]:
    """The same of a rule over samples, which has no rates."""
    try:
        return parse(text).names
    except UsageError as error:
        raise error.at(f"{where}, {error.where}" if error.where else where) from error


def _check_rule(campaign: Campaign, channels: Mapping[str, Channel], test: Test, where: str) -> None:
    spec = long_form(test.measuring)
    if spec.when is not None:
        place = where if isinstance(test.measuring, str) else f"{where}.when"
        for name in sorted(_names_of_rule(spec.when, place)):
            _require_channel(name, campaign, place)
        _compares(spec.when, channels, place)
    place = f"{where}.in_range"
    for name in [spec.in_range] if isinstance(spec.in_range, str) else spec.in_range or {}:
        if name != "in_range" or name in campaign.channels:
            _require_channel(name, campaign, place)


def _require_channel(name: str, campaign: Campaign, where: str) -> None:
    if name not in campaign.channels:
        raise unknown_channel(name, list(campaign.channels), where=where)


def _compares(text: str, channels: Mapping[str, Channel], where: str) -> None:
    tree = parse(text)
    named = {n: channels[n].quantity for n in tree.names if n in channels}
    if len(named) < len(tree.names) or "label" in named.values():
        return  # a word is a number only once it is read
    try:
        tree.evaluate_bool({n: np.zeros(1) for n in named}, {n: canonical(q) for n, q in named.items()})
    except UsageError as error:
        raise error.at(f"{where}, {error.where}" if error.where else where) from error
