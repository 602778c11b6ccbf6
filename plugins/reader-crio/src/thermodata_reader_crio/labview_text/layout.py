"""How plain LabVIEW text lies: delimiter, names, units, and which column is the time; and whether it is LabVIEW's."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Float2D, Head
from thermodata.reader.text.cells.values.number import decimal_mark, is_empty, is_overload, to_bool, to_float
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.encoding import decode_head
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.times.time_units import SECONDS
from thermodata_reader_crio.labview_clock import LABVIEW_SECONDS
from thermodata_reader_crio.labview_text.wanted import WantedTime, may_be_time

_MOST_HEADER = 30
_MAY_BE_1904 = re.compile(rb"[234]\x00?(?:\d\x00?){9}|\d\x00?[eE]")  # UTF-16 has zeros between
_MOST_ROWS = 500
_FEWEST_ROWS = 3
_EVEN = 1.1  # the longest step of a clock by its shortest, where nothing else tells that it is one
_TIME_WORDS = re.compile(r"(?i)^(x[_ ]?values?|seconds|sekunden|sec|s)$")


@dataclass(frozen=True)
class Layout:
    """first: lines before the first row; header: these lines, stripped; time: its column (0 where there is none);
    seconds: in one unit of the time; values: the other columns; text: name of a last column of free text, or None;
    doubtful: numbers of lines before the first row that hold numbers themselves, so may be damaged rows."""

    delimiter: str
    decimal: str
    first: int
    header: frozenset[str]
    names: tuple[str, ...]
    units: tuple[str | None, ...]
    clock: Literal["1904", "seconds", "none"]
    time: int
    text: str | None
    doubtful: tuple[int, ...] = ()
    seconds: float = 1.0

    @property
    def values(self) -> list[int]:
        return [i for i in range(len(self.names)) if self.clock == "none" or i != self.time]


def claims(head: Head) -> str | None:
    """The reason for claiming a file: seconds since 1904 between tabs, or rows of bare numbers in a file that is
    named .lvm. What has a unit of time in its header is a table for everyone, and is left to others."""
    start = head.start
    if start[:4] == b"TDSm" or not any(b in start[:4096] for b in b"0123456789"):
        return None
    if not head.name.lower().endswith(".lvm") and not _MAY_BE_1904.search(start):
        return None  # most logs, and taking them apart takes its time
    text = decode_head(start)
    if text is None:
        return None
    lines = _lines(text)
    if head.size_bytes > len(start) and len(lines) > 1:
        lines.pop()
    try:
        layout = find_layout(lines, head.name, WantedTime(sure=False))
    except FormatError:
        return None
    if layout.clock == "1904" and not layout.units[layout.time] and (layout.delimiter == "\t" or not layout.header):
        where = f"column {layout.time + 1}"
        return f"LabVIEW text: rows of numbers with seconds since 1904 in {where}"
    if head.name.lower().endswith(".lvm") and not layout.header and layout.delimiter == "\t":
        return "LVM without its header: rows of numbers between tabs, and nothing else"
    return None


def _lines(text: str) -> list[str]:
    """Lines as the parser has them: str.splitlines knows more line ends than a log does."""
    text = text.lstrip("\ufeff")
    return [line.rstrip("\r") for line in text.split("\n")] if "\n" in text else text.split("\r")


def find_layout(lines: Sequence[str], name: str, wanted: WantedTime) -> Layout:
    """The layout by a file's first lines. FormatError where they are no rows of numbers, QuestionError where
    nothing tells whether a column is the time."""
    lines = lines[: _MOST_HEADER + _MOST_ROWS]
    for delimiter in ("\t", ";", ",", " "):
        found = _rows(lines, delimiter)
        if found is not None:
            return _layout_of(found, name, wanted)
    raise FormatError(
        "no rows of numbers",
        where=name,
        expected=f"numbers between tabs, with at most {_MOST_HEADER} lines before them",
        got=lines[0][:60] if lines else "nothing",
        hint="dates and times of day are read by the readers cnc and table",
    )


def _cells_of(line: str, delimiter: str) -> list[str]:
    return line.split() if delimiter == " " else [clean(c) for c in line.split(delimiter)]


def _reads(cell: str, decimal: str) -> bool:
    """Whether a cell may stand in a column of numbers; one of truth values is none of LabVIEW's."""
    return is_empty(cell) or is_overload(cell) or (to_float(cell, decimal) is not None and to_bool(cell) is None)


@dataclass(frozen=True)
class _Rows:
    """Where rows of numbers stand among lines that are taken apart. first: the line of the first; columns: of numbers;
    text: whether free text follows these."""

    lines: Sequence[str]
    cells: list[list[str]]
    delimiter: str
    first: int
    columns: int
    decimal: str
    text: bool

    def values(self) -> Float2D:
        """The numbers of all whole rows; shape (rows, columns), NaN where there is none."""
        rows = [row for row in self.cells[self.first :] if len(row) in (self.columns, self.columns + self.text)]
        numbers = [[to_float(c, self.decimal) for c in row[: self.columns]] for row in rows]
        return np.array([[np.nan if v is None else v for v in row] for row in numbers], np.float64)

    def heads(self) -> list[list[str]]:
        """The lines above that may name all columns."""
        return [row for row in self.cells[: self.first] if len(row) >= self.columns and any(row)]

    def doubtful(self) -> tuple[int, ...]:
        """Numbers of lines above that hold numbers themselves."""
        return tuple(
            i + 1
            for i, (line, row) in enumerate(zip(self.lines, self.cells[: self.first], strict=False))
            if "\0" in line or any(to_float(c, self.decimal) is not None for c in row[1:])
        )


