"""The vocabulary of `at:`: dotted places on a machine tool and around it.

An effect finds its drivers by these words (`thermodata.effect.places` matches them), so a lab that uses them gets its
candidates named. Any other place is allowed: it stays generic, and no effect that names a place takes it.
`*` stands for an axis letter: x, y or z of a linear axis, a, b or c of a rotary one.
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from thermodata.errors import nearest

_SLIP = 0.67  # of a part's letters: 'air' has two of three of 'far'

PLACES: dict[str, str] = {
    "tcp": "tool centre point: where a displacement counts",
    "stator": "the spindle's standing part: a displacement without the tool",
    "tool": "the tool in the spindle",
    "spindle": "the spindle as a whole: its speed, power, load; a temperature of no part in particular",
    "spindle.bearing": "a bearing of the spindle, where front and rear are not told apart",
    "spindle.bearing.front": "the bearing next to the tool",
    "spindle.bearing.rear": "the bearing at the far end",
    "spindle.motor": "the winding of the spindle's motor",
    "spindle.drive": "the spindle's drive amplifier",
    "spindle.gearbox": "the gearbox between motor and spindle",
    "counter_spindle": "the second spindle of a lathe, which takes the part over; it has the parts of `spindle`",
    "milling_spindle": "the milling spindle of a turn-mill centre, beside that which turns the part; the same",
    "headstock": "the housing that holds the spindle",
    "ram": "the slide that carries the spindle out",
    "ram.front": "the side of the ram towards the working space",
    "ram.rear": "the side away from it",
    "ram.left": "its left side, seen by the operator",
    "ram.right": "its right side",
    "ram.top": "the upper side of a ram that lies",
    "ram.bottom": "its lower side",
    "tailstock": "what holds the far end of a part that turns",
    "turret": "the turret of a lathe: its temperature, the speed of its driven tools",
    "turret.motor": "the motor of the turret, or of its driven tools",
    "saddle": "the slide between two axes",
    "crossbeam": "the beam of a gantry or a portal",
    "crossbeam.top": "its upper side",
    "crossbeam.bottom": "its lower side",
    "crossbeam.front": "the side of the beam towards the spindle",
    "crossbeam.rear": "the side away from it",
    "crossbeam.left": "its left end, seen by the operator",
    "crossbeam.right": "its right end",
    "column": "the column, where its sides are not told apart",
    "column.front": "the side of the column towards the working space",
    "column.rear": "the side away from it",
    "column.left": "its left side, seen by the operator",
    "column.right": "its right side",
    "column.top": "its upper end",
    "column.bottom": "its lower end",
    "bed": "the bed or base of the machine, where its sides are not told apart",
    "bed.top": "its upper side, under the slides",
    "bed.bottom": "its lower side, at the floor",
    "bed.front": "the side of the bed towards the operator",
    "bed.rear": "the side away from him",
    "bed.left": "its left side or end, seen by the operator",
    "bed.right": "its right side or end",
    "table": "the table, turning or not: its speed, its temperature",
    "table.bearing": "the bearing of a turning table",
    "table.motor": "the motor of a turning table",
    "table.d1500": "a measuring place on the table, by its diameter in mm (any number)",
    "axis.*": "a linear axis as a whole: its feed, position, load, power",
    "axis.*.motor": "the motor of the axis",
    "axis.*.drive": "the drive amplifier of the axis",
    "axis.*.bearing": "the bearing house of the feed screw",
    "axis.*.screw": "the feed screw",
    "axis.*.nut": "the nut of the feed screw",
    "axis.*.guide": "the guideway of the axis",
    "axis.*.scale": "the linear scale of the axis",
    "rotary.*": "a rotary axis, of a head or of a table",
    "rotary.*.motor": "the motor of a rotary axis",
    "rotary.*.drive": "its drive amplifier",
    "workpiece": "the part on the machine",
    "fixture": "what holds the part, or the probes",
    "probe": "a displacement probe itself",
    "coolant": "the cutting fluid: switched on, its flow, its temperature",
    "coolant.supply": "the cutting fluid on its way to the machine",
    "coolant.return": "the cutting fluid on its way back",
    "coolant.tank": "the tank of the cutting fluid",
    "chiller": "the cooling circuit of spindle or drives",
    "chiller.supply": "that circuit on its way to the machine",
    "chiller.return": "that circuit on its way back",
    "chiller.tank": "the tank of that circuit",
    "hydraulics": "tank and pump of the hydraulics",
    "lubrication": "the lubrication and its oil",
    "pneumatics": "the compressed air",
    "pump": "a pump of which nothing more is known",
    "fan": "a fan of machine or hall",
    "cabinet": "the electrical cabinet",
    "cnc": "the control",
    "cnc.compensation": "what the control itself adds to an axis",
    "enclosure": "the air of the working space, within the machine's enclosure",
    "hall": "the air around the machine",
    "hall.top": "that air above, at the height of the machine's top",
    "hall.bottom": "that air below, near the floor",
    "hall.near": "that air beside the machine",
    "hall.far": "that air away from it",
    "hall.door": "at the hall's door; also the door's state",
    "hall.window": "at a window of the hall",
    "hall.sun": "where the sun reaches the machine",
    "outside": "the weather outside of the hall",
    "floor": "floor and foundation",
}

_DIAMETER = "table.d"
_LETTERS = {"axis": "xyz", "rotary": "abc"}
# a tool change, a cut or the coolant makes any reading there jump, and no mass holds it
_AT_TOOL = ("tcp", "tool", "stator", "probe")
AROUND = ("hall", "floor", "outside")
# castings: heat passes through them, and none begins there
_CASTINGS = ("headstock", "ram", "saddle", "crossbeam", "column", "bed")
# and what others call them, with the words for it here
_ALSO_CASTINGS: dict[str, tuple[str, ...]] = {
    "crossrail": ("crossbeam",),
    "cross_rail": ("crossbeam",),
    "cross_beam": ("crossbeam",),
    "bridge": ("crossbeam",),
    "portal": ("crossbeam", "column"),
    "gantry": ("crossbeam", "column"),
    "stand": ("column",),
    "upright": ("column",),
    "frame": ("bed", "column"),
    "base": ("bed",),
}
# the same of what is no casting
_ALSO: dict[str, tuple[str, ...]] = {
    "air": ("hall",),
    "ambient": ("hall",),
    "room": ("hall",),
    "part": ("workpiece",),
    "quill": ("ram",),
    "slide": ("saddle", "ram"),
    "cooler": ("chiller",),
    "oil": ("hydraulics", "lubrication", "coolant"),
}
# and of a part, which others count to another body
_ALSO_PARTS: dict[str, tuple[str, ...]] = {
    f"{body}{link}{part}": ("headstock",)
    for body, link in (("spindle", "."), ("spindle", "_"), ("head", "."))
    for part in ("housing", "head", "box", "carrier", "casing", "body", "case", "stock")
}
# parts and bodies that make or bring heat of their own, and store it; and what of them does not
_HEATED = {"bearing", "nut", "screw", "gearbox"}
_MAKES_HEAT = ("turret", "hydraulics", "chiller", "lubrication")
_WOUND = {"motor", "drive"}
# no body between tool and part: what is read there warms with whichever drive works
_BESIDE = ("cabinet", "cnc")
# makes heat or cold of its own for as long as the machine is switched on, whatever it does
_POWERED = ("cabinet", "cnc", "hydraulics", "chiller", "coolant", "lubrication", "pneumatics", "pump", "fan")


def _body(place: str | None) -> str:
    """'spindle' of 'spindle.motor'; '' where no place is known."""
    return (place or "").lower().partition(".")[0]


def is_at_tool(place: str | None) -> bool:
    """Whether a dotted place is at the tool or at a probe, where a reading may jump without a fault."""
    return _body(place) in _AT_TOOL


def is_spindle(place: str | None) -> bool:
    """Whether a dotted place is a spindle or on one, whatever its name: spindle.motor, counter_spindle."""
    return _body(place).endswith("spindle")


def is_casting(place: str | None) -> bool:
    """Whether a dotted place is on a body that makes no heat of its own: what is read there came from elsewhere."""
    return _body(place) in (*_CASTINGS, *_ALSO_CASTINGS)


def is_scale(place: str | None) -> bool:
    """Whether a dotted place is a linear scale: it makes no heat, and is as warm as what bears it."""
    return place is not None and place.lower().startswith("axis.") and "scale" in place.lower().split(".")[2:]


def makes_heat(place: str | None) -> bool:
    """Whether a dotted place is a part that makes, or brings, heat of its own and is a mass that stores it: a bearing,
    a nut, an oil tank. No winding: it is as warm as what its drive does at the time."""
    first, *parts = (place or "").lower().split(".")
    made = first in _MAKES_HEAT or bool(_HEATED.intersection(parts))
    return made and not _WOUND.intersection(parts)


def is_beside(place: str | None) -> bool:
    """Whether a dotted place is of the machine, but on no body between tool and part: the cabinet, the control."""
    return _body(place) in _BESIDE


def is_powered(place: str | None) -> bool:
    """Whether what is at a dotted place stays warm, or cold, after any rest, once the machine is switched on."""
    first, _, rest = (place or "").lower().partition(".")
    return first in _POWERED or rest.rpartition(".")[2] == "drive"


def is_around(place: str | None) -> bool:
    """Whether a dotted place is not of the machine, but around it: nobody heats it, and it moves by itself."""
    return _body(place) in AROUND


_FLUIDS = ("coolant", "chiller", "hydraulics", "lubrication", "pneumatics")


def is_fluid(place: str | None) -> bool:
    """Whether what is there flows or stands in a tank: how much there is of it, and whether it flows, changes by what
    factor its temperature answers."""
    return _body(place) in _FLUIDS


def cools(place: str | None) -> bool:
    """Whether what runs there takes heat away."""
    return _body(place) in (*_FLUIDS, "pump", "fan")


AIRS = {"hall": "the air of the hall", "enclosure": "the air of the working space"}
# where a campaign may know no such place: what it is, and that nothing is logged there
_SAID = {"fixture": "a warming fixture of the probes or the part (no sensor there)", **AIRS}


def heat_at(places: Sequence[str], link: str) -> str:
    """'heat at axis.z.nut or axis.z.guide', 'the air of the hall'. link: ' or ', ' and '."""
    bodies = [f"heat at {link.join(some)}"] if (some := [p for p in places if p not in _SAID]) else []
    return link.join([*bodies, *(said for place, said in _SAID.items() if place in places)])


def called_here(place: str) -> tuple[str, ...]:
    """The places of this vocabulary that others call so: 'frame.top' -> ('bed.top', 'column.top'), 'spindle.housing' ->
    ('headstock',); () where none."""
    if place.lower() in _ALSO_PARTS:
        return _ALSO_PARTS[place.lower()]
    first, dot, rest = place.lower().partition(".")
    own = (_ALSO_CASTINGS | _ALSO).get(first, ())
    return tuple(found for one in own if (found := f"{one}{dot}{rest}") in PLACES)


def is_known(place: str) -> bool:
    """Whether a dotted place is of this vocabulary, in any case of its letters. Unknown ones are allowed too."""
    place = place.lower()
    if place in PLACES and "*" not in place:
        return True
    if place.startswith(_DIAMETER) and place.removeprefix(_DIAMETER).isdecimal():
        return True
    part, _, rest = place.partition(".")
    if part.endswith("_spindle") and not rest.startswith("."):  # a spindle by its name, with the parts of a spindle
        return f"spindle{'.' + rest if rest else ''}" in PLACES
    letter, _, below = rest.partition(".")
    letters = _LETTERS.get(part, "")
    return len(letter) == 1 and letter in letters and f"{part}.*{'.' + below if below else ''}" in PLACES


def every_place() -> list[str]:
    """All places of the vocabulary, those of axes with each letter."""
    return [place.replace("*", letter) for place in PLACES for letter in _letters(place)]


def _letters(place: str) -> str:
    return _LETTERS[place.partition(".")[0]] if "*" in place else "-"


def nearest_place(place: str) -> str | None:
    """The place that was meant by one that is not known: a part that is spelt alike, or else what the unknown part is
    of ('hall.air' is no 'hall.door', but of the 'hall'); None where none is near. Of the axis that was named."""
    first, _, rest = place.lower().partition(".")
    letter = rest.partition(".")[0]
    known = [p.replace("*", letter) for p in PLACES if "*" not in p or letter in [*_LETTERS[p.partition(".")[0]]]]
    if first.endswith("_spindle"):
        known += [p.replace("spindle", first, 1) for p in PLACES if p.startswith("spindle.")]
    whole, _, part = place.lower().rpartition(".")
    if not is_known(whole):
        return nearest(place, known)
    parts = {p.rpartition(".")[2]: p for p in known if p.rpartition(".")[0] == whole}
    close = nearest(part, list(parts))
    return parts[close] if close is not None and get_close_matches(part, [close], cutoff=_SLIP) else whole
