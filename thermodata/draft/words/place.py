"""Where on the machine: the place that a name speaks of."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.place_rules import RULES, Place
from thermodata.draft.words.vocabulary import OF_CONTROL, QUANTITY_WORDS, beyond, places_in, says

# a control counts its spindles; a sensor that is counted so has a temperature
_SPINDLE_1 = re.compile(r"(?<!\S)s [1-4](?!\S)")
_BY_DRIVE = ("rotational_speed", "power", "load", "current", "torque")
_HEIGHT = re.compile(r"(?<!\S)\d+ (?:\d+ )?m(?!\S)")  # 'air 6 m'
# a feed that is no axis's own
_OF_PATH = (
    "path. bahn. drahy. tool. tcp. f. v. rate. rates. speed. act. actual. ist. soll. set. cmd. value. nc. cnc. mcs. "
    "axes. programmed. override. current. total. resulting. ipo. nck. channel. chan. [0-9]+ "
    "velocity. velocidad. velocidade. velocita. vitesse. geschwindigkeit. rychlost. predkosc. snelheid. hastighet. "
    "sebesseg. hizi. de. di. do. del. d. roboczy. robocza. pracovni. working. machining."
)
_TURNING = re.compile(r"(?:^| )n ([abc])(?: |$)")


def place_of(text: str, quantity: str) -> Place:
    """The place that a name (as words()) speaks of, for this quantity."""
    said, axis = set(places_in(text)), axis_of(text)
    if "not spindle" in said:
        said -= {"spindle"}
        said |= {"screw"}
    if "workhead" in said:
        said -= {"spindle"}  # a grinder turns its part by a spindle of its own
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
    if near_the_floor:
        return Place("hall.bottom", question="at: hall.bottom, the air near the floor, or floor itself?")
    if _SPINDLE_1.search(text) and (quantity in _BY_DRIVE or "motor" in said):
        said |= {"spindle"}
    if quantity == "state" and says(OF_CONTROL, text):
        said |= {"control"}
    if quantity == "feed" and beyond(f"{QUANTITY_WORDS['feed']} {_OF_PATH}", text):
        said |= {"more than a feed"}
    # what turns is the spindle, but for n_B and n_C beside it
    turning = _TURNING.search(text) if quantity == "rotational_speed" and axis is None else None
    axis = turning[1] if turning else axis
    rule: Callable[[set[str], str | None], Place] | None = RULES.get(quantity)
    found = rule(said, axis) if rule else Place(None)
    if counter and found.at is not None and found.at.partition(".")[0] == "spindle":
        asked = found.question and asked_of(found.question, "counter")
        return replace(found, at=f"counter_{found.at}", question=asked)
    if counter and found.at == "headstock":
        return Place("counter_spindle")  # the one with no other name is the main spindle's
    if found.at == "hall" and quantity == "temperature" and _HEIGHT.search(text):
        return Place("hall", question="at: hall.top, hall.bottom, or hall, at the height of the machine?")
    return found


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
