"""Which other part a candidate may be: one that warms at the same hours, and that its channels do not tell apart.

One motion rubs in screw and guideway of an axis; frame and holder of the probes stand in the same air. A temperature
tells its own part from one that has a sensor, and not from one that has none; a motion tells none from the other.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from thermodata.effect.binding import Described
from thermodata.effect.places import holds
from thermodata.plugin import Effect

AXIS = "axis."
AIR = "air"


@dataclass(frozen=True, slots=True)
class Part:
    """heat: what is shared, `axis.z` or the air. name: of the part in it."""

    heat: str
    name: str


# of each kind of heat its parts, and the places that read them, the one to log first
RUBS: Mapping[str, tuple[str, ...]] = {"screw": ("nut", "screw", "bearing"), "guide": ("guide",)}
STANDS_IN_AIR: Mapping[str, tuple[str, ...]] = {"frame": ("hall", "outside"), "holder": ("fixture", "probe")}


def parts_of(effect: Effect, names: Iterable[str], channels: Mapping[str, Described]) -> frozenset[Part]:
    """The parts that an effect stands for: where its channels sit, or, of a motion, those that it is named for."""
    at = [part for n in names if n in channels and (part := _part(channels[n].at))]
    named = {p.name for need in effect.needs for place in need.places if (p := _part(place)) and p.name in RUBS}
    whole = {Part(p.heat, name) for p in at if not p.name for name in named}
    return frozenset({p for p in at if p.name} or whole)


def unread(
    effect: Effect, names: Collection[str], channels: Mapping[str, Described], known: Collection[Part]
) -> tuple[str, ...]:
    """Places of the parts that it may be as well; none for what doesn't sit in one heat. channels: the usable ones.
    known: parts that the model has."""
    at = [_part(channels[n].at) for n in names]
    warm = sum(channels[n].quantity == "temperature" for n in names)
    heats = {part.heat if part else "" for part in at}
    heat = heats.pop() if len(heats) == 1 else ""
    # a difference of two temperatures is of neither; what else there is in the hall warms nothing by itself
    if not heat or warm > 1 or (heat == AIR and not warm):
        return ()
    own = {part.name for part in parts_of(effect, names, channels)}
    others = [
        places[0]
        for name, places in _places(heat).items()
        if name not in own
        and Part(heat, name) not in known
        and not (warm and any(reads(channels, place) for place in places))
    ]
    # a motion of no part in particular is the only one that is left
    return tuple(others) if own or len(others) > 1 else ()


def reads(channels: Mapping[str, Described], place: str) -> bool:
    """Whether a temperature is logged at a place."""
    return any(c.quantity == "temperature" and holds(place, c.at) for c in channels.values())


def _places(heat: str) -> dict[str, tuple[str, ...]]:
    """Part -> places that read it."""
    if heat == AIR:
        return dict(STANDS_IN_AIR)
    return {part: tuple(f"{heat}.{word}" for word in words) for part, words in RUBS.items()}


def _part(place: str | None) -> Part | None:
    """Of a place: the part, one without a name for an axis as a whole; None elsewhere."""
    for name, places in STANDS_IN_AIR.items():
        if any(holds(p, place) for p in places):
            return Part(AIR, name)
    if place is None or not place.lower().startswith(AXIS):
        return None
    axis, _, below = place.lower().removeprefix(AXIS).partition(".")
    word = below.partition(".")[0]
    return Part(AXIS + axis, next((part for part, words in RUBS.items() if word in words), word))
