"""Names and units of a table's columns, from the rows above its data."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.reader.text import clean, looks_like_unit, split_unit

_TIME_NAME = re.compile(r"^(date|datum|time|uhrzeit|zeit|čas|cas|tag|timestamp|zeitstempel)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Header:
    """names, units: one a column of the file ('' where none). lines: the header's lines as they stand."""

    names: tuple[str, ...]
    units: tuple[str | None, ...]
    lines: tuple[str, ...]


def find_header(
    above: Sequence[Sequence[str]],
    lines: Sequence[str],
    width: int,
    times: set[int],
    table: Mapping[str, Any],
    skip: int,
) -> Header:
    """Names and units from the rows above the data: the units from the lowest row that reads as units, the
    names from the row above it; without units from the lowest row."""
    block: list[tuple[int, list[str]]] = []
    for k in range(len(above) - 1, -1, -1):
        cells = [clean(c) for c in above[k]]
        if not width - 1 <= len(cells) <= width + 1:
            break
        if block and 2 * sum(map(bool, cells)) < sum(map(bool, block[-1][1])):
            break  # a preamble that a spreadsheet padded with empty cells
        block.append((k, cells))
    units: list[str] | None = None
    if table.get("units_row") is not None:
        row = int(table["units_row"]) - 1 - skip
        units = [clean(c) for c in above[row]] if 0 <= row < len(above) else None
        block = [(k, cells) for k, cells in block if k < row] or [b for b in block if b[0] != row]
    elif len(block) > 1:
        for place, (_, cells) in enumerate(block[:-1]):
            if _are_units(cells, times):
                units, block = cells, block[place + 1 :]
                break
    names = next((cells for _, cells in block if _are_names(cells, times)), block[0][1] if block else [])
    names = [names[c] if c < len(names) else "" for c in range(width)]
    found: list[str | None] = []
    for c, name in enumerate(names):
        own = units[c].strip("[]() ") if units is not None and c < len(units) else ""
        found.append(own or (None if own else split_unit(name)[1]))
    return Header(_unique(names), tuple(found), tuple(line for line in lines if line.strip()))


def _are_units(cells: Sequence[str], times: set[int]) -> bool:
    if any(_TIME_NAME.match(cells[c]) for c in times if c < len(cells)):
        return False
    full = [c for k, c in enumerate(cells) if c and k not in times]
    good = sum(looks_like_unit(c) or bool(re.fullmatch(r"\[.*\]|\(.*\)|-|1", c)) for c in full)
    return good >= 0.5 * len(full)  # a row of blanks under the names too


def _are_names(cells: Sequence[str], times: set[int]) -> bool:
    """Whether most columns have a word: rows of limits (numbers, or nothing) stand below the names in some exports."""
    said = [c for k, c in enumerate(cells) if k not in times]
    words = sum(bool(c) and not re.fullmatch(r"[+-]?[\d.,]+", c) for c in said)
    return 2 * words > len(said)


def _unique(names: Sequence[str]) -> tuple[str, ...]:
    """Names that repeat get '#2'; those that are missing 'column 3'."""
    seen: Counter[str] = Counter()
    result = []
    for c, name in enumerate(names):
        name = name or f"column {c + 1}"
        seen[name] += 1
        result.append(name if seen[name] == 1 else f"{name}#{seen[name]}")
    return tuple(result)
