"""Lines above the names that say units or scales, 'Units: INCH', '"Scaling","CH1-2","Ratio",100,"um"':
quoted where the unit of a column is asked, never taken."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.schema.units.quantity import normal_unit

HEAD = "head"  # property of a signal: what the head of its file says of units
_UNITS = re.compile(
    r"(?i)\b(?:fahrenheit|celsius|kelvin|inch(?:es)?|imperial|metric|deg\.? ?[fc]|units?|einheit(?:en)?|scal(?:e|ing)|"
    r"skalierung|ratio|gain)\b|[°º][FC]\b"
)
# what is no degree Celsius, millimetre or micrometre
OTHERS = re.compile(r"(?i)\b(?:fahrenheit|inch(?:es)?|imperial|deg\.? ?f)\b|[°º]F\b")
_LONGEST, _MOST = 80, 2
_PARTS = re.compile(r"[\s:;,=()\[\]'\"]+")
_WORDS = {"fahrenheit": "degF", "celsius": "degC", "kelvin": "K", "inch": "inch", "inches": "inch", "imperial": "inch"}


def units_said(above: Sequence[Sequence[str]], names: Sequence[str]) -> Mapping[str, str]:
    """Name of a column -> the lines that say units of it: those that name it, and those that name none. above: the
    cells of the lines above the names."""
    bare = {split_unit(name)[0].casefold(): name for name in names if name}
    found: dict[str, list[str]] = {}
    for cells in above:
        text = " ".join(filter(None, cells))
        if not _UNITS.search(text):
            continue
        own = [bare[cell.casefold()] for cell in cells if cell.casefold() in bare]
        for name in own or bare.values():
            found.setdefault(name, []).append(text[:_LONGEST])
    return {name: "', '".join(lines[:_MOST]) for name, lines in found.items()}


def units_in(line: str) -> frozenset[str]:
    """The units that such a line names, in one spelling."""
    parts = [p for p in _PARTS.split(line) if p]
    return frozenset(
        normal_unit(_WORDS.get(p.casefold(), p)) for p in parts if p.casefold() in _WORDS or looks_like_unit(p)
    )
