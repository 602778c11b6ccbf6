"""Lines above the names that say units or scales, 'Units: INCH', '"Scaling","CH1-2","Ratio",100,"um"':
quoted where the unit of a column is asked, never taken."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.signals.unit_words import is_surely_unit, may_be_a_machine
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.text.preamble.scale_words import spellings
from thermodata.schema.units.unit import normal_unit

HEAD = "head"  # property of a signal: what the head of its file says of units
_UNITS = re.compile(
    r"(?i)\b(?:fahrenheit|celsius|kelvin|inch(?:es)?|imperial|metric|deg\.? ?[fc]|units?|einheit(?:en)?|scal(?:e|ing)|"
    r"skalierung|ratio|gain)\b|[°º][FC]\b"
)
# what is no degree Celsius, millimetre or micrometre
OTHERS = re.compile(r"(?i)\b(?:fahrenheit|inch(?:es)?|imperial|deg\.? ?f)\b|[°º]F\b")
# 'speed in 1/s', 'dZ: mm'
_IN = re.compile(r"(?P<name>[^\W\d]\w*)(?: in |: ?)(?P<unit>[^\s,;]+)")
_LONGEST, _MOST = 80, 2
_PARTS = re.compile(r"[\s:;,=()\[\]'\"]+")
_WORDS = {
    "fahrenheit": "degF",
    "celsius": "degC",
    "kelvin": "K",
    "inch": "inch",
    "inches": "inch",
    "imperial": "inch",
} | dict.fromkeys(("microinch", "microinches"), "uin")


def units_said(above: Sequence[Sequence[str]], names: Sequence[str]) -> Mapping[str, str]:
    """Name of a column -> the lines that say units of it: those that name it, and those that name none. above: the
    cells of the lines above the names."""
    bare = {split_unit(name)[0].casefold(): name for name in names if name}
    found: dict[str, list[str]] = {}
    for cells in above:
        text = " ".join(filter(None, cells))
        told = _told_of(text, names)
        if not _UNITS.search(text) and not told:
            continue
        own = [bare[cell.casefold()] for cell in cells if cell.casefold() in bare]
        for name in own or (bare.values() if _UNITS.search(text) else told):
            found.setdefault(name, []).append(text[:_LONGEST])
    return {name: "', '".join(lines[:_MOST]) for name, lines in found.items()}


def _told_of(text: str, names: Sequence[str]) -> list[str]:
    """The columns of which a line says 'speed in 1/s', by any of their spellings."""
    said = {m["name"].casefold() for m in _IN.finditer(text) if unit_at(m["unit"]) is not None}
    return [name for name in names if name and said and not said.isdisjoint(spellings(name))]


def unit_of(line: str, name: str) -> str | None:
    """The unit that a line says of a signal, 'n in 1/s'; None where it says none."""
    own = spellings(name)
    found = (unit_at(m["unit"]) for m in _IN.finditer(line) if m["name"].casefold() in own)
    return next((u for u in found if u is not None), None)


def unit_at(text: str) -> str | None:
    """The unit that a word of a line is; None of one that a word is as well."""
    unit = _WORDS.get(text.casefold(), text)
    known = looks_like_unit(unit) or unit in _WORDS.values()
    return unit if known and not may_be_a_machine(text) and is_surely_unit(unit) else None


def units_in(line: str) -> frozenset[str]:
    """The units that such a line names, in one spelling."""
    parts = [p for p in _PARTS.split(line) if p]
    return frozenset(
        normal_unit(_WORDS.get(p.casefold(), p)) for p in parts if p.casefold() in _WORDS or looks_like_unit(p)
    )
