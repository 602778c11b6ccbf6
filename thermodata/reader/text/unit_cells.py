"""Cells that hold a unit beside their number ('23.5 °C'), as panels and dashboards show them: no numbers to read."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.cell import Cell
from thermodata.reader.text.header import looks_like_unit
from thermodata.reader.time_units import known_unit

_WITH_UNIT = re.compile(r"^[+-]?\d[\d.,]*\s?(?P<unit>[^\d\s].{0,7})$")


def refuse_units_in_cells(cells: Sequence[Cell], where: str, name: str = "") -> None:
    """FormatError where most cells of a table's values, its times left out, are such ones. name: the column that they
    are of, '' for all."""
    full = [str(c).strip() for c in cells if c not in ("", None)]
    shown = [c for c in full if (m := _WITH_UNIT.match(c)) and looks_like_unit(m["unit"])]
    if name:  # '10 sec' among others is a length of time
        shown = [c for c in shown if known_unit(c.lstrip("+-0123456789., ")) is None]
    if 2 * len(shown) > len(full):
        as_text = f"; or options: {{text: ['{name}']}} in the source, where they are words" if name else ""
        raise FormatError(
            "cells that hold their units beside their numbers",
            where=f"{where} column '{name}'" if name else where,
            expected="numbers, with their unit in the header",
            got=shown[0],
            hint=f"export the values without their units (raw values), or take these out of the cells{as_text}",
        )
