"""Lines above the names that say units or scales, 'Units: INCH', '"Scaling","CH1-2","Ratio",100,"um"':
quoted where the unit of a column is asked, never taken."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.names.header import split_unit

HEAD = "head"  # property of a signal: what the head of its file says of units
_UNITS = re.compile(
    r"(?i)\b(?:fahrenheit|celsius|kelvin|inch(?:es)?|imperial|metric|deg\.? ?[fc]|units?|einheit(?:en)?|scal(?:e|ing)|"
    r"skalierung|ratio|gain)\b|[°º][FC]\b"
)
# what is no degree Celsius, millimetre or micrometre
OTHERS = re.compile(r"(?i)\b(?:fahrenheit|inch(?:es)?|imperial|deg\.? ?f)\b|[°º]F\b")
_LONGEST, _MOST = 80, 2


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
