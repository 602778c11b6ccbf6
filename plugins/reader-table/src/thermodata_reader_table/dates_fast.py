"""Dates of one writing at numpy's speed: digits are read from the bytes of all cells at once."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Int1D
from thermodata.reader.zone import NAT

_ISO = re.compile(r"^\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d{1,9})?)?$")
_WIDTHS = 12  # different lengths of cells; more are read one by one


def local_times(column: Any, pattern: re.Pattern[str], *, year_first: bool, month_first: bool) -> Int1D | None:
    """Local nanoseconds of an Arrow column of texts, or None where a cell is written in another way.

    pattern: stamps' of this writing. Cells with a zone, with am or pm, or with blanks around them: None.
    """
    if column.null_count or not len(column):
        return None
    if year_first and (iso := _iso(column)) is not None:
        return iso
    offsets = np.frombuffer(column.buffers()[1], np.int32)[column.offset : column.offset + len(column) + 1]
    letters = np.frombuffer(column.buffers()[2], np.uint8)
    widths = np.diff(offsets)
    first = int(widths[0])
    if (widths == first).all():
        return (
            _of_width(letters[offsets[0] : offsets[-1]].reshape(-1, first), pattern, year_first, month_first)
            if first
            else None
        )
    kinds = np.unique(widths)
    if kinds.size > _WIDTHS or kinds[0] == 0:
        return None
    out = np.empty(widths.size, np.int64)
    for width in kinds:
        rows = np.flatnonzero(widths == width)
        part = _of_width(letters[offsets[rows][:, None] + np.arange(width)], pattern, year_first, month_first)
        if part is None:
            return None
        out[rows] = part
    return out


def _iso(column: Any) -> Int1D | None:
    """2026-03-01 08:00:00.125 and the like by Arrow's own parser, or None."""
    import pyarrow as pa

    if _ISO.match(column[0].as_py()) is None:
        return None
    try:
        cast = column.cast(pa.timestamp("ns"))
    except pa.ArrowException:
        return None
    return np.frombuffer(cast.buffers()[1], np.int64, len(cast), cast.offset * 8)


def _of_width(
    cells: npt.NDArray[np.uint8], pattern: re.Pattern[str], year_first: bool, month_first: bool
) -> Int1D | None:
    try:
        sample = cells[0].tobytes().decode("ascii")
    except UnicodeDecodeError:
        return None
    match = pattern.match(sample)
    if match is None:
        return None
    day, month, year, hour, minute, second, fraction, half, zone = (
        (3, 2, 1, 4, 5, 6, 7, 8, 9) if year_first else (1, 3, 4, 5, 6, 7, 8, 9, 10)
    )
    if match[half] or match[zone]:
        return None
    if month_first and not year_first:
        day, month = month, day
    fields = (day, month, year, hour, minute, second, fraction)
    digits = np.zeros(cells.shape[1], bool)
    for group in fields:
        if match[group]:
            digits[slice(*match.span(group))] = True
    fixed = ~digits
    if fixed.any() and not (cells[:, fixed] == cells[0, fixed]).all():
        return None

    def number(group: int) -> npt.NDArray[np.int32] | None:
        if not match[group]:
            return None
        start, stop = match.span(group)
        total = np.zeros(len(cells), np.int32)
        for at in range(start, stop):
            digit = cells[:, at] - np.uint8(48)  # what is no digit wraps to above 9
            if (digit > 9).any():
                raise ValueError
            total = total * np.int32(10) + digit
        return total

    try:
        d, m, y, h, mi, s, f = (number(g) for g in fields)
    except ValueError:
        return None
    if d is None or m is None or y is None:
        return None
    date = (y * 10_000 + m * 100 + d).astype(np.int64)
    turns = np.concatenate(([0], np.flatnonzero(np.diff(date)) + 1))
    midnights = [_midnight(int(date[i])) for i in turns]
    if any(x is None for x in midnights):
        return None
    lengths = np.diff(np.concatenate((turns, [len(date)])))
    out: Int1D = np.repeat(np.array(midnights, np.int64), lengths)
    clock = np.zeros(len(cells), np.int64)
    for part, most, scale in ((h, 23, 3600), (mi, 59, 60), (s, 59, 1)):
        if part is not None:
            if (part > most).any():
                return None
            clock += part.astype(np.int64) * scale
    out += clock * 1_000_000_000
    if f is not None:
        out += f.astype(np.int64) * 10 ** (9 - len(match[fraction]))
    return out


def _midnight(date: int) -> int | None:
    year, month, day = date // 10_000, date // 100 % 100, date % 100
    try:
        ns = np.datetime64(f"{year + 2000 if year < 100 else year:04}-{month:02}-{day:02}", "ns").astype(np.int64)
    except ValueError:
        return None
    return None if ns == NAT else int(ns)
