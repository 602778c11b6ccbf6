"""The effects of the library that a set of channels cannot drive, and what each of them lacks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.effect.binding import ANY, Described, bindings
from thermodata.effect.places import readable_place
from thermodata.plugin import Effect, Need

_LISTED = 3


@dataclass(frozen=True, slots=True)
class Unbound:
    """effect: name. meaning: in words. why: what would have to be logged."""

    effect: str
    meaning: str
    why: str


def unbound(library: Mapping[str, Effect], channels: Mapping[str, Described]) -> list[Unbound]:
    """In the library's order. channels: that could be drivers, by name."""
    return [
        Unbound(effect.name, effect.meaning, _why_unbound(effect, channels))
        for effect in library.values()
        if effect.needs and not bindings(effect, channels)
    ]


def _why_unbound(effect: Effect, channels: Mapping[str, Described]) -> str:
    lacking = [
        n
        for n in effect.needs
        if not n.optional and not bindings(_Only(effect, n), channels)  # type: ignore[arg-type]
    ]
    said = [_need(n) for n in (lacking or effect.needs)]
    return f"no {' and no '.join(said)}" if lacking else f"no {' or '.join(said)} that goes together"


def _need(need: Need) -> str:
    quantity = "channel" if need.quantity == ANY else need.quantity.replace("_", " ")
    places = [*map(readable_place, need.places[:_LISTED]), *(["..."] if len(need.places) > _LISTED else [])]
    return f"{quantity} at {' or '.join(places)}" if places else quantity


class _Only:
    """An effect with one of its needs."""

    def __init__(self, effect: Effect, need: Need) -> None:
        self.name, self.family, self.needs = effect.name, effect.family, (need,)
