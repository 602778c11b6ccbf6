"""Factors and offsets that lines of a head state of columns, `Gain;1;0.1` or `dZ: 1 digit = 0.1 um`: properties of
their signals, never applied."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.cells.values.number import of_either_mark, to_bool
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.text.preamble.scale_words import FACTOR, OFFSET, spellings
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.unit import is_unit

SCALES_BELOW = 2  # rows of scales below the names, of which no time can be read
_NUMBER = r"(?P<number>\d+(?:[.,]\d+)?(?:e[-+]?\d+)?)"
_ONE = r"(?:digit|count|lsb|bit|inkrement|increment)"
_UNIT = r"(?P<unit>[°º%µμ]?[^\W\d_]+)"
# '1 digit = 0.1 um', 'counts of 0.02 um', '0.02 um/count'
_COUNTS = (
    re.compile(rf"(?i)\b(?P<key>1 ?{_ONE}) ?(?:=|≙|entspricht|is) ?{_NUMBER}(?: ?{_UNIT})?"),
    re.compile(rf"(?i)\b(?P<key>(?!bit){_ONE}(?:e?s|e)?) ?(?:[:=≙]|of|à|zu|je|entsprechen|are)? ?{_NUMBER} ?{_UNIT}"),
    re.compile(rf"(?i)(?<![\w.,]){_NUMBER} ?{_UNIT} ?(?:/|per|pro|par|je) ?(?P<key>{_ONE})\b"),
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
        elif count := _count_in(text := " ".join(filter(None, cells))):
            for name in _columns_scaled(text[: count.start()], names, count["unit"]):
                found.setdefault(name, {})[f"1 {_singular(count['key'])}"] = count["number"]
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


def _count_in(text: str) -> re.Match[str] | None:
    """Where a line says what one count is; what is counted by a number alone needs a unit that is one."""
    for pattern in _COUNTS:
        count = pattern.search(text)
        if count is not None and (pattern is _COUNTS[0] or _measures(count["unit"])):
            return count
    return None


def _measures(unit: str) -> bool:
    return is_unit(unit) and not converts(unit, "s")


def _singular(key: str) -> str:
    """'counts' -> 'count', '1digit' -> 'digit', 'increments' -> 'inkrement'."""
    return re.sub(r"(?i)^1 ?|(?<=[a-z])e?s?$", "", key).replace("ncrement", "nkrement")


def _columns_scaled(text: str, names: Sequence[str], unit: str | None) -> Sequence[str]:
    """The columns that a text names; where it names none, those in such a unit, or else those in none; all but the
    first, of the time, where no unit is said."""
    folded = text.casefold()
    own = [n for n in names if n and any(_holds_word(folded, said) for said in spellings(n))]
    if own:
        return own
    told = {n: _unit_of(n) for n in names[1:] if n}
    if unit is None or not is_unit(unit):
        return list(told)
    return [n for n, u in told.items() if u and converts(unit, u)] or [n for n, u in told.items() if u is None]


def _holds_word(text: str, said: str) -> bool:
    return bool(said) and re.search(rf"(?<!\w){re.escape(said)}(?!\w)", text) is not None


def _unit_of(name: str) -> str | None:
    """The unit of a column by its name: 'dZ [um]', 'dZ_um'."""
    bare, unit = split_unit(name)
    end = bare.rpartition("_")[2]
    return unit or (end if "_" in bare and looks_like_unit(end) and is_unit(end) else None)
