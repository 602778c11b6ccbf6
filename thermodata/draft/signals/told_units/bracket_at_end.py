"""What stands in brackets at the end of a name and no header split off, for it may be a word: the inch of
'X Position (in)', the inlet of 'Coolant (in)', the share of 'Spindle Load (p.u.)'."""

from __future__ import annotations

import re

from thermodata.draft.signals import units
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.draft.words.vocabulary import DIFFERENCE, LIMIT, SETPOINT, foreign_in, places_in, quantities_in
from thermodata.reader.text import split_unit
from thermodata.schema.units.scale import scaled_unit
from thermodata.schema.units.unit import is_unit, normal_unit

_AT_END = re.compile(r"[\[(（［](?P<said>[^\[\]()（）［］]+)[\])）］]$")
# in capitals, or in any letters, these say where or how as well: high pressure, a controlled value, an inlet
_WORDS = frozenset(["hp", "cv", "oc", "in", "at", "out", "on", "min", "max", "d", "h", "s"])
_OTHERWISE = ("cv", "oc")  # of which no quantity says whether they are units
# what counts or shares, of which nobody knows how much one is
_OF_COUNTS = re.compile(
    r"fract?|fraction|ratio|cts?|steps?|ticks?|dig|digits?|lsb|pulses?|imp|inkr|inkremente|incrs?|increments|incs|"
    r"counts?|adu|a\.?u|arb|arb\.u|units?"
)
# signs that no word has; a stroke between two of a kind, 'A/B' or '1/2', is none of them
_SIGNS = re.compile(r"[%‰°º²³^″µμ]|^\"$|[^\W\d_]/(?:s|sec|min|h|hr|rev|turn|count|digit|m?V|K|mm|m)$")
_INDEX = re.compile(r"[\d:, ]+")  # of an array of MATLAB: T(:,1)
_NUMBER = re.compile(r"^\d[\d.,/]*\s*(?=[^\W\d_])")


def of_quantity(name: str, quantity: str | None) -> str | None:
    """The unit in the brackets at the end of a name whose reader leaves it there, where its quantity has it:
    'X Position (in.)' -> 'in'."""
    said = _said(name)
    if said is None or quantity in (None, "state", "label"):
        return None
    if said.casefold() in units.SHARE_WORDS.get(str(quantity), ()):
        return "pu"
    unit = said.rstrip(".")
    if unit.casefold() in _OTHERWISE or not is_unit(unit) or scaled_unit(unit)[0] != 1.0:
        return None
    return unit if units.may_be(unit, str(quantity)) and normal_unit(unit) != "dimensionless" else None


def unknown(name: str, quantity: str | None) -> str | None:
    """What reads as a unit in the brackets at the end of a name and is none of its quantity, or none known here:
    'Position (furlong/d)'. None of words, as of a place or of what was commanded."""
    said = _said(name)
    if said is None or quantity in (None, "state", "label"):
        return None
    bare = said.casefold().rstrip(".")
    if scaled(said, quantity):
        return said
    if _OF_COUNTS.fullmatch(bare):
        return said
    if bare in _WORDS or _is_word(words(said)) or _INDEX.fullmatch(bare):
        return None
    if _SIGNS.search(said):
        return said
    # a letter alone is the name of one of several
    unit = _NUMBER.sub("", said.rstrip("."))
    return said if len(bare) > 1 and "/" not in unit and not unit.isdigit() and is_unit(unit) else None


def scaled(said: str, quantity: str | None) -> bool:
    """Whether brackets hold so many of a unit of the quantity: '0.0001 in'."""
    unit = _NUMBER.sub("", said)
    return unit != said and quantity is not None and is_unit(unit) and units.may_be(unit, quantity)


def any_unit(name: str) -> str | None:
    """What stands in the brackets at the end of a name of which nothing tells the quantity, where it may be a unit."""
    said = _said(name)
    return said if said is not None and len(said) > 1 and is_unit(said) and not _INDEX.fullmatch(said) else None


def _said(name: str) -> str | None:
    found = _AT_END.search(split_unit(name)[0].strip())
    return found["said"].strip() if found else None


def _is_word(text: str) -> bool:
    said = (places_in(text), quantities_in(text), foreign_in(text))
    return any(said) or any(holds_word(listed, text) for listed in (SETPOINT, LIMIT, DIFFERENCE))
