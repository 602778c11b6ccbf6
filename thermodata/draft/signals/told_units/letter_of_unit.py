"""The letter of a unit in a name that is the letter of an axis, too: 'temp_c_motor', 'spindle_current_a'."""

from __future__ import annotations

import re
from dataclasses import replace

from thermodata.draft.signals.placed import placed
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.words.naming import parts_of, words
from thermodata.draft.words.vocabulary import quantities_in

_LETTER = {"temperature": ("c", "degC"), "temperature_difference": ("c", "degC"), "current": ("a", "A")}
_DEGREES = ("deg", "grad", "degree", "degrees")
_AXIS = re.compile(r"axis|achse|osa|asse|axe|eje|eixo|tengely|eksen|ось|ax|os|as|jiku|zhou|轴|軸|rotary|\d+")


def placed_but_for_unit(found: Guess, own: str, text: str, told: str, name: str, stated: bool) -> Guess:
    """With its place and axis, where a letter of the name may be its unit. name: without units in brackets; stated:
    whether the unit stands elsewhere, so that the letter is none. The others as of `placed`."""
    as_axis = placed(found, own, text, told)
    letter, unit = _LETTER.get(found.quantity or "", ("", ""))
    if stated or not letter or not _may_be_unit(letter, name, found.quantity or ""):
        return as_axis
    but = placed(found, _without(letter, own), _without(letter, text), told)
    if (but.at, but.questions) == (as_axis.at, as_axis.questions) or _is_unit(letter, name, found.quantity or ""):
        return but
    if as_axis.at is None or not as_axis.at.startswith("rotary."):
        return as_axis
    other = but.at or "of what else, e.g. spindle.motor"
    asked = f"at: {as_axis.at}, of the {letter.upper()} axis? or, where the letter is the unit {unit}, {other}"
    others = [q for q in but.questions if not q.startswith("at: ")]
    return replace(but, at=None, sure=False, questions=(*others, asked))


def _may_be_unit(letter: str, name: str, quantity: str) -> bool:
    """Whether a letter of its own stands behind a word of the quantity, or at the end of a part of the name, and
    neither the number nor the word of an axis stands beside it."""
    for part in _parts(name):
        for before, said, behind in zip(["", *part], part, [*part[1:], ""], strict=False):
            if said != letter or _AXIS.fullmatch(before) or _AXIS.fullmatch(behind):
                continue
            if before and (not behind or _says(quantity, before)):
                return True
    return False


def _is_unit(letter: str, name: str, quantity: str) -> bool:
    """Whether a part of the name ends with a word of the quantity and the letter: 'bearing_temp_c', 'temp_c/motor'. A
    capital behind one letter, or of a phase, may be an axis: 'T_C', 'Current_A'."""
    small = re.search(rf"(?<![^\W\d_]){letter}(?![^\W\d_])", name) is not None
    return any(
        part[-1:] == [letter] and _says(quantity, before) and (small or (letter == "c" and len(before) > 1))
        for part in _parts(name)
        for before in part[-2:-1]
    )


def _parts(name: str) -> list[list[str]]:
    return [words(part).split() for whole in parts_of(name) for part in whole.split(".")]


def _says(quantity: str, word: str) -> bool:
    return quantity in quantities_in(word) or (quantity != "current" and word in _DEGREES)


def _without(letter: str, text: str) -> str:
    return " ".join(word for word in text.split() if word != letter)
