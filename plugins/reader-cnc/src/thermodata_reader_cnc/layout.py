"""Where things stand in a delimited text file: delimiter, header rows, time columns. Found from its own lines."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.errors import FormatError
from thermodata.reader.text import clean, looks_like_unit, split_unit
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import when
from thermodata_reader_cnc.when import TimeFormat

DELIMITERS = (";", "\t", ",", "|")
_MILLISECONDS = re.compile(r"^(ms|msec|millise[ck]\w*|millis)\b", re.IGNORECASE)
_RELATIVE = re.compile(r"^(t|time|zeit|čas|cas|elapsed\w*|laufzeit)$", re.IGNORECASE)
_TIME_NAME = re.compile(r"^(date|datum|time|uhrzeit|zeit|čas|cas|tag|timestamp|zeitstempel)", re.IGNORECASE)
_UNIT_NS = {"s": 10**9, "sec": 10**9, "sek": 10**9, "ms": 10**6, "us": 10**3, "µs": 10**3, "min": 60 * 10**9,
            "h": 3600 * 10**9}


@dataclass(frozen=True, slots=True)
class Header:
    """names, units: one a column of the file ('' where none). lines: the header's lines as they stand."""

    names: tuple[str, ...]
    units: tuple[str | None, ...]
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Layout:
    """first_row: 0-based line of the first data row. time: (column, format) pairs that add up to one time."""

    delimiter: str
    quoted: bool
    first_row: int
    width: int
    header: Header
    time: tuple[tuple[int, TimeFormat], ...]

    @property
    def absolute(self) -> bool:
        return self.time[0][1].role != "relative"

    @property
    def time_columns(self) -> tuple[int, ...]:
        return tuple(column for column, _ in self.time)

    def row(self, line: str) -> list[str]:
        return fields(line, self.delimiter, self.quoted)

    def row_ns(self, cells: Sequence[str]) -> int:
        """The local (or, with an offset in the cell, UTC) time of a row; NAT where it has none."""
        total = 0
        for column, form in self.time:
            if column >= len(cells):
                return NAT
            ns = when.parse_one(cells[column], form) if form.role != "relative" else NAT
            if ns == NAT:
                return NAT
            total += ns
        return total


def fields(line: str, delimiter: str, quoted: bool) -> list[str]:
    """The cells of one line; a quote that is never closed is a character like any other."""
    if not quoted or '"' not in line or line.count('"') % 2:
        return line.split(delimiter)
    return next(csv.reader([line], delimiter=delimiter))


