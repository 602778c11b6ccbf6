"""A decimal mark that the numbers of a file tell though both marks occur: '22,04' beside '3.000' and '-690'."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from thermodata.reader.text.cells.values.number import spelled
from thermodata.reader.text.cells.values.quotes import clean

_SHORT, _LONG = re.compile(r"[+-]?[1-9]\d{0,2}", re.ASCII), re.compile(r"[+-]?\d{4,}(?:[.,]\d*)?", re.ASCII)
# of no thousands: not three digits behind the mark, or a zero before it
_FRACTION = {m: re.compile(rf"[+-]?(?:\d+{re.escape(m)}(?!\d{{3}}$)\d+|0{re.escape(m)}\d+)", re.ASCII) for m in ".,"}
_GROUPED = {
    m: re.compile(rf"[+-]?[1-9]\d{{0,2}}(?:{re.escape(o)}\d{{3}})+(?:{re.escape(m)}\d*)?", re.ASCII)
    for m, o in ((".", ","), (",", "."))
}
_DIFFER = 3  # numbers of either kind, by which columns show how they are written


@dataclass(frozen=True, slots=True)
class ToldMark:
    """decimal: the mark; note: by what."""

    decimal: str
    note: str


def told_thousands(columns: Iterable[Sequence[str]]) -> ToldMark | None:
    """The decimal mark where one of both begins fractions that are no thousands, and the other parts thousands wherever
    it stands: in groups of three digits only, in columns that write what is below a thousand without it and nothing
    above, several numbers of either kind. None where one of this is lacking: numbers may be written in two ways.
    columns: cells of numbers.
    """
    cells = [[spelled(clean(c)) for c in column] for column in columns]
    for mark, other in ((",", "."), (".", ",")):
        begins = next((c for column in cells for c in column if _FRACTION[mark].fullmatch(c)), None)
        parted = [column for column in cells if any(other in c for c in column)]
        groups = [c for column in parted for c in column if other in c]
        if begins is None or not groups or not all(map(_GROUPED[mark].fullmatch, groups)):
            continue
        if any(_LONG.fullmatch(c) for column in parted for c in column):
            continue
        # else three digits behind the mark may be a fixed format, and a few odd cells are no way to write numbers
        if len(set(groups)) < _DIFFER or len({c for column in parted for c in column if _SHORT.fullmatch(c)}) < _DIFFER:
            continue
        return ToldMark(mark, f"'{other}' parts thousands ('{groups[0]}'), for '{mark}' begins fractions ('{begins}')")
    return None
