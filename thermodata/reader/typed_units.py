"""A column of typed tables (workbooks, Parquet) that says the unit of the one column of numbers beside it, row by row:
by the rules of text."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Array
from thermodata.reader.header_words import UNIT_SHORT, UNIT_WORDS
from thermodata.reader.interleaved import bare_header, words_of
from thermodata.reader.row_units import UnitColumn
from thermodata.reader.text.names.unit_column import unit_column, unit_column_note


def unit_in_rows(values: Mapping[str, Array], units: Mapping[str, str | None]) -> tuple[UnitColumn | None, str | None]:
    """(what says the unit of which column, a note). values: the first rows of each column, shape (n,); units: of those
    whose header or metadata say one."""
    bare = {name: v for name, v in values.items() if units.get(name) is None}
    kinds: dict[str, str | None] = {
        name: "str" if v.dtype.kind == "O" else "bool" if v.dtype.kind == "b" else "float64" for name, v in bare.items()
    }
    called = [n for n, kind in kinds.items() if kind == "str" and bare_header(n) in {*UNIT_WORDS, *UNIT_SHORT}]
    if not called:
        return None, None
    cells: dict[str, list[str]] = {n: words_of(n, bare[n]) if n in called else [] for n in kinds}
    found = unit_column(kinds, cells)
    return found, found.note() if found is not None else unit_column_note(kinds, cells)
