"""Where on the machine: the place that a name speaks of."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.listed import beyond, holds_word
from thermodata.draft.words.place_rules import RULES, Place
from thermodata.draft.words.switches import MEASURES
from thermodata.draft.words.vocabulary import (
    DIFFERENCE,
    LIMIT,
    OF_CONTROL,
    PLACE_WORDS,
    QUANTITY_WORDS,
    SETPOINT,
    places_in,
)

# a control counts its spindles; a sensor that is counted so has a temperature
_SPINDLE_1 = re.compile(r"(?<!\S)s [1-4](?!\S)")
_BY_DRIVE = ("rotational_speed", "power", "load", "current", "torque")
_HEIGHT = re.compile(r"(?<!\S)(\d+) (?:(\d+) )?m(?!\S)")  # 'air 6 m'
_OF_MACHINES_M = (1.0, 2.0)  # of 'Halle, 1,5 m hoch'
# a feed that is no axis's own
_OF_PATH = (
    "path. bahn. drahy. tool. tcp. f. v. rate. rates. speed. act. actual. ist. soll. set. cmd. value. nc. cnc. mcs. "
    "axes. programmed. override. current. total. resulting. ipo. nck. channel. chan. [0-9]+ "
    "velocity. velocidad. velocidade. velocita. vitesse. geschwindigkeit. rychlost. predkosc. snelheid. hastighet. "
    "sebesseg. hizi. de. di. do. del. d. roboczy. robocza. pracovni. working. machining."
)
# of a wire or a sensor, whatever it is at
_WIRES = "ch. chan. channel. kanal. canal. tc. pt. ni. sensor sond mess meas. act. ist. degc. no. nr. the. of. at. am."
_EVERY = " ".join((*PLACE_WORDS.values(), *QUANTITY_WORDS.values(), SETPOINT, LIMIT, DIFFERENCE, _WIRES))
_LETTER = re.compile(r"(?<!\S)([abc])(?!\S)")
_PLACED = ("table", "workhead", "motor", "tool", "front", "rear", "screw", "nut", "air")
_OF_LETTER = "at: rotary.{}, of the {} axis? or of what else, e.g. spindle.bearing.front"
_OF_WHAT_BEARING = "at: which bearing? e.g. spindle.bearing.front, axis.z.bearing, table.bearing"
_TURNING = re.compile(r"(?:^| )n ([abc])(?: |$)")


def place_of(text: str, quantity: str) -> Place:
    """The place that a name (as words()) speaks of, for this quantity."""
    said, axis = set(places_in(text)), axis_of(text)
    if "not spindle" in said:
        said -= {"spindle"}
        said |= {"screw"}
    if "workhead" in said:
        said -= {"spindle"}  # a grinder turns its part by a spindle of its own
    elif "grinding wheel" in said and (quantity in _BY_DRIVE or said & {"bearing", "motor"}):
        said |= {"spindle"}
    trunnion = "trunnion" in said
    said -= {"grinding wheel", "trunnion"}
    if said & {"counter spindle", "milling spindle", "main spindle"}:
        said |= {"spindle"}
    if "turret" in said:
        return _turret(said, quantity)
    counter = "counter spindle" in said
    said = _by_the_machine(said) - {"counter spindle", "milling spindle", "main spindle"}
    near_the_floor = {"air", "floor"} <= said and quantity == "temperature"
    if {"air", "bearing"} <= said and quantity == "temperature":
        return Place("pneumatics", question="at: pneumatics, the supply air of the bearing, or spindle.bearing itself?")
    said -= {"air"}
    if "tailstock" in said:
        said -= {"ram", "headstock"}  # whose quill is no ram; 'contre-poupée' holds the word of the headstock
    if "saddle" in said:
        said -= {"tool"}  # 'Werkzeugschlitten'
    if near_the_floor:
        return Place("hall.bottom", question="at: hall.bottom, the air near the floor, or floor itself?")
    if _SPINDLE_1.search(text) and (quantity in _BY_DRIVE or "motor" in said):
        said |= {"spindle"}
    if quantity == "state" and (holds_word(OF_CONTROL, text) or holds_word(MEASURES, text)):
        said |= {"control"}
    if quantity == "feed" and beyond(f"{QUANTITY_WORDS['feed']} {_OF_PATH}", text):
        said |= {"more than a feed"}
    # what turns is the spindle, but for n_B and n_C beside it
    turning = _TURNING.search(text) if quantity == "rotational_speed" and axis is None else None
    axis = turning[1] if turning else axis
    letter = _LETTER.search(text) if {"bearing"} == said & {"bearing", "spindle", *_PLACED} and axis is None else None
    if letter and trunnion:
        axis = letter[1]
    elif letter and quantity == "temperature":
        return Place(None, question=_OF_LETTER.format(letter[1], letter[1].upper()))
    rule: Callable[[set[str], str | None], Place] | None = RULES.get(quantity)
    found = rule(said, axis) if rule else Place(None)
    found = _as_far_as_known(found, text, said) if quantity == "temperature" else found
    if counter and found.at is not None and found.at.partition(".")[0] == "spindle":
        asked = found.question and asked_of(found.question, "counter")
        return replace(found, at=f"counter_{found.at}", question=asked)
    if counter and found.at == "headstock":
        return Place("counter_spindle")  # the one with no other name is the main spindle's
    height = _HEIGHT.search(text) if found.at == "hall" and quantity == "temperature" else None
    if height and not _OF_MACHINES_M[0] <= float(f"{height[1]}.{height[2] or 0}") <= _OF_MACHINES_M[1]:
        return Place("hall", question="at: hall.top, hall.bottom, or hall, at the height of the machine?")
    return found


def _as_far_as_known(found: Place, text: str, said: set[str]) -> Place:
    """The place of a spindle, less sure where the name has a word that nobody knows: 'spindle wdg', 'knee bearing'."""
    known = found.at != ("spindle.bearing" if "spindle" not in said else "spindle" if found.sure else "")
    if known or not any(map(str.isalpha, (w for w in beyond(_EVERY, text) if len(w) > 1))):
        return found
    return replace(found, sure=False) if "spindle" in said else Place(None, question=_OF_WHAT_BEARING)


def described_place(own: str, told: str, quantity: str) -> Place:
    """The place by a name and by what a file says of it: by the name where that says more of the same part. own, told:
    as words()."""
    place, said, both = (place_of(text, quantity) for text in (own, told, f"{told} {own}"))
    if not places_in(told) and axis_of(told) is None:
        return place
    if said.at is None:
        within = both.at is not None and (place.at is None or both.at.startswith(place.at))
        return both if within else said if "workhead" in places_in(told) else place
    if place.at is not None and place.at.startswith(f"{said.at}."):
        return place
    return both if both.at is not None and both.at.startswith(f"{said.at}.") else said


def asked_of(question: str, name: str) -> str:
    """A question about the spindle, of the one that has a name: counter, milling."""
    return question.replace(" spindle.", f" {name}_spindle.")


def _turret(said: set[str], quantity: str) -> Place:
    """Of a lathe's turret and its driven tools."""
    if quantity in ("temperature", "rotational_speed"):
        return Place("turret.motor" if "motor" in said and quantity == "temperature" else "turret", True)
    if quantity in _BY_DRIVE:
        return Place("turret")
    return Place(None, question="at: of the turret?")


def _by_the_machine(said: set[str]) -> set[str]:
    """What leaves the chiller goes to the machine."""
    out, into = "out of the chiller" in said, "into the chiller" in said
    if out == into:
        return said
    return said - {"supply", "return"} | {"supply" if out else "return"}
