"""Factors and offsets that lines of a head state of columns, `Gain;1;0.1` or `dZ: 1 digit = 0.1 um`: properties of
their signals, never applied."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.cells.number import of_either_mark, to_bool
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.preamble.scale_words import FACTOR, OFFSET

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


def _named(text: str, names: Sequence[str]) -> Sequence[str]:
    """The columns that a text names; all but the first where it names none."""
    bare = {name: split_unit(name)[0].strip() for name in names if name}
    own = [n for n, b in bare.items() if b and re.search(rf"(?<!\w){re.escape(b)}(?!\w)", text)]
    return own or [n for n in names[1:] if n]
