"""Factors and offsets that lines of a head state of columns, `Gain;1;0.1` or `dZ: 1 digit = 0.1 um`: properties of
their signals, never applied."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.cells.number import of_either_mark, to_bool
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.preamble.scale_words import FACTOR, OFFSET

SCALES_BELOW = 2  # rows of scales below the names, of which no time can be read
_COUNT = re.compile(
    r"(?i)\b(?P<key>1 ?(?:digit|count|lsb|bit|inkrement)) ?(?:=|≙|entspricht|is) ?"
    r"(?P<number>\d+(?:[.,]\d+)?(?:e[-+]?\d+)?)"
)


def scales_said(above: Sequence[Sequence[str]], names: Sequence[str]) -> Mapping[str, Mapping[str, str]]:
    """Name of a column -> what is stated of it: {'Gain': '0.1'}. above: the cells of the lines above the data, in their
    columns; names: of the columns, of which the first is that of the row of a factor's own name."""
    found: dict[str, dict[str, str]] = {}
    for cells in above:
        key = cells[0].strip().rstrip(":=").strip() if cells else ""
        # of several columns one number alone is of none of them, or of all
        of_columns = len(cells) > 2 or len(names) == 2
        if of_columns and (FACTOR.fullmatch(key) or OFFSET.fullmatch(key)):
            for name, text in zip(names[1:], cells[1:], strict=False):
                if name and to_bool(text) is None and of_either_mark(text) is not None:
                    found.setdefault(name, {})[key] = text
        elif count := _COUNT.search(text := " ".join(filter(None, cells))):
            for name in _named(text[: count.start()], names):
                found.setdefault(name, {})[re.sub(r"^1 ?", "1 ", count["key"])] = count["number"]
    return found


def is_row_of_scales(cells: Sequence[str]) -> bool:
    """Whether a row below the names holds factors or offsets of the columns: 'Scale;0.01;0.1'."""
    key = cells[0].strip().rstrip(":=").strip() if cells else ""
    stated = [c for c in cells[1:] if c.strip()]
    named = FACTOR.fullmatch(key) or OFFSET.fullmatch(key)
    return bool(named and stated) and all(of_either_mark(c.strip()) is not None for c in stated)


def lone_scales(above: Sequence[Sequence[str]], names: Sequence[str]) -> list[str]:
    """A note on each factor or offset that stands alone above several columns, and may be of one or of all."""
    if len(names) == 2:
        return []  # of the one beside the time
    notes = []
    for cells in above:
        stated = [c.strip() for c in cells[1:] if c.strip()]
        key = cells[0].strip().rstrip(":=").strip() if cells else ""
        number = of_either_mark(stated[0]) if len(stated) == 1 and len(cells) == 2 else None
        if FACTOR.fullmatch(key) and number is not None and number not in (0.0, 1.0):
            notes.append(
                f"a line above the rows says '{key} {stated[0]}', of which column is not told: nothing is scaled"
            )
    return notes


def _named(text: str, names: Sequence[str]) -> Sequence[str]:
    """The columns that a text names; all but the first where it names none."""
    bare = {name: split_unit(name)[0].strip() for name in names if name}
    own = [n for n, b in bare.items() if b and re.search(rf"(?<!\w){re.escape(b)}(?!\w)", text)]
    return own or [n for n in names[1:] if n]
