"""Which channels an effect can be driven by: by quantity and place, so that candidates and names come free."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

from thermodata.effect.places import match, part_alone
from thermodata.plugin import Effect, Need
from thermodata.schema.units.quantity import NOT_DRIVERS

ANY = "*"


class Described(Protocol):
    """What binding asks of a channel (view.dataset.ChannelInfo has it)."""

    @property
    def quantity(self) -> str: ...

    @property
    def at(self) -> str | None: ...


def bindings(effect: Effect, channels: Mapping[str, Described]) -> list[dict[str, str]]:
    """Every set of channels that fits the effect's needs: role -> channel, each set once, in a stable order.

    Rules. Needs that list equally many places (two or more) run in parallel: the n-th with the n-th, so that a
    column bends by rear - front or left - right, never by rear - right. Where all needs are optional, exactly one
    is taken (alternatives). Otherwise an optional need is taken where something fits it. A channel drives one role. A
    whole drives what asks for a part of it (`spindle.bearing?`) only where nothing reads that part itself.
    """
    return [found for found, _ in _all_bindings(effect, channels)]


def unnamed(effect: Effect, channels: Mapping[str, Described]) -> list[dict[str, str]]:
    """The same, of several spindles that one alone which has no name: `spindle`, and not `counter_spindle`."""
    found = list(_all_bindings(effect, channels))
    return [binding for binding, variables in found if "" in variables.values()] or [binding for binding, _ in found]


def family_of(effect: Effect, binding: Mapping[str, str], channels: Mapping[str, Described]) -> str:
    """The effect's family with the place's variables filled in: feed_{a} -> feed_z."""
    if "{" not in effect.family:
        return effect.family
    variables: dict[str, str] = {}
    for need in effect.needs:
        info = channels.get(binding.get(need.role, ""))
        for pattern in need.places:
            variables |= match(pattern, info.at if info else None) or {}
    family = re.sub(r"\{(\w+)\}", lambda m: variables.get(m[1], ""), effect.family)
    return family.rstrip("_")


def candidate_id(effect: str, binding: Mapping[str, str]) -> str:
    """'feed_screw:T_nut_Z'; channels in the order of the effect's roles, joined by commas."""
    return f"{effect}:{','.join(binding.values())}" if binding else effect


def _all_bindings(effect: Effect, channels: Mapping[str, Described]) -> Iterator[tuple[dict[str, str], dict[str, str]]]:
    if not effect.needs:
        yield {}, {}
        return
    seen: set[tuple[tuple[str, str], ...]] = set()
    for needs in _alternatives(effect.needs):
        for found, variables in _extend(needs, channels, {}, {}):
            key = tuple(sorted(found.items()))
            if found and key not in seen:
                seen.add(key)
                yield found, variables


def _alternatives(needs: Sequence[Need]) -> Iterator[tuple[Need, ...]]:
    if all(n.optional for n in needs):
        for need in needs:
            yield (Need(need.role, need.quantity, need.places),)
        return
    counts = {len(n.places) for n in needs if len(n.places) > 1}
    parallel = len(counts) == 1 and sum(len(n.places) > 1 for n in needs) > 1
    if not parallel:
        yield tuple(needs)
        return
    for i in range(counts.pop()):
        yield tuple(
            Need(n.role, n.quantity, n.places[i : i + 1] if len(n.places) > 1 else n.places, n.optional) for n in needs
        )


def _extend(
    needs: Sequence[Need], channels: Mapping[str, Described], found: dict[str, str], variables: dict[str, str]
) -> Iterator[tuple[dict[str, str], dict[str, str]]]:
    if not needs:
        yield found, variables
        return
    need, rest = needs[0], needs[1:]
    free = {name: info for name, info in channels.items() if name not in found.values()}
    fitting = _channels_fitting(need, free, variables)
    for name, v in fitting.items():
        yield from _extend(rest, channels, {**found, need.role: name}, v)
    if need.optional and not fitting:
        yield from _extend(rest, channels, found, variables)


def _channels_fitting(
    need: Need, channels: Mapping[str, Described], variables: Mapping[str, str]
) -> dict[str, dict[str, str]]:
    """Channel -> variables, of those that fit a need."""
    alone = Need(need.role, need.quantity, tuple(map(part_alone, need.places)))
    fits, parts = (
        {n: v for n, info in channels.items() if (v := _fits(asked, info, variables)) is not None}
        for asked in (need, alone)
    )
    return {n: v for n, v in fits.items() if n in parts or v not in parts.values()}


def _fits(need: Need, info: Described, variables: Mapping[str, str]) -> dict[str, str] | None:
    if need.quantity == ANY:
        if info.quantity in NOT_DRIVERS:
            return None
    elif info.quantity != need.quantity:
        return None
    if not need.places:
        return dict(variables)
    # a machine tool log without places: the one speed in it is the spindle's
    at = info.at or ("spindle" if info.quantity == "rotational_speed" else None)
    for pattern in need.places:
        hit = match(pattern, at, variables)
        if hit is not None:
            return hit
    return None