def _rows(lines: Sequence[str], delimiter: str) -> _Rows | None:
    """Rows of numbers between this delimiter, where the lines are mostly such."""
    cells = [_cells_of(line, delimiter) for line in lines]
    counts = Counter(len(row) for row in cells[len(cells) // 2 :] if any(row))
    if not counts:
        return None
    width = counts.most_common(1)[0][0]
    if width < 2:
        return None
    body = [row for row in cells if len(row) == width]
    body = body[len(body) // 2 :][-100:]  # behind any header
    try:
        decimal = "." if delimiter == "," else decimal_mark(c for row in body for c in row) or "."
    except FormatError:
        return None
    last = [row[-1] for row in body]
    # one damaged cell makes no column of text
    odd = sum(not _reads(c, decimal) for c in last)
    text = odd * 2 > sum(map(bool, last)) or not any(last)
    columns = width - 1 if text else width

    def reads(row: list[str]) -> bool:
        return len(row) in (columns, columns + text) and all(_reads(c, decimal) for c in row[:columns])

    first = next((i for i, row in enumerate(cells) if reads(row) and any(row[:columns])), None)
    if columns < 2 or first is None or first > _MOST_HEADER:
        return None
    good = sum(map(reads, cells[first:]))
    many = sum(any(row) for row in cells[first:])
    if good < max(_FEWEST_ROWS, 0.6 * many):
        return None
    return _Rows(lines, cells, delimiter, first, columns, decimal, text)


def _layout_of(rows: _Rows, name: str, wanted: WantedTime) -> Layout:
    """With the names, units and time of the columns. name: of the file."""
    heads = rows.heads()
    units_row = len(heads) > 1 and _is_units(heads[-1])
    titles = heads[-2] if units_row else heads[-1] if heads else []
    names, units = [], []
    for i in range(rows.columns):
        title, unit = split_unit(titles[i]) if i < len(titles) else ("", None)
        below = heads[-1][i] if units_row else None
        names.append(title or f"column {i + 1}")
        units.append(below or unit)
    clock, time, seconds = _clock(rows.values(), names, units, wanted, name, bool(heads))
    return Layout(
        rows.delimiter,
        rows.decimal,
        rows.first,
        frozenset(line.strip() for line in rows.lines[: rows.first]),
        _unique_names(names),
        tuple(units),
        clock,
        time,
        _name_of_text(titles, names) if rows.text else None,
        rows.doubtful(),
        seconds,
    )


def _name_of_text(titles: Sequence[str], names: Sequence[str]) -> str:
    """What a last column of free text is called. names: of the columns before it."""
    title = titles[len(names)] if len(names) < len(titles) and titles[len(names)] else "Comment"
    return title if title not in names else f"{title} (text)"


def _is_units(row: list[str]) -> bool:
    filled = [c for c in row if c]
    return bool(filled) and sum(looks_like_unit(c) for c in filled) >= max(1, len(filled) - 1)


def _clock(
    values: Float2D, names: list[str], units: list[str | None], wanted: WantedTime, where: str, named: bool
) -> tuple[Literal["1904", "seconds", "none"], int, float]:
    """(what the time counts in, its column, seconds in one unit): as declared, by its size, by its header; rows
    without names by even steps."""

    def counting(at: int) -> tuple[Literal["1904", "seconds"], int, float]:
        unit = wanted.unit or unit_of_time(names[at], units[at])
        if unit in (None, "s") and _since_1904(values[:, at]):
            return "1904", at, 1.0
        return "seconds", at, SECONDS.get(unit or "s", 1.0)

    if wanted.column is not None:
        if wanted.column in names:
            return counting(names.index(wanted.column))
        if isinstance(wanted.column, int) and 1 <= wanted.column <= len(names):
            return counting(wanted.column - 1)
        raise FormatError(
            f"no column '{wanted.column}' for the time",
            where=where,
            expected=", ".join(names),
            hint="take a name from this list",
        )
    if wanted.period_s is not None:
        return "none", 0, 1.0
    for at in (0, values.shape[1] - 1):
        if _since_1904(values[:, at]):
            return "1904", at, 1.0
    called = [i for i in range(len(names)) if is_time_header(names[i], units[i]) or _TIME_WORDS.match(names[i])]
    called = [i for i in called if _goes_one_way(values[:, i])]
    if called and named:
        return counting(called[0])
    if not _rises_throughout(values[:, 0]):
        return "none", 0, 1.0
    steps = np.diff(values[:, 0])
    if not named and steps.max() <= _EVEN * steps.min():
        return counting(0)
    if wanted.sure:
        raise may_be_time(names[0], values[:, 0], where)
    return "none", 0, 1.0


def _goes_one_way(column: Any) -> bool:
    """Whether a column that is called a time may be one."""
    full = column[np.isfinite(column)]
    steps = np.diff(full)
    return bool(full.size > 0.6 * column.size and steps.size and max((steps >= 0).mean(), (steps <= 0).mean()) > 0.9)


def _rises_throughout(column: Any) -> bool:
    return column.size > 1 and bool(np.isfinite(column).all()) and bool((np.diff(column) > 0).all())


def _since_1904(column: Any) -> bool:
    """Seconds since 1904 of the years 1997 to 2040 that do not run back."""
    full = column[np.isfinite(column)]
    return (
        full.size >= _FEWEST_ROWS
        and bool((full >= LABVIEW_SECONDS[0]).all())
        and bool((full <= LABVIEW_SECONDS[1]).all())
        and float(np.mean(np.diff(full) >= 0)) > 0.9
    )


def _unique_names(names: list[str]) -> tuple[str, ...]:
    found: list[str] = []
    for name in names:
        made, count = name, 2
        while made in found:
            made, count = f"{name}#{count}", count + 1
        found.append(made)
    return tuple(found)
