"""How a table lies on its page: preamble, header rows, units, time columns. Declared, or found in its first rows."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.errors import FormatError, UsageError, nearest
from thermodata.reader.text import clean, looks_like_unit, split_unit
from thermodata_reader_table.clocks import EPOCHS, SECONDS, check_unit, found_epoch
from thermodata_reader_table.stamps import is_date, is_time_of_day

Cell = Any   # text, or what a workbook holds: numbers, bool, datetime, date, time
# "t" is a time, "T" a temperature
_TIME_WORDS = re.compile(
    r"^(t|(?i:time|zeit|čas|cas|temps|tiempo|tempo|datum|date|dátum|uhrzeit|timestamp|date[ _]?time|datetime|"
    r"zeitstempel|elapsed([ _]?time)?|時間|时间|日時|日期|時刻|rel(ative)?[ _.]?time|t_s|time_s))\.?:?$")
_NUMBER = re.compile(r"^[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?$")
_WORDS = {"nan", "inf", "-inf", "true", "false", "---", "-", "n/a", "#n/a", "null", ""}


@dataclass(frozen=True)
class Layout:
    """first: rows before the data (preamble, header, units). names: header of each column as in the file, without
    blanks around it. time: columns, from 0. seconds: of one unit of a relative time; None for dates."""

    first: int
    names: tuple[str, ...]
    units: tuple[str | None, ...]
    time: tuple[int, ...]
    seconds: float | None
    form: str | None
    notes: tuple[str, ...] = ()
    epoch: str | None = None           # of times counted from a date (clocks.EPOCHS); seconds is None then


def is_number(cell: Cell) -> bool:
    if isinstance(cell, str):
        return _NUMBER.match(cell.strip()) is not None
    return isinstance(cell, int | float)


def _is_stamp(cell: Cell) -> bool:
    if isinstance(cell, str):
        return is_date(cell) or is_time_of_day(cell)
    return not isinstance(cell, int | float) and hasattr(cell, "isoformat")


def _is_data(row: Sequence[Cell], width: int) -> bool:
    """Numbers or dates in a third of the filled cells, and as many cells as the table has, or one fewer."""
    filled = [c for c in row if not (isinstance(c, str) and c.strip().lower() in _WORDS) and c is not None]
    values = sum(is_number(c) or _is_stamp(c) for c in filled)
    return values >= 1 and values * 3 >= len(filled) and len(row) >= width - 1 and (len(filled) > 1 or width <= 2)


def find(rows: Sequence[Sequence[Cell]], declared: Mapping[str, Any] | None, where: str) -> Layout:
    """The layout of a table from its first rows (some hundred suffice). declared: the campaign file's `table`.

    FormatError where no data, or no time column, can be found.
    """
    said = {k: v for k, v in (declared or {}).items() if v is not None}
    skip = int(said.get("skip_rows", 0))
    body = list(rows[skip:])
    width = _width(body)
    body = [r[:width] for r in body]
    header = said.get("header_rows")
    first = skip + int(header) if header is not None else _first_data(body, width, where) + skip
    units_row = said.get("units_row")
    if units_row is not None and header is not None and int(units_row) > first:
        first = int(units_row)
    row_of_units = None if units_row is None else int(units_row) - 1 - skip
    heads, units = _heads([r[:width] for r in rows[skip:first]], width, row_of_units)
    names = unique(heads)
    data = [list(r[:width]) + [""] * (width - len(r)) for r in rows[first:first + 200]]
    if not data:
        raise FormatError("a table without data rows", where=where, expected=f"data after row {first}")
    lost = _between(rows[skip:first], width, skip) if header is None else []
    time, unit, form, notes = _time(said.get("time") or {}, names, units, data, where)
    epoch = unit if unit in EPOCHS else None
    return Layout(first, tuple(names), tuple(units), time, None if unit is None else SECONDS.get(unit), form,
                  (*notes, *lost), epoch)


def _between(rows: Sequence[Sequence[Cell]], width: int, skip: int) -> list[str]:
    """A note for lines between the header and the data that are part of neither."""
    filled = [sum(c not in ("", None) for c in r[:width]) for r in rows]
    spanning = [i for i, n in enumerate(filled) if n * 2 > width]
    odd = [i + skip + 1 for i in range(spanning[-1] + 1, len(rows)) if filled[i]] if spanning else []
    return [f"line {odd[0]} between header and data is not read ({len(odd)} such)"] if odd else []


def _width(body: Sequence[Sequence[Cell]]) -> int:
    """Cells of most rows of the second half, where preamble is rare; the larger of two that are as frequent."""
    lengths = [len(r) for r in body[len(body) // 2:] if any(c not in ("", None) for c in r)]
    return max(set(lengths), key=lambda n: (lengths.count(n), n), default=0)


def _first_data(body: Sequence[Sequence[Cell]], width: int, where: str) -> int:
    for i, row in enumerate(body):
        following = [r for r in body[i + 1:i + 11] if any(c not in ("", None) for c in r)]
        if _is_data(row, width) and sum(_is_data(r, width) for r in following) * 2 >= len(following):
            return i
    raise FormatError("no data rows found", where=where, expected="rows of numbers and times",
                      hint="declare table: {header_rows: ..., skip_rows: ...}")


def _heads(rows: Sequence[Sequence[Cell]], width: int, units_row: int | None) -> tuple[list[str], list[str | None]]:
    """Names and units from the rows before the data; rows that do not span the table are preamble."""
    texts = [[clean(str(c)) if c is not None else "" for c in r] + [""] * (width - len(r)) for r in rows]
    units: list[str | None] = [None] * width
    if units_row is not None and 0 <= units_row < len(texts):
        units = [u.strip("[]() ") or None for u in texts.pop(units_row)]
    spanning = [r for r in texts if sum(map(bool, r)) * 2 > width or len(texts) == 1]
    if units_row is None and len(spanning) >= 2:
        filled = [c for c in spanning[-1] if c]
        if sum(looks_like_unit(c) or c.startswith("[") for c in filled) * 2 > len(filled):
            units = [u.strip("[]() ") or None for u in spanning.pop()]
    names = spanning[-1] if spanning else [""] * width
    if len(spanning) >= 2:
        # two rows of names: the group above is written once, over the first of its columns
        above, group = [], ""
        for cell in spanning[-2]:
            group = cell or group
            above.append(group)
        if len(set(names)) < len(names):
            names = [f"{a}/{n}" if a and n and a != n else n or a for a, n in zip(above, names, strict=True)]
    found = [split_unit(n)[1] for n in names]
    return names, [u or f for u, f in zip(units, found, strict=True)]


def unique(names: Sequence[str]) -> list[str]:
    out: list[str] = []
    for i, name in enumerate(names):
        base = name or f"column {i + 1}"
        new, k = base, 2
        while new in out:
            new, k = f"{base}#{k}", k + 1
        out.append(new)
    return out


def column(wanted: int | str, names: Sequence[str], where: str) -> int:
    if isinstance(wanted, int):
        if not 1 <= wanted <= len(names):
            raise FormatError(f"no column {wanted}", where=where, expected=f"1 to {len(names)}", got=str(wanted))
        return wanted - 1
    for fold in (str, str.casefold):
        hits = [i for i, n in enumerate(names) if fold(wanted) in (fold(n), fold(split_unit(n)[0]))]
        if len(hits) == 1:
            return hits[0]
    close = nearest(wanted, names)
    raise UsageError(f"no time column '{wanted}'", where=where, expected=", ".join(names[:30]), got=wanted,
                     hint=f"did you mean '{close}'?" if close else None)


def _time(said: Mapping[str, Any], names: list[str], units: list[str | None], data: list[list[Cell]],
          where: str) -> tuple[tuple[int, ...], str | None, str | None, list[str]]:
    wanted, unit, form = said.get("column"), said.get("unit"), said.get("format")
    if wanted is not None:
        columns = tuple(column(w, names, where) for w in (wanted if isinstance(wanted, list | tuple) else [wanted]))
    else:
        columns = _find_time(names, units, data, where)
    cells = [row[columns[0]] for row in data]
    numeric = sum(map(is_number, cells)) * 2 > len(cells)
    notes: list[str] = []
    if form is not None or (not numeric and unit is None):
        return columns, None, form, notes
    text = unit or units[columns[0]]
    if text is None:
        text = _size_of_clock(names[columns[0]], cells, where)
        notes.append(f"time column '{names[columns[0]]}' has no unit: " + (
            "taken as seconds" if text == "s" else f"by its size it is {text}") +
            "; declare table: {time: {unit: ...}} if that is wrong")
    return columns, check_unit(str(text), where), None, notes


def _size_of_clock(name: str, cells: Sequence[Cell], where: str) -> str:
    """The unit of a time that names none: seconds, or a count from a date where its size leaves no other sense.
    FormatError where it may be days or seconds."""
    values = np.array([v for c in cells if (v := _value(c)) is not None], np.float64)
    epoch = found_epoch(values) if values.size else None
    if epoch is not None:
        return epoch
    days = values.size > 1 and bool(((values > 36_526) & (values < 73_051)).all()) and float(np.ptp(values)) < 400
    if days and bool((np.abs(np.diff(values)) < 0.2).all()) and bool((values != np.floor(values)).any()):
        if re.search(r"(?i)dat", name):
            return "excel"
        raise FormatError("times that may be Excel's days or seconds", where=where, got=f"{name}: {values[0]!r} ...",
                          expected="a unit", hint="declare table: {time: {unit: excel}} or {time: {unit: s}}")
    return "s"


def _value(cell: Cell) -> float | None:
    try:
        return float(cell.replace(",", ".") if isinstance(cell, str) else cell)
    except (ValueError, TypeError):
        return None


def _find_time(names: list[str], units: list[str | None], data: list[list[Cell]], where: str) -> tuple[int, ...]:
    width = len(names)

    def share(column: int, test: Any) -> float:
        cells = [r[column] for r in data if r[column] not in ("", None)]
        return sum(bool(test(c)) for c in cells) / len(cells) if cells else 0.0

    def dated(c: Cell) -> bool:
        return is_date(c) if isinstance(c, str) else hasattr(c, "year")

    def clocked(c: Cell) -> bool:
        return is_time_of_day(c) if isinstance(c, str) else hasattr(c, "hour") and not hasattr(c, "year")

    words = [i for i in range(width) if _TIME_WORDS.match(split_unit(names[i])[0].strip())]
    dates = [i for i in range(width) if share(i, dated) > 0.8]
    clocks = [i for i in range(width) if share(i, clocked) > 0.8]
    if dates:
        first = next((i for i in dates if i in words), dates[0])
        sample = next(r[first] for r in data if r[first] not in ("", None))
        has_clock = ":" in sample if isinstance(sample, str) else hasattr(sample, "hour") and (
            not clocks or any(r[first] and r[first].hour + r[first].minute + r[first].second for r in data))
        return (first,) if has_clock or not clocks else (first, clocks[0])
    if clocks:
        return (clocks[0],)
    numbers = [i for i in words if share(i, is_number) > 0.6]
    if numbers:
        return (numbers[0],)
    if (units[0] or "").strip().lower() in SECONDS and share(0, is_number) > 0.6:
        return (0,)
    raise FormatError("no time column found", where=where, got=", ".join(names[:12]),
                      expected="a column of dates, or one called time or with s, min or h as its unit",
                      hint="declare table: {time: {column: 1, unit: s}}")
