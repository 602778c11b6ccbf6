"""Names and units of a table's columns, from the rows above its data."""

from __future__ import annotations

import re

from thermodata.schema.quantity import _ALIAS

_BASE = (
    r"(?:[kMGmunµμcdh]?(?:m|g|s|A|V|W|K|N|Pa|Hz|J|C|F|bar|l|L|rad|Ohm|ohm|Ω|VA|Wh|mol|lm|lx|T)|min|h|d|rpm|RPM|"
    r"inch|deg|U|rev|mas|arcsec|ppm|RH|dB|psi|inc|imp|1|bit|counts?|digits?)"
)
_UNIT = re.compile(rf"^{_BASE}(?:\s?\^?-?[1-4]|[²³⁻¹]+)?(?:\s?[/*·.]\s?{_BASE}(?:\^?-?[1-4]|[²³⁻¹]+)?){{0,3}}$")
_TRAILING = re.compile(
    r"^(?P<name>.*?)(?P<gap>\s*)"
    r"(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*)\)|(?P<fullwidth>（[^（）]*）))$",
    re.DOTALL,
)


def looks_like_unit(text: str) -> bool:
    """Whether a text reads as a unit: an alias (U/min, Grd C, °C) or SI symbols with / * and powers."""
    bare = re.sub(r"\s+", "", text).strip("[]()")
    if not bare or bare.isdigit():
        return False
    return bare.casefold() in _ALIAS or _UNIT.match(text.strip()) is not None


def split_unit(header: str) -> tuple[str, str | None]:
    """(name, unit or None): 'ch3(um)' -> ('ch3', 'um'), 'Temp [degC]' -> ('Temp', 'degC').

    Brackets that hold no unit stay in the name: 'Excitation (Trigger)', 'nckServoData [u1; 1]', 'T[2]'.
    """
    header = header.strip()
    match = _TRAILING.match(header)
    if not match or not match["name"].strip():
        return header, None
    unit = (match["square"] or match["round"] or (match["fullwidth"] or "").strip("（）")).strip()
    if looks_like_unit(unit):
        return match["name"].strip(), unit
    # a word of its own in square brackets is a unit that we don't know; an index or an address is none
    if match["square"] and match["gap"] and re.match(r"^[^\W\d][^;,]{0,15}$", unit) and not re.match(r"^u\d", unit):
        return match["name"].strip(), unit
    return header, None
