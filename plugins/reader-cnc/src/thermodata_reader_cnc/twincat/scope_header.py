"""The header of TwinCAT Scope's text export: what is exported when, and blocks of keys that repeat a group.

A group is a time column and its channels; the header's rows repeat their key where a group begins. A comment may hold
line ends, a table of triggers may stand before the names, and a short header has the names alone.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.errors import FormatError
from thermodata.reader.text.cells.values.number import is_empty, is_number, of_either_mark, to_bool, to_int
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.times.time_units import EPOCHS, to_ns

START = re.compile(r"^Start\s?(?:time of (?:export|record)|Record)\s*([\t;,|])\s*\"?(\d{15,19})\b", re.IGNORECASE)
_END = re.compile(r"^End\s?(?:time of (?:export|record)|Record)\s*[\t;,|]\s*\"?(\d{15,19})\b", re.IGNORECASE)
_NAME = re.compile(r"^\"?Name\"?([\t;,|])")
_MOST_LINES = 5000
_MOST_BESIDE = 1000  # cells that rows may lack because groups ended: each is room in every row
_DIGIT = re.compile(r"^[+-]?\d")
_LATEST_NS = 8_955_526_400 * 10**9  # 2253
_TICKS = EPOCHS["filetime"]
_KEYS = frozenset(
    {
        "symbolcomment",
        "data-type",
        "sampletime[ms]",
        "sampletime",
        "variablesize",
        "symbolbased",
        "indexgroup",
        "indexoffset",
        "symbolname",
        "netid",
        "port",
        "offset",
        "scalefactor",
        "bitmask",
        "unit",
        "unit scalefactor",
        "unit offset",
        "starttime",
        "endtime",
    }
)
_SIGNED = re.compile(r"^(?:SINT|INT|DINT|LINT|INT(?:8|16|32|64))$")
_UNSIGNED = re.compile(r"^(?:USINT|UINT|UDINT|UINT(?:8|16|32)|BYTE|WORD|DWORD)$")
_UNSIGNED_64 = re.compile(r"^(?:ULINT|UINT64|LWORD)$")


@dataclass(frozen=True, slots=True)
class Channel:
    """scaling: the factors that the header names, as text; whether the values were exported with them, no file says."""

    column: int
    name: str
    stream: str
    unit: str | None
    dtype: str
    scaling: str
    properties: dict[str, str]


@dataclass(frozen=True, slots=True)
class Header:
    """first_row: 0-based line of the first data row. groups: time column -> its channels. ticks: the times are whole
    FILETIMEs, not milliseconds since the start."""

    start_ns: int
    end_ns: int | None
    delimiter: str
    decimal: str
    width: int
    first_row: int
    groups: dict[int, list[Channel]]
    ticks: bool
    fastest_ms: float


def filetime_ns(ticks: int, where: str) -> int:
    """A FILETIME (100 ns since 1601) in UTC nanoseconds since 1970; FormatError where it is no time of our days."""
    ns = int(to_ns(np.array([ticks]), _TICKS.seconds, _TICKS.zero_s)[0])
    if not 0 <= ns <= _LATEST_NS:
        raise FormatError(
            "no time in the header",
            where=where,
            expected="a FILETIME between 1970 and 2253",
            got=str(ticks),
            hint="export the scope again as text with its header",
        )
    return ns


def read_header(lines: Sequence[str], where: str) -> Header:
    """The header of an export; FormatError for what is missing."""
    start = _start(lines, where)
    end = next((m for line in lines[:20] if (m := _END.match(line))), None)
    names_at, delimiter = _row_of_names(lines, where)
    rows, first = _rows(lines, names_at, delimiter)
    names = rows["name"]
    while names and not names[-1]:
        names.pop()  # older exports end their rows with a delimiter
    body = [line for line in lines[first : first + 500] if _is_data(line, delimiter)]
    if not body:
        raise FormatError(
            "no data behind the header",
            where=where,
            expected="rows of numbers",
            got=lines[first][:60] if first < len(lines) else "the end of the file",
            hint="export the scope again, with a stretch that holds samples",
        )
    width, groups = _width(body, names, delimiter, where), _groups(names, rows)
    ticks = sum(len(line.split(delimiter, 1)[0].strip().lstrip("-")) >= 17 for line in body) > len(body) / 2
    return Header(
        start_ns=filetime_ns(int(start[2]), where),
        end_ns=None if end is None else filetime_ns(int(end[1]), where),
        delimiter=delimiter,
        decimal="," if delimiter != "," and any("," in line for line in body) else ".",
        width=width,
        first_row=first,
        groups=groups,
        ticks=ticks,
        fastest_ms=_fastest(rows, names),
    )


def _start(lines: Sequence[str], where: str) -> re.Match[str]:
    start = next((m for line in lines[:20] if (m := START.match(line))), None)
    if start is None:
        raise FormatError(
            "no start of the export",
            where=where,
            expected="'Starttime of export' and a FILETIME",
            got=lines[1][:60] if len(lines) > 1 else "nothing",
            hint="export the scope again as text with its header",
        )
    return start


def _row_of_names(lines: Sequence[str], where: str) -> tuple[int, str]:
    """(its place, what parts its cells)."""
    found = next(((k, m[1]) for k, line in enumerate(lines[1:_MOST_LINES], 1) if (m := _NAME.match(line))), None)
    if found is None:
        raise FormatError(
            "no row of channel names",
            where=where,
            expected="a second row 'Name' between tabs or ';'",
            got=lines[5][:60] if len(lines) > 5 else "nothing",
            hint="export the scope again as text with its header",
        )
    return found


def _width(body: Sequence[str], names: Sequence[str], delimiter: str, where: str) -> int:
    """How many cells a row may have. body: its first rows of data."""
    widths = [line.count(delimiter) + 1 for line in body]
    width = max((w for w in widths if w <= len(names) + 1), default=0)
    if not width or (delimiter == "," and sum(w >= 2 * len(names) > 2 for w in widths) > len(widths) / 2):
        raise FormatError(
            "cells and decimals cannot be told apart",
            where=where,
            expected=f"{len(names)} cells between '{delimiter}'",
            got=str(max(widths)),
            hint="export with tabs or ';' between the cells",
        )
    if len(names) > width + _MOST_BESIDE:
        raise FormatError(
            "the row of names is longer than any row of data",
            where=where,
            expected=f"about {width} cells, as the first {len(body)} rows have",
            got=f"{len(names)} cells",
            hint="export the scope again: the rows were cut, or the file was edited",
        )
    return max(width, len(names))


def _rows(lines: Sequence[str], names_at: int, delimiter: str) -> tuple[dict[str, list[str]], int]:
    """(key -> the row's cells, the first line of data). A row whose cells hold line ends goes on over lines."""
    rows: dict[str, list[str]] = {}
    key, damaged = "", None
    for number in range(names_at, min(len(lines), names_at + _MOST_LINES)):
        line = lines[number]
        cells = [cell.strip().strip('"') for cell in line.split(delimiter)]
        word = cells[0].casefold()
        if word in _KEYS or number == names_at:
            key, damaged = "name" if number == names_at else word, None
            rows[key] = cells
        elif _is_data(line, delimiter) and not (key == "symbolcomment" and len(rows[key]) < len(rows["name"])):
            return rows, number if damaged is None else damaged
        elif key == "symbolcomment" and line.strip():
            rows[key][-1] += " " + cells[0]
            rows[key] += cells[1:]
        elif damaged is None and _DIGIT.match(cells[0]):
            damaged = number  # a first row that lost a delimiter is told as a loss, not passed over
    return rows, min(len(lines), names_at + _MOST_LINES)


def _is_data(line: str, delimiter: str) -> bool:
    cells = [clean(cell) for cell in line.split(delimiter)]
    full = [cell for cell in cells if cell]
    return bool(full) and _is_number(full[0]) and all(_is_number(c) or is_empty(c) for c in full)


def _is_number(cell: str) -> bool:
    """Whether a cell is a number, a truth value, or a count of 100 ns, which a float64 would round."""
    return is_number(cell) or to_int(cell) is not None or to_bool(cell) is not None


def _fastest(rows: dict[str, list[str]], names: list[str]) -> float:
    cells = [cell for cell in rows.get("sampletime[ms]", [])[: len(names)] if is_number(cell)]
    times = map(of_either_mark, cells)
    return min((t for t in times if t is not None and 0 <= t < 1e9), default=0.0)


def _groups(names: list[str], rows: dict[str, list[str]]) -> dict[int, list[Channel]]:
    groups: dict[int, list[Channel]] = {}
    taken: dict[tuple[int, str], int] = {}
    time = 0
    for column, name in enumerate(names):
        if name == "Name":
            time = column
            groups[time] = []
        elif name:
            count = taken[time, name] = taken.get((time, name), 0) + 1
            groups[time].append(_channel(column, name if count == 1 else f"{name}#{count}", len(groups), rows))
    return {t: c for t, c in groups.items() if c}


def _channel(column: int, name: str, group: int, rows: dict[str, list[str]]) -> Channel:
    def cell(key: str) -> str:
        cells = rows.get(key, [])
        return cells[column] if column < len(cells) else ""

    unit = re.sub(r"\s*\(.*\)$", "", cell("unit")) or None  # "V (Voltage)", "(None)"
    factors = [(key, cell(key)) for key in ("scalefactor", "offset", "unit scalefactor", "unit offset")]
    odd = [
        f"{key} {value}"
        for key, value in factors
        if re.sub(r"[.,]0+$", "", value) not in ("", "1" if "factor" in key else "0")
    ]
    kind = cell("data-type").upper().removeprefix("ADST_")
    dtype = "float64"
    if not odd:
        dtype = (
            "bool"
            if kind in ("BIT", "BOOL")
            else "int64"
            if _SIGNED.match(kind) or _UNSIGNED.match(kind)
            else "uint64"
            if _UNSIGNED_64.match(kind)
            else "float64"
        )
    said = {
        "SymbolName": cell("symbolname"),
        "SymbolComment": cell("symbolcomment"),
        "Data-Type": cell("data-type"),
        "SampleTime[ms]": cell("sampletime[ms]"),
        "Scaling": "; ".join(odd),
    }
    return Channel(column, name, f"scope{group}", unit, dtype, "; ".join(odd), {k: v for k, v in said.items() if v})
