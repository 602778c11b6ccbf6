"""What the value columns of a delimited text hold: numbers, integers beyond a float, booleans or text."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.reader.text import decimal_mark

# What instruments write where they have no value. Anything else that is no number is a loss with a name.
NOTHING = (
    "",
    "-",
    "--",
    "---",
    "----",
    "*",
    "***",
    "****",
    "?",
    "???",
    "n/a",
    "N/A",
    "n.a.",
    "#N/A",
    "#NV",
    "NULL",
    "null",
    "None",
    "NaN",
    "nan",
    "NAN",
    "-nan",
    "-NaN",
    "1.#QNAN",
    "-1.#IND",
    "1,#QNAN",
    "-1,#IND",
    "UNAVAILABLE",
)
_NOTHING = frozenset(NOTHING)
TRUE = ("TRUE", "True", "true", "WAHR", "Wahr", "wahr")
FALSE = ("FALSE", "False", "false", "FALSCH", "Falsch", "falsch")
_INTEGER = re.compile(r"^[+-]?\d{1,19}$")
_NUMBER = re.compile(
    r"^[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?$|^[+-]?inf(?:inity)?$"
    r"|^[+-]?\d{1,3}(?:[. ]\d{3})+,\d+$|^[+-]?\d{1,3}(?:[, ]\d{3})+\.\d+$",
    re.IGNORECASE,
)
_EXACT = 2**53
_FRACTIONS = 200  # numbers of a column that are asked for their decimal mark


@dataclass(frozen=True, slots=True)
class Column:
    """One value column: its place in the file, name, unit as written, and dtype (float64, int64, bool, str)."""

    place: int
    name: str
    unit: str | None
    dtype: str


def dtype_of(cells: Sequence[str], exact: bool) -> str:
    """The dtype of a column by sampled cells. exact: the cells are all that the file holds.

    Integers of a file that was only sampled stay float64, for a fraction may follow; those that a float64 would
    change are int64. A few words among numbers are defects, named where they are read.
    """
    full = [c for c in (cell.strip(' \t\r"') for cell in cells) if c not in _NOTHING]
    if not full:
        return "float64"
    if all(c in TRUE or c in FALSE for c in full):
        return "bool"
    numbers = sum(_NUMBER.match(c) is not None for c in full)
    words = len(full) - numbers
    if words > max(1 if len(full) >= 5 else 0, 0.02 * len(full)):
        return "str"
    if words == 0 and all(_INTEGER.match(c) for c in full) and all(abs(int(c)) < 2**63 for c in full):
        if any(abs(int(c)) > _EXACT for c in full):
            return "int64"
        return "int64" if exact and len(full) == len(cells) else "float64"
    return "float64"


def find_columns(
    names: Sequence[str], units: Sequence[str | None], rows: Sequence[Sequence[str]], times: Sequence[int], exact: bool
) -> tuple[tuple[Column, ...], str | None]:
    """The value columns, and the decimal mark (None where no sampled number has a fraction). A column without
    name and without a cell is none (rows that end with a delimiter). FormatError: both marks occur."""
    columns, numbers = [], []
    for place, (name, unit) in enumerate(zip(names, units, strict=True)):
        if place in times:
            continue
        cells = [r[place] for r in rows]
        if name.startswith("column ") and not any(c.strip() for c in cells):
            continue
        kind = dtype_of(cells, exact)
        if kind == "float64":
            numbers += [c for c in cells if "," in c or "." in c][:_FRACTIONS]
        columns.append(Column(place, name, unit, kind))
    return tuple(columns), decimal_mark(numbers)
