"""A date in columns of its own: `Year;Month;Day;Hour;Minute;Second`, or `Jahr;Monat;Tag;Uhrzeit`.

The parts of a row are joined to one text and read as one time. A format of strptime's letters, one a column, says the
same where the columns are named otherwise: `table: {time: {column: [1, 2, 3, 4, 5], format: '%Y %m %d %H %M'}}`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.text.cells.cell import Cell, is_clocked, mostly, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.time_forms.clock_pattern import HALF
from thermodata.reader.text.cells.time_forms.time_pattern import MILLISECONDS, TIME_OF_DAY, TimeFormat
from thermodata.reader.text.cells.values.arrow import text_array
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.several_cells.clock_numbers import days_of_years
from thermodata.reader.text.times.several_cells.gps_weeks import reads_weeks
from thermodata.reader.times.zone import NAT

_WORDS = {
    "Y": "year years jahr rok année annee anno año ano yyyy yy yr",
    "m": "month monat měsíc mesic mois mese mes mon mm mo",
    "d": "day tag den jour giorno día dia dd dy",
    "H": "hour hours stunde stunden std hodina heure ora hora hh hr",
    "M": "minute minutes minuten minuta min mm mi mn",
    "S": "second seconds sekunde sekunden sekunda vteřina seconde secondo segundo sec sek ss",
}
_LETTERS = {letter: set(words.split()) for letter, words in _WORDS.items()}
_RANGE = {"Y": (1900, 2200), "y": (0, 99), "m": (1, 12), "d": (1, 31), "H": (0, 23), "M": (0, 59), "S": (0, 61)}
_RANGE |= {"whole S": _RANGE["S"], "ms": (0, 999)}
_WHOLE = r"(?:[.,]0*)?"  # a program that keeps all numbers as floats writes 2026.000
_PIECES = {
    "Y": rf"(?P<Y>\d{{4}}){_WHOLE}",
    "y": rf"(?P<y>\d{{2}}){_WHOLE}",
    "S": r"(?P<S>\d{1,2})(?:[.,](?P<f>\d{1,9})\d*)?",
    **{letter: rf"(?P<{letter}>\d{{1,2}}){_WHOLE}" for letter in "mdHM"},
}
_TEXTS = {"Y": "year", "y": "year", "m": "month", "d": "day", "H": "hour", "M": "minute", "S": "second"}
_ORDER = "YmdHMS"
_MINUTE, _HOUR = 60_000_000_000, 3_600_000_000_000  # ns
_WHOLE_CLOCK = re.compile(rf"^\s*\d{{1,2}}:\d\d:\d\d\s*({HALF})?\s*$", re.ASCII)
PART = TimeFormat("part", None, "")  # of a time whose first column has the format of all of them


def find_parts(seen: FirstRows) -> tuple[tuple[int, ...], str] | None:
    """(columns, format) of a date in columns that are named for its parts, with hours or a time of day beside them;
    None where there is none. Of parts without seconds, a time of day beside them that says the same hours and minutes
    comes before these. It and a column of milliseconds behind whole seconds are not part of the format."""
    found: dict[str, int] = {}
    for i, name in enumerate(seen.names):
        word = split_unit(re.sub(r"#\d+$", "", name))[0].strip(" #.:_").casefold()
        # the first "mm" is a month, the second one a minute
        letter = next((x for x in _ORDER if word in _LETTERS[x] and x not in found), None)
        if letter is not None:
            found[letter] = i
    if not {"Y", "m", "d"} <= found.keys():
        return None
    parts = [x for x in _ORDER if x in found]
    parts = parts[: next((k for k, x in enumerate(parts) if x != _ORDER[k]), len(parts))]
    year = [number_of(r[found["Y"]]) for r in seen.rows]
    short = mostly(year, lambda v: v is not None and v < 100, 0.8, len(year))
    letters = [("y" if short else "Y") if x == "Y" else x for x in parts]
    if not all(_fits(seen.column(found[x]), letter) for x, letter in zip(parts, letters, strict=True)):
        return None
    columns = tuple(found[x] for x in parts)
    if "S" not in parts:
        others = [i for i in range(len(seen.names)) if i not in columns and _share(seen.rows, i, is_clocked)]
        clocks = [i for i in others if _agree(i, columns[3:], seen.rows)]
        if clocks:
            columns, letters = (*columns[:3], clocks[0]), letters[:3]
        elif "H" not in parts:
            return None
    if _whole_seconds(columns[-1], "S" in parts, seen.rows) and columns[-1] + 1 < len(seen.names):
        behind = columns[-1] + 1
        if MILLISECONDS.match(seen.names[behind]) and _fits(seen.column(behind), "ms"):
            columns = (*columns, behind)
    return columns, " ".join(f"%{letter}" for letter in letters)


def _agree(clock: int, parts: Sequence[int], data: Sequence[Sequence[Cell]]) -> bool:
    """Whether a time of day says of nearly all rows what the columns of hours and minutes say; of none, always. One
    that many rows lack would lose their time."""
    rows = [r for r in data if all(r[i] not in ("", None) for i in parts)]

    def agrees(row: Sequence[Cell]) -> bool:
        ns = _clock_ns(row[clock])
        said = () if ns is None else (ns // _HOUR, ns // _MINUTE % 60)[: len(parts)]
        return ns is not None and all(number_of(row[i]) == own for i, own in zip(parts, said, strict=True))

    return not parts or mostly(rows, agrees, 0.8, len(rows))


def _clock_ns(cell: Cell) -> int | None:
    """The time of day of a cell [ns]; None where it holds none."""
    ns = timestamp.parse_one(str(cell).strip(), TIME_OF_DAY)
    return None if ns == NAT else ns


def _whole_seconds(column: int, number: bool, data: Sequence[Sequence[Cell]]) -> bool:
    """Whether a column of seconds (number), or of times of day with seconds, has no fractions of them."""
    if number:
        return _fits([r[column] for r in data], "whole S")
    cells = [str(r[column]) for r in data if r[column] not in ("", None)]
    return bool(cells) and mostly(cells, lambda c: _WHOLE_CLOCK.match(c) is not None, 0.8, len(cells))


def _fits(cells: Sequence[Cell], letter: str) -> bool:
    low, high = _RANGE[letter]
    whole = letter != "S"  # seconds may have a fraction

    def fits(cell: Cell) -> bool:
        value = number_of(cell) if not isinstance(cell, bool) else None
        return value is not None and low <= value <= high and not (whole and value % 1)

    filled = [c for c in cells if c not in ("", None)]
    return bool(filled) and mostly(filled, fits, 0.8, len(filled))


def _share(data: Sequence[Sequence[Cell]], column: int, test: Any) -> bool:
    cells = [r[column] for r in data if r[column] not in ("", None)]
    return bool(cells) and mostly(cells, test, 0.8, len(cells))


def declared_parts(declared: str | None, columns: int) -> tuple[TimeFormat, ...]:
    """The formats of the columns of a date in parts: that of all parts, and `PART` for the others; () where a declared
    format is none of parts, or has more of them than there are columns."""
    pieces = (declared or "").split()
    if len(pieces) == columns > 1:
        weeks = reads_weeks(pieces)  # which are in UTC
        reads = weeks or days_of_years(pieces)
    else:
        weeks = reads = None
    if reads is not None:
        text = f"{declared} in {columns} columns"
        form = TimeFormat("datetime", None, text, zoned=weeks is not None, columns=columns, reads=reads)
        return (form, *[PART] * (columns - 1))
    letters = [p[1:] for p in pieces if p[:1] == "%" and p[1:] in _PIECES]
    if len(letters) != len(pieces) or len(pieces) < 3 or len(pieces) > columns or columns == 1:
        return ()
    text = f"{', '.join(_TEXTS[x] for x in letters)} in {len(letters)} columns"
    body = " ".join(_PIECES[x] for x in letters)
    form = replace(time_pattern.declared_format(" ".join(pieces)), text=text, zoned=False, columns=len(letters))
    return (replace(form, pattern=re.compile(body, re.ASCII)), *[PART] * (len(letters) - 1))


def column_times(columns: Sequence[Any], forms: Sequence[TimeFormat]) -> Int1D:
    """The times of rows [ns], shape (n,): the sum of their columns, parts joined; NAT where one holds none.

    columns: of each format its cells, an Arrow string array or a list."""
    total, bad = np.zeros(len(columns[0]), np.int64), np.zeros(len(columns[0]), bool)
    for k, form in enumerate(forms):
        if form.role == PART.role:
            continue
        cells = columns[k] if form.columns == 1 else joined(columns[k : k + form.columns])
        part = timestamp.parse(cells, form)
        bad |= part == NAT
        total += np.where(bad, 0, part)
    return np.where(bad, NAT, total)


def row_time(cells: Sequence[str], forms: Sequence[TimeFormat]) -> int:
    """The same of one row."""
    total = 0
    for k, form in enumerate(forms):
        if form.role != PART.role:
            own = cells[k : k + form.columns]
            part = timestamp.parse_one(" ".join(c.strip() for c in own) if len(own) > 1 else own[0], form)
            if part == NAT:
                return NAT
            total += part
    return total


def joined(columns: Sequence[Any]) -> Any:
    """One text a row, of its cells with a blank between them."""
    import pyarrow.compute as pc

    texts = [text_array(c) if isinstance(c, list) else c for c in columns]
    return pc.binary_join_element_wise(*(pc.utf8_trim_whitespace(t.cast("string")) for t in texts), " ")
