"""Refuses expressions of derived channels that could be evaluated in no test, before anything is read for them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from thermodata.errors import UsageError, unknown_channel
from thermodata.schema.files.campaign import Campaign, Channel
from thermodata.store.tidy import derive
from thermodata.store.tidy.plan import effective


def check_derived(campaign: Campaign) -> None:
    """UsageError at the first `derive` that is no expression, names no channel of the campaign, or derives from
    itself. A channel that is only absent in a test is there: what derives from it is absent then too."""
    for prefix, channels in _told(campaign):
        for name, channel in channels.items():
            if channel.derive is not None:
                _check(campaign, channels, name, f"{prefix}channels.{name}.derive")


def _told(campaign: Campaign) -> Iterator[tuple[str, Mapping[str, Channel]]]:
    """(place of what they are declared in, channels): of the campaign, and of each test that derives otherwise."""
    yield "", campaign.channels
    for i, test in enumerate(campaign.tests):
        own = [name for name, override in test.channels.items() if "derive" in override.model_fields_set]
        if own:
            channels = effective(campaign, test)
            yield f"tests[{i}].", {n: channels[n] for n in (*own, *(c for c in channels if c not in own))}


def _check(campaign: Campaign, channels: Mapping[str, Channel], name: str, where: str) -> None:
    for used in names_in(channels[name].derive or "", where):
        if used not in campaign.channels:
            raise unknown_channel(used, list(campaign.channels), where=where)
    circle = _circle(channels, (name,), where, set())
    if circle:
        raise UsageError(
            "derived channels form a circle",
            where=where,
            expected="an expression over channels that are logged in the end",
            got=" -> ".join(circle),
            hint=f"derive '{circle[-2]}' from something else",
        )


def _circle(channels: Mapping[str, Channel], above: tuple[str, ...], where: str, seen: set[str]) -> tuple[str, ...]:
    """The way from a channel back to itself; empty where there is none. seen: channels that lead to none, which grows:
    several ways may lead to one."""
    text = channels[above[-1]].derive if above[-1] in channels else None
    for name in sorted(names_in(text, where)) if text is not None else ():
        if name in above:
            return (*above[above.index(name) :], name)
        if name not in seen and (found := _circle(channels, (*above, name), where, seen)):
            return found
        seen.add(name)
    return ()


def names_in(text: str, where: str) -> frozenset[str]:
    """The channels of an expression; UsageError with `where` before its own place."""
    try:
        return derive.names(text)
    except UsageError as error:
        raise error.at(f"{where}, {error.where}" if error.where else where) from error
