"""Where a signal sits: its place and axis, by its name or those of the groups above it."""

from __future__ import annotations

from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import OF_SENSOR, Guess
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.place import described_place, place_of
from thermodata.draft.words.place_rules import Place
from thermodata.draft.words.vocabulary import DIFFERENCE, LIMIT, SETPOINT, places_in
from thermodata.schema.units.quantity import PROBED

_NEVER_DIFFERENCES = ("feed", "position", "rotational_speed", "torque", "current", "pressure")
_NEEDS_PLACE = (
    "temperature",
    "temperature_difference",
    "power",
    "load",
    "current",
    "torque",
    "position",
    "flow",
    "pressure",
    "displacement",
    "rotational_speed",
    "feed",
)


def placed(found: Guess, own: str, text: str, told: str = "") -> Guess:
    """With its place and axis, and what these leave open. own: the name; text: with the names of the groups above;
    told: what its file says of it."""
    if found.quantity == "position" and (axis_of(own) or "") in ("a", "b", "c") and "unit" not in found.basis:
        # a rotary axis stands at an angle, whatever length was taken for its unit
        found = replace(found, quantity="angle", unit="deg", sure=False, questions=("unit: deg?",))
    quantity = found.quantity or ""
    place, axis = described_place(own, told, quantity) if told else place_of(own, quantity), axis_of(own)
    nowhere = not places_in(own) and axis is None and quantity != "displacement"
    if place.at is None or (quantity in _NEEDS_PLACE and nowhere):
        wider = place_of(text, quantity)
        if wider.at is not None and (places_in(text) or axis_of(text)) and not _group_is_test(text, own):
            # the folder of names above tells where: less sure than the name itself
            place = Place(wider.at, False, wider.question)
    axis = axis or (axis_of(text) if quantity in PROBED else None)
    questions = list(found.questions)
    # what a sensor's current measures says where it may be: no drive of it is sought before that is known
    is_open = any(q.startswith(OF_SENSOR) for q in questions)
    if place.question and not is_open and (quantity in _NEEDS_PLACE or quantity == "state"):
        questions.append(place.question)
    letter = axis.upper() if axis and quantity in PROBED else None
    if quantity == "displacement" and place.at == "tcp" and letter is None:
        questions.append("axis?")
    if holds_word(SETPOINT, own) and quantity not in ("state", "displacement"):
        questions.append("a set value, not the actual one? written only where it changes: held: true")
    elif holds_word(LIMIT, own) and quantity not in ("state", "displacement"):
        questions.append("a limit, or a reading?")
    elif holds_word(DIFFERENCE, own) and quantity in _NEVER_DIFFERENCES:
        questions.append("a difference, not the quantity itself?")
    if found.basis == ("unit",) and place.at is not None and quantity not in ("position", "voltage"):
        # degC at a bearing: the name need not say T
        found = replace(found, basis=("name", "unit"), sure=found.sure or place.sure)
    sure = found.sure and (place.sure or place.at is None) and not questions
    return replace(found, at=place.at, axis=letter, sure=sure, questions=tuple(dict.fromkeys(questions)))


def _group_is_test(text: str, own: str) -> bool:
    """A group called 'Spindle test 3' or 'measurement' names the test, not the place."""
    return holds_word("test. tests. run. versuch. messung. measurement. mereni. 试验 测试", text.removesuffix(own))
