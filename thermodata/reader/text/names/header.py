"""What a header cell says: a name, a unit, the number of a row. Which rows are a header: `header_rows`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

from thermodata.schema.units.scale import scaled_unit
from thermodata.schema.units.signs import bare_unit, plain_letters
from thermodata.schema.units.spelling import spelled
from thermodata.schema.words.numbered import numbered

_BASE = (
    r"(?:[kMGmunµμcdh]?(?:m|g|s|A|V|W|K|N|Pa|Hz|J|C|F|bar|l|L|rad|Ohm|ohm|Ω|VA|Wh|mol|lm|lx|T)|min|h|d|rpm|RPM|"
    r"inch|[uµμ]in|thou|deg|N[cm]m|[°º]R|U|rev|mas|arcsec|ppm|RH|dB|psi|inc|imp|1|bit|counts?|digits?)"
)
_UNIT = re.compile(rf"^{_BASE}(?:\s?\^?-?[1-4]|[²³⁻¹]+)?(?:\s?[/*·.]\s?{_BASE}(?:\^?-?[1-4]|[²³⁻¹]+)?){{0,3}}$")
# what counts by the time, in units that are words as well where they stand alone
_RATE = re.compile(r"^(?:in|inch|ft|gal|cc|[°º][CF]?)\s?/\s?(?:s|sec|min|h)$")
# what holds a sign of degrees or per cent is a unit, known or not: '0.05 °C', '%FS', '"'; '%MW100' is an address
_HAS_SIGN = re.compile(r"^(?!%[IQM][XBWDL]?\d)(?:[^;\[\]]{0,12}[°º˚%‰][^;\[\]]{0,12}|[\"″])$")
# '°C*10', 'x1000 rpm', 'µm ×0,1': a unit and a factor whose sense (of the unit, or of the value) only the lab knows
_TIMES_TEN = re.compile(r"\s*[*·×x]\s*(?:10+|0[.,]\d{1,6})$|^[*·×x]\s*10+\s*")
# '°C [bed]', 'µm (Z)': the unit first, and in the brackets what it is of; other units are names as well: 'V [left]'
_UNIT_FIRST = re.compile(
    r"^(?P<unit>(?:[°º˚]|deg) ?[CF]|[uµμ]m)\s*(?:\[(?=[^\[\]]*\]$)|\((?=[^()]*\)$))(?P<name>[^\W\d_].*).$"
)
_WORDS = ("HP", "CV", "OC")  # in round brackets: high pressure, a controlled value, an overcurrent
_TRAILING = re.compile(
    r"^(?P<name>.*?)(?P<gap>\s*)"
    r"(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*(?:\([ag]\))?)\)|(?P<fullwidth>（[^（）]*）|［[^［］]*］))$",
    re.DOTALL,
)


@lru_cache(maxsize=4096)
def looks_like_unit(text: str) -> bool:
    """Whether a text reads as a unit: an alias (U/min, Grd C, °C) or SI symbols with / * and powers."""
    unit = scaled_unit(text)[1].strip()
    bare = bare_unit(unit)
    if not bare or bare.isdigit():
        return False
    plain = plain_letters(unit)
    return spelled(unit) is not None or any(p.match(plain) is not None for p in (_UNIT, _RATE))


@lru_cache(maxsize=4096)
def split_unit(header: str) -> tuple[str, str | None]:
    """(name, unit or None): 'ch3(um)' -> ('ch3', 'um'), 'Temp [degC]' -> ('Temp', 'degC').

    Brackets that hold no unit stay in the name: 'Excitation (Trigger)', 'nckServoData [u1; 1]', 'T[2]'. Where loggers
    write a unit elsewhere, see `_unit_within`.
    """
    header = header.strip()
    first = _UNIT_FIRST.match(header)
    if first is not None and not looks_like_unit(first["name"]):
        return first["name"].strip(), first["unit"]
    found = _unit_at_end(header)
    return found if found[1] is not None else _unit_within(header)


def _unit_at_end(header: str) -> tuple[str, str | None]:
    match = _TRAILING.match(header)
    if not match or not match["name"].strip():
        return header, None
    unit = (match["square"] or match["round"] or (match["fullwidth"] or "").strip("（）［］")).strip()
    if looks_like_unit(unit) and match["round"] not in _WORDS:
        return match["name"].strip(), unit
    bare = _TIMES_TEN.sub("", unit)
    if bare != unit and looks_like_unit(bare):
        return match["name"].strip(), unit
    # a word of its own in square brackets is a unit that we don't know; an index or an address is none
    if match["square"] and match["gap"] and re.match(r"^[^\W\d][^;,]{0,15}$", unit) and not re.match(r"^u\d", unit):
        return match["name"].strip(), unit
    if match["square"] and _HAS_SIGN.match(unit):
        return match["name"].strip(), unit
    return header, None


# 'Temp, °C (LGR S/N: 1, LBL: hall)': a unit behind a comma, and numbers of devices
_DEVICE = re.compile(r"\s*\((?P<device>[^()]*\bS/N\b[^()]*)\)$")
_LABEL = re.compile(r"\bLBL: *(?P<label>[^,]+)")
# '101 (C)- T_front', '101 <front> (C)', 'M00: °C': a unit behind the number of a channel
_OF_CHANNEL = re.compile(
    r"^(?:(?P<number>\d{1,4}) \((?P<round>[^()]+)\)[ -]*(?P<name>.+)|(?P<code>[A-Za-z]{0,3}\d{1,4}): *(?P<unit>\S.*))$"
)
_SQUARE = re.compile(
    r"^(?P<before>[^\[\]]*[^\[\]\s])\s*\[(?P<unit>[^\[\]]{2,})\](?:\s+|(?=\(\d{1,4}\)$))(?P<behind>[^\[\]]+)$"
)


def _unit_within(header: str) -> tuple[str, str | None]:
    """The same of a header with its unit elsewhere than at its end: 'Kanal 1 [°C] vorn' -> ('Kanal 1 vorn', '°C').
    A letter alone may be an axis, so it is a unit behind the number of a channel only."""
    device = _DEVICE.search(header)
    if device is not None:
        name, _, unit = header[: device.start()].rpartition(", ")
        label = _LABEL.search(device["device"])
        behind = f" {label['label'].strip()}" if label else ""
        if name and looks_like_unit(unit):
            return name + behind, unit
        return header[: device.start()] + behind, None
    match = _OF_CHANNEL.match(header)
    if match is not None:
        unit = match["round"] or match["unit"]
        if looks_like_unit(unit) and (match["round"] or len(unit) > 1 or unit == "V"):
            return f"{match['number']} {match['name']}" if match["number"] else match["code"], unit
    match = _SQUARE.match(header)
    if match is not None and looks_like_unit(match["unit"]):
        return f"{match['before']} {match['behind']}", match["unit"].strip()
    return header, None


def told_alike(cells: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """A row of names or units in one spelling of its units: '[µm]' as 'um', 'T (°C)' as 'T [degC]'. What is the same
    so, says the same of the columns below it."""
    filled = len(cells)
    while filled and not cells[filled - 1].strip():
        filled -= 1
    return tuple(map(_name_and_unit, cells[:filled]))


def _name_and_unit(cell: str) -> tuple[str, str]:
    """(name, unit) of one cell, '' for none."""
    alone = cell.strip("[]() ")
    name, unit = ("", alone) if looks_like_unit(alone) else split_unit(cell)
    return name, (spelled(unit) or unit) if unit else ""


def unique(names: Sequence[str]) -> list[str]:
    """The names, those that repeat numbered (#2, #3, ...), and a column without one called by its place."""
    out: list[str] = []
    taken: set[str] = set()
    for i, name in enumerate(names):
        new = numbered(name or f"column {i + 1}", taken.__contains__)
        taken.add(new)
        out.append(new)
    return out
