"""Which other part a candidate may be: one that warms at the same hours, and that its channels do not tell apart.

One motion rubs in screw and guideway of an axis; frame and holder of the probes stand in the same air; coolant, chips
and a hot part warm the holder too; what a spindle takes up heats its motor, whether it cuts or not. A temperature tells
its own part from one that has a sensor, and not from one that has none; a motion tells none from the other.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from thermodata.effect.binding import Described
from thermodata.effect.places import holds
from thermodata.plugin import Effect
from thermodata.schema.words.places import is_spindle

AXIS = "axis."
LINEAR = "xyzuvw"
AIR = "air"
# what moves or drives an axis, and so makes its heat; where it stands, or whether it is clamped, makes none
MAKES_HEAT = frozenset({"feed", "rotational_speed", "power", "load", "current", "torque"})
TEMPERATURE = "temperature"


@dataclass(frozen=True, slots=True)
class MachinePart:
    """heat: what is shared, `axis.z` or the air. name: of the part in it."""

    heat: str
    name: str


# of each kind of heat its parts, and the places that read them, the one to log first
RUBS: Mapping[str, tuple[str, ...]] = {"screw": ("nut", "screw", "bearing"), "guide": ("guide",)}
HOLDER = "holder"
LESSER, GREATER = "guide", "screw"  # of what one axis rubs: what moves the tool less as a rule, and what more
STANDS_IN_AIR: Mapping[str, tuple[str, ...]] = {"frame": ("hall", "outside"), HOLDER: ("fixture", "probe")}
# what is in the working space, and so warms what holds the probes there: by place, and what the spindle does to a part
IN_WORKING_SPACE = ("coolant", "workpiece")
CUTS = frozenset({"power", "load"})
POWER_OF = frozenset({"torque", "rotational_speed"})  # what together is a power
MOTOR = "motor"  # it warms with all that its axis rubs


def parts_of(effect: Effect, names: Iterable[str], channels: Mapping[str, Described]) -> frozenset[MachinePart]:
    """The parts that an effect stands for: where its temperatures sit, or those that it is named for, of a motion. None
    where its channels sit in more than one heat: what it subtracts is a reference."""
    at = [(channels[n].quantity, part_of(channels[n].at)) for n in names if n in channels]
    heat = _one_heat(part for _, part in at)
    if heat is None:
        return frozenset()
    named = {p.name for need in effect.needs for place in need.places if (p := part_of(place)) and p.name in RUBS}
    read = {part for quantity, part in at if part and part.name and quantity == TEMPERATURE}
    return frozenset(read or {MachinePart(heat, name) for name in named if heat != AIR})


def unread(
    effect: Effect, names: Collection[str], channels: Mapping[str, Described], known: Collection[MachinePart]
) -> tuple[str, ...]:
    """Places of the parts that it may be as well; none for what doesn't sit in one heat. channels: the usable ones.
    known: parts that the model has."""
    if all(warms_the_holder(channels[n]) for n in names) or _take_up_power(names, channels):
        places = STANDS_IN_AIR[HOLDER]
        told = MachinePart(AIR, HOLDER) in known or any(reads(channels, place) for place in places)
        motors = (place for place in motors_of(names, channels) if not reads(channels, place))
        return (*motors, *(() if told else places[:1]))
    heat = _one_heat(part_of(channels[n].at) for n in names)
    warm = sum(channels[n].quantity == TEMPERATURE for n in names)
    moving = all(is_motion(channels[n].quantity) for n in names)
    # a difference of two temperatures is of neither; what else there is in the hall warms nothing by itself
    if heat is None or not (warm == len(names) == 1 or (moving and heat != AIR)):
        return ()
    own = {part.name for part in parts_of(effect, names, channels)}
    if not own <= {*RUBS, *STANDS_IN_AIR, MOTOR}:
        return ()  # an amplifier, a scale, a place that nobody knows: whose heat that is can't be told
    others = [
        places[0]
        for name, places in _places_by_part(heat).items()
        if name not in own
        and MachinePart(heat, name) not in known
        and not (warm and any(reads(channels, place) for place in places))
    ]
    # a motion of no part in particular is the only one that is left
    return tuple(others) if own or len(others) > 1 else ()


def is_lesser(
    effect: Effect, names: Collection[str], channels: Mapping[str, Described], other: Collection[str]
) -> bool:
    """Whether it is the lesser part of what rubs, while the greater one may be it as well, and is no candidate itself:
    by what moves the axis the greater part has a name of its own, which the lesser must beat. other: `unread` of it."""
    own = parts_of(effect, names, channels)
    greater = (part_of(place) for place in other)
    if {part.name for part in own} != {LESSER} or not any(part and part.name == GREATER for part in greater):
        return False
    heats = {part.heat for part in own}
    moved = (part_of(c.at) for c in channels.values() if is_motion(c.quantity))
    return not any(part is not None and part.heat in heats for part in moved)


def reads(channels: Mapping[str, Described], place: str) -> bool:
    """Whether a temperature is logged at a place."""
    return any(c.quantity == TEMPERATURE and holds(place, c.at) for c in channels.values())


def warms_the_holder(channel: Described) -> bool:
    """Whether what holds the probes warms with it, beside the machine."""
    return _tells_cutting(channel) or any(holds(place, channel.at) for place in IN_WORKING_SPACE)


def is_holder(channel: Described) -> bool:
    """Whether it is the temperature of what holds the probes, or of the tool that the spindle holds."""
    held = part_of(channel.at) == MachinePart(AIR, HOLDER) or holds("tool", channel.at)
    return channel.quantity == TEMPERATURE and held


def _tells_cutting(channel: Described) -> bool:
    return channel.quantity in CUTS and is_spindle(channel.at)


def _take_up_power(names: Iterable[str], channels: Mapping[str, Described]) -> bool:
    """Whether torque and speed of a spindle say what it takes up."""
    own = [channels[n] for n in names]
    return {c.quantity for c in own} == POWER_OF and all(is_spindle(c.at) for c in own)


def motors_of(names: Collection[str], channels: Mapping[str, Described]) -> tuple[str, ...]:
    """The places of the motors of what spindles take up."""
    power = _take_up_power(names, channels)
    spindles = {(channels[n].at or "").lower().partition(".")[0] for n in names if power or _tells_cutting(channels[n])}
    return tuple(f"{one}.{MOTOR}" for one in sorted(spindles))


def is_motion(quantity: str) -> bool:
    """Whether it makes the heat of an axis, and has the timing of no part."""
    return quantity in MAKES_HEAT


def _places_by_part(heat: str) -> dict[str, tuple[str, ...]]:
    """Part -> places that read it."""
    if heat == AIR:
        return dict(STANDS_IN_AIR)
    return {part: tuple(f"{heat}.{word}" for word in words) for part, words in RUBS.items()}


def _one_heat(parts: Iterable[MachinePart | None]) -> str | None:
    heats = {part.heat if part else None for part in parts}
    return heats.pop() if len(heats) == 1 else None


def part_of(place: str | None) -> MachinePart | None:
    """Of a place: the part, one without a name for a linear axis as a whole; None elsewhere."""
    for name, places in STANDS_IN_AIR.items():
        if any(holds(p, place) for p in places):
            return MachinePart(AIR, name)
    if place is None or not place.lower().startswith(AXIS):
        return None
    axis, _, below = place.lower().removeprefix(AXIS).partition(".")
    if axis != "{a}" and axis[:1] not in tuple(LINEAR):
        return None
    word = below.partition(".")[0]
    return MachinePart(AXIS + axis, next((part for part, words in RUBS.items() if word in words), word))
