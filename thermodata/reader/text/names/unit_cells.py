"""Cells that hold a unit beside their number ('23.5 °C'), as panels and dashboards show them: no numbers to read."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.cells.cell import Cell
from thermodata.reader.text.names.header import looks_like_unit
from thermodata.reader.times.time_units import known_unit

_WITH_UNIT = re.compile(r"^(?P<number>[+-]?\d[\d.,]*)\s?(?P<unit>[^\d\s].{0,7})$")
_NEARLY_ALL = 0.9  # of a column's cells
_MANY = 8  # numbers that differ: words such as '0T', '1T', '100%', 'T 10 mm' are fewer


def refuse_units_in_cells(cells: Sequence[Cell], where: str) -> None:
    """FormatError where most cells of a table's values, its times left out, are such ones."""
    full = [str(c).strip() for c in cells if c not in ("", None)]
    shown = [c for c in full if (m := _WITH_UNIT.match(c)) and looks_like_unit(m["unit"])]
    if 2 * len(shown) > len(full):
        raise FormatError(
            "cells that hold their units beside their numbers",
            where=where,
            expected="numbers, with their unit in the header",
            got=shown[0],
            hint="export the values without their units (raw values), or take these out of the cells: "
            f"{_taken_out(shown)}, and write the unit behind the name: 'T [degC]'",
        )


def _taken_out(cells: Sequence[str]) -> str:
    """A command that takes the units out of a text."""
    units = dict.fromkeys(m["unit"].strip() for c in cells if (m := _WITH_UNIT.match(c)))
    return f"sed -E 's#([0-9]) ?({'|'.join(map(re.escape, units))})#\\1#g' FILE > plain.csv"


def unit_note(cells: Sequence[Cell], name: str) -> str | None:
    """What is told of a column of words, nearly all of which are numbers with one unit; None of others."""
    full = [str(c).strip() for c in cells if c not in ("", None)]
    found = [m for c in full if (m := _WITH_UNIT.match(c))]
    if not full or len(found) < _NEARLY_ALL * len(full):
        return None
    ((unit, many),) = Counter(m["unit"].strip() for m in found).most_common(1)
    numbers = {m["number"] for m in found if m["unit"].strip() == unit}
    if many < _NEARLY_ALL * len(full) or len(numbers) <= _MANY or not looks_like_unit(unit):
        return None
    if known_unit(unit) is not None:  # '10 sec' is a length of time
        return None
    return (
        f"column '{name}' is read as words, for its cells hold their unit beside their numbers ('{full[0]}'): "
        f"export the values without '{unit}', or take it out: {_taken_out(full)}; or options: {{text: ['{name}']}} in "
        "the source where they are words"
    )
