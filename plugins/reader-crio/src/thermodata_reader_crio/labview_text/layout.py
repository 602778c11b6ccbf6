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
from thermodata.reader.text.encoding import decode_head
from thermodata.reader.text.header import looks_like_unit, split_unit
from thermodata.reader.text.number import clean, decimal_mark, is_empty, is_overload, to_bool, to_float
from thermodata_reader_crio.labview_clock import LABVIEW_SECONDS

_MOST_HEADER = 30
_MAY_BE_1904 = re.compile(rb"[234]\x00?(?:\d\x00?){9}|\d\x00?[eE]")  # UTF-16 has zeros between
_MOST_ROWS = 500
_FEWEST_ROWS = 3


@dataclass(frozen=True)
class Layout:
    """first: lines before the first row; header: these lines, stripped; time: its column (0 where there is none);
    values: the other columns; text: name of a last column of free text, or None; doubtful: numbers of lines before the
    first row that hold numbers themselves, so may be damaged rows."""

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
        layout = find_layout(lines, head.name, None)
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


def find_layout(lines: Sequence[str], name: str, wanted: Any) -> Layout:
    """The layout by a file's first lines. wanted: the time column as declared (name, or number from 1). FormatError
    where they are no rows of numbers."""
    lines = lines[: _MOST_HEADER + _MOST_ROWS]
    for delimiter in ("\t", ";", ",", " "):
        found = _rows(lines, delimiter)
        if found is not None:
            return _made(lines, delimiter, *found, name, wanted)
    raise FormatError(
        "no rows of numbers",
        where=name,
        expected=f"numbers between tabs, with at most {_MOST_HEADER} lines before them",
        got=lines[0][:60] if lines else "nothing",
        hint="dates and times of day are read by the readers cnc and table",
    )


def _split(line: str, delimiter: str) -> list[str]:
    return line.split() if delimiter == " " else [clean(c) for c in line.split(delimiter)]


def _reads(cell: str, decimal: str) -> bool:
    """Whether a cell may stand in a column of numbers; one of truth values is none of LabVIEW's."""
    return is_empty(cell) or is_overload(cell) or (to_float(cell, decimal) is not None and to_bool(cell) is None)


def _rows(lines: Sequence[str], delimiter: str) -> tuple[int, int, str, bool] | None:
    """(line of the first row, columns of numbers, decimal mark, whether free text follows them)."""
    cells = [_split(line, delimiter) for line in lines]
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
    first = next(
        (
            i
            for i, row in enumerate(cells)
            if len(row) in (columns, columns + text)
            and all(_reads(c, decimal) for c in row[:columns])
            and any(row[:columns])
        ),
        None,
    )
    if columns < 2 or first is None or first > _MOST_HEADER:
        return None
    good = sum(
        all(_reads(c, decimal) for c in row[:columns]) for row in cells[first:] if len(row) in (columns, columns + text)
    )
    many = sum(any(row) for row in cells[first:])
    return (first, columns, decimal, text) if good >= max(_FEWEST_ROWS, 0.6 * many) else None


def _made(
    lines: Sequence[str], delimiter: str, first: int, columns: int, decimal: str, text: bool, name: str, wanted: Any
) -> Layout:
    heads = [row for line in lines[:first] if len(row := _split(line, delimiter)) >= columns and any(row)]
    units_row = len(heads) > 1 and _is_units(heads[-1])
    titles = heads[-2] if units_row else heads[-1] if heads else []
    names, units = [], []
    for i in range(columns):
        title, unit = split_unit(titles[i]) if i < len(titles) else ("", None)
        below = heads[-1][i] if units_row else None
        names.append(title or f"column {i + 1}")
        units.append(below or unit)
    rows = [_split(line, delimiter) for line in lines[first:]]
    values = np.array(
        [
            [v if (v := to_float(c, decimal)) is not None else np.nan for c in r[:columns]]
            for r in rows
            if len(r) in (columns, columns + text)
        ],
        np.float64,
    )
    clock, time = _clock(values, names, wanted, name)
    free = None
    if text:
        title = titles[columns] if columns < len(titles) and titles[columns] else "Comment"
        free = title if title not in names else f"{title} (text)"
    header = frozenset(line.strip() for line in lines[:first])
    doubtful = tuple(
        i + 1
        for i, line in enumerate(lines[:first])
        if "\0" in line or any(to_float(c, decimal) is not None for c in _split(line, delimiter)[1:])
    )
    return Layout(delimiter, decimal, first, header, _unique(names), tuple(units), clock, time, free, doubtful)


def _is_units(row: list[str]) -> bool:
    filled = [c for c in row if c]
    return bool(filled) and sum(looks_like_unit(c) for c in filled) >= max(1, len(filled) - 1)


def _clock(values: Float2D, names: list[str], wanted: Any, name: str) -> tuple[Literal["1904", "seconds", "none"], int]:
    """Which column is the time, and what it counts in."""
    if wanted is not None:
        if wanted in names:
            at = names.index(wanted)
        elif isinstance(wanted, int) and 1 <= wanted <= len(names):
            at = wanted - 1
        else:
            raise FormatError(f"no column '{wanted}' for the time", where=name, expected=", ".join(names))
        return ("1904" if _since_1904(values[:, at]) else "seconds"), at
    for at in (0, values.shape[1] - 1):
        if _since_1904(values[:, at]):
            return "1904", at
    first = values[:, 0]
    rising = first.size > 1 and bool(np.isfinite(first).all()) and bool((np.diff(first) > 0).all())
    return ("seconds", 0) if rising else ("none", 0)


def _since_1904(column: Any) -> bool:
    """Seconds since 1904 of the years 1997 to 2040 that do not run back."""
    full = column[np.isfinite(column)]
    return (
        full.size >= _FEWEST_ROWS
        and bool((full >= LABVIEW_SECONDS[0]).all())
        and bool((full <= LABVIEW_SECONDS[1]).all())
        and float(np.mean(np.diff(full) >= 0)) > 0.9
    )


def _unique(names: list[str]) -> tuple[str, ...]:
    found: list[str] = []
    for name in names:
        made, count = name, 2
        while made in found:
            made, count = f"{name}#{count}", count + 1
        found.append(made)
    return tuple(found)