def find_layout(lines: Sequence[str], rest: Sequence[str], declared: Mapping[str, Any] | None, where: str) -> Layout:
    """The layout by a file's head lines and lines of its rest. declared: the campaign's `table` keys.

    FormatError: no time column, an order of day and month that nothing decides, a declaration that does not fit.
    """
    table = dict(declared or {})
    skip = int(table.get("skip_rows") or 0)
    body = list(lines[skip:])
    delimiter = table.get("delimiter") or _delimiter(body)
    if delimiter is None:
        raise FormatError("no columns found", where=where, expected="rows of cells between ';', tabs or commas",
                          got=repr(body[0][:60]) if body else "no lines", hint="declare table: {delimiter: ...}")
    delimiter = {"tab": "\t", "\\t": "\t", "semicolon": ";", "comma": ","}.get(delimiter, delimiter)
    quoted = any(f'{delimiter}"' in line or line.startswith('"') for line in body[:200])
    rows = [fields(line, delimiter, quoted) for line in body]
    width = _width(rows)
    others = [r for r in (fields(line, delimiter, quoted) for line in rest) if len(r) == width]
    tail = [r for r in rows[len(rows) // 2:] if len(r) == width] or [r for r in rows if len(r) == width]
    time = _declared_time(table, rows, tail + others, where) if table.get("time") else None
    time = time or _absolute(tail, others, where) or _relative(rows, tail)
    if time is None:
        raise FormatError("no time column found", where=where,
                          expected="a column of dates and times (01.03.2026 08:00:00, 2026-03-01T08:00:00Z), "
                                   "or one named Time/Zeit/Čas with a unit of time",
                          got="; ".join(clean(c) for c in (tail[0] if tail else []))[:120],
                          hint="declare table: {time: {column: ..., format: ...}}")
    first = _first_row(rows, width, time, table)
    header = _header(rows[:first], body[:first], width, time, table, skip)
    time = _with_milliseconds(time, header, [r for r in rows[first:] if len(r) == width][:2000])
    return Layout(delimiter, quoted, skip + first, width, header, time)


def _delimiter(lines: Sequence[str]) -> str | None:
    """The first of ';', tab, comma, '|' that cuts most of the last lines into equally many cells."""
    last = [line for line in lines[len(lines) // 2:] if line.strip()][-500:]
    last = last[:-1] if len(last) > 1 else last            # which may be cut
    for delimiter in DELIMITERS:
        counts = Counter(line.count(delimiter) for line in last if delimiter in line)
        if counts and counts.most_common(1)[0][1] >= 0.5 * len(last):
            return delimiter
    return None


def _width(rows: Sequence[Sequence[str]]) -> int:
    counts = Counter(len(r) for r in rows[len(rows) // 2:] if len(r) > 1)
    return counts.most_common(1)[0][0] if counts else 0


# ---- time ----------------------------------------------------------------------------------------


def _share(cells: Sequence[str], form: TimeFormat) -> float:
    """How many of the cells that hold anything are times of this format."""
    full = [c for c in cells if c.strip()]
    return sum(when.parse_one(c, form) != NAT for c in full) / len(full) if len(full) >= 0.5 * len(cells) > 0 else 0.0


def _spread(rows: Sequence[Sequence[str]], most: int = 40) -> list[Sequence[str]]:
    return list(rows[:: max(1, len(rows) // most)])


def _absolute(tail: Sequence[Sequence[str]], others: Sequence[Sequence[str]],
              where: str) -> tuple[tuple[int, TimeFormat], ...] | None:
    few = _spread(tail)
    if not few:
        return None
    columns = range(min(len(few[0]), 40))
    for forms in (when.DATETIME, when.DATE):
        for column in columns:
            cells = [r[column] for r in few]
            orders = [o for o, form in forms.items() if _share(cells, form) > 0.8]
            if not orders and any(_share(cells, form) > 0.3 for form in forms.values()):
                orders = [o for o, form in forms.items() if _share(cells, form) > 0.3]
            if not orders:
                continue
            order = _order(orders, [r[column] for r in _spread(tail, 2000)] + [r[column] for r in others], forms, where)
            if forms is when.DATETIME:
                return ((column, forms[order]),)
            clock = next((c for c in columns if c != column
                          and _share([r[c] for r in few], when.TIME_OF_DAY) > 0.8), None)
            if clock is not None:
                return (column, forms[order]), (clock, when.TIME_OF_DAY)
    return None


def _order(orders: list[str], cells: Sequence[str], forms: Mapping[str, TimeFormat], where: str) -> str:
    """Day or month first. Dots mean day first, AM/PM month first, a number above 12 decides, else it is an error."""
    if len(orders) == 1:
        return orders[0]
    if any("." in re.split(r"[ T]", c.strip())[0] for c in cells[:5]):
        return "dmy"
    shares = {o: _share(cells, forms[o]) for o in orders}
    best = max(shares.values())
    left = [o for o in orders if shares[o] == best]
    if len(left) == 1:
        return left[0]
    if any(re.search(r"[ap]\.?m", c, re.IGNORECASE) for c in cells[:5]) and "mdy" in left:
        return "mdy"
    raise FormatError("day and month cannot be told apart", where=where, expected="DD/MM or MM/DD",
                      got=cells[0].strip(), hint="declare table: {time: {format: '%d/%m/%Y %H:%M:%S'}}")


def _relative(rows: Sequence[Sequence[str]],
              tail: Sequence[Sequence[str]]) -> tuple[tuple[int, TimeFormat], ...] | None:
    """A column named Time with a unit of time in its name or in the row below."""
    for k, row in enumerate(rows[:60]):
        for column, cell in enumerate(row[:40]):
            name, unit = split_unit(clean(cell))
            if not _RELATIVE.match(name):
                continue
            if unit is None and k + 1 < len(rows) and column < len(rows[k + 1]):
                unit = clean(rows[k + 1][column]).strip("[]()")
            if unit in _UNIT_NS and tail and all(_is_number(r[column]) for r in _spread(tail)):
                return ((column, TimeFormat("relative", None, f"a number [{unit}]", _UNIT_NS[unit])),)
    return None


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


def _declared_time(table: Mapping[str, Any], rows: Sequence[Sequence[str]], body: Sequence[Sequence[str]],
                   where: str) -> tuple[tuple[int, TimeFormat], ...] | None:
    time = table["time"]
    wanted = time.get("column")
    forms = [when.declared_format(time["format"])] if time.get("format") else None
    if wanted is None:
        if forms is None:
            return None
        few = _spread(body)
        found = [c for c in range(len(few[0]) if few else 0) if _share([r[c] for r in few], forms[0]) > 0.8]
        if forms[0].role != "datetime" and len(found) == 1:
            others = [c for c in range(len(few[0])) if c != found[0]
                      and _share([r[c] for r in few], when.TIME_OF_DAY) > 0.8]
            if forms[0].role == "date" and others:
                return (found[0], forms[0]), (others[0], when.TIME_OF_DAY)
        if found and forms[0].role == "datetime":
            return ((found[0], forms[0]),)
        raise FormatError("no column reads with the declared time format", where=where, expected=forms[0].text,
                          got="; ".join(few[0])[:120] if few else "no rows")
    columns = [_column(c, rows, where) for c in (wanted if isinstance(wanted, list) else [wanted])]
    if time.get("unit"):
        unit = str(time["unit"])
        if unit not in _UNIT_NS:
            raise FormatError("unknown unit of time", where=where, expected=", ".join(_UNIT_NS), got=unit)
        return ((columns[0], TimeFormat("relative", None, f"a number [{unit}]", _UNIT_NS[unit])),)
    pairs = []
    for column in columns:
        cells = [r[column] for r in _spread(body, 2000) if column < len(r)]
        if forms and (len(columns) == 1 or _share(cells, forms[0]) > 0.8):
            pairs.append((column, forms[0]))
            continue
        for group in ({"": when.TIME_OF_DAY}, when.DATE, when.DATETIME):
            orders = [o for o, form in group.items() if _share(cells, form) > 0.8]
            if orders:
                pairs.append((column, group[_order(orders, cells, group, where) if orders != [""] else ""]))
                break
        else:
            raise FormatError("the declared time column holds no times", where=f"{where} column {column + 1}",
                              expected="a date, a time, or both", got=cells[0] if cells else "nothing",
                              hint="declare table: {time: {unit: s}} for numbers, or a format")
    return tuple(pairs)


def _column(wanted: int | str, rows: Sequence[Sequence[str]], where: str) -> int:
    if isinstance(wanted, int):
        return wanted - 1
    for row in rows[:60]:
        names = [clean(c) for c in row]
        for spelled in (names, [split_unit(n)[0] for n in names]):
            if wanted in spelled:
                return spelled.index(wanted)
    raise FormatError(f"no column '{wanted}'", where=where, expected="; ".join(clean(c) for c in rows[0])[:200],
                      got=wanted)


def _with_milliseconds(time: tuple[tuple[int, TimeFormat], ...], header: Header,
                       rows: Sequence[Sequence[str]]) -> tuple[tuple[int, TimeFormat], ...]:
    """A column of milliseconds right after the time belongs to it."""
    after = time[-1][0] + 1
    if (time[0][1].role != "relative" and after < len(header.names) and _MILLISECONDS.match(header.names[after])
            and _share([r[after] for r in rows], when.MILLISECOND) == 1.0):
        return (*time, (after, when.MILLISECOND))
    return time


# ---- header --------------------------------------------------------------------------------------


def _first_row(rows: Sequence[Sequence[str]], width: int, time: tuple[tuple[int, TimeFormat], ...],
               table: Mapping[str, Any]) -> int:
    if table.get("header_rows") is not None:
        return int(table["header_rows"])
    for k, row in enumerate(rows):
        if len(row) != width:
            continue
        if all((_is_number(row[c]) if form.role == "relative" else when.parse_one(row[c], form) != NAT)
               for c, form in time):
            return k
    return len(rows)


def _header(above: Sequence[Sequence[str]], lines: Sequence[str], width: int,
            time: tuple[tuple[int, TimeFormat], ...], table: Mapping[str, Any], skip: int) -> Header:
    """Names and units from the rows above the data: the units from the lowest row that reads as units, the
    names from the row above it; without units from the lowest row."""
    block: list[tuple[int, list[str]]] = []
    for k in range(len(above) - 1, -1, -1):
        cells = [clean(c) for c in above[k]]
        if not width - 1 <= len(cells) <= width + 1:
            break
        if block and 2 * sum(map(bool, cells)) < sum(map(bool, block[-1][1])):
            break                        # a preamble that a spreadsheet padded with empty cells
        block.append((k, cells))
    units: list[str] | None = None
    if table.get("units_row") is not None:
        row = int(table["units_row"]) - 1 - skip
        units = [clean(c) for c in above[row]] if 0 <= row < len(above) else None
        block = [(k, cells) for k, cells in block if k < row] or [b for b in block if b[0] != row]
    elif len(block) > 1:
        times = {column for column, _ in time}
        for place, (_, cells) in enumerate(block[:-1]):
            if _are_units(cells, times):
                units, block = cells, block[place + 1:]
                break
    names = block[0][1] if block else []
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
    return good >= 0.5 * len(full)       # a row of blanks under the names too


def _unique(names: Sequence[str]) -> tuple[str, ...]:
    """Names that repeat get '#2'; those that are missing 'column 3'."""
    seen: Counter[str] = Counter()
    result = []
    for c, name in enumerate(names):
        name = name or f"column {c + 1}"
        seen[name] += 1
        result.append(name if seen[name] == 1 else f"{name}#{seen[name]}")
    return tuple(result)
