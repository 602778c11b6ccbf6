"""Rows of plain delimited text at the speed of Arrow's parser, in one pass: numbers are numbers, dates of one writing.

The first row that is otherwise ends it, and text_rows goes on from there; both give the same for what both can read.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.plugin import Array, Block, Int1D, Source
from thermodata.reader.text import clean
from thermodata.reader.zone import NAT, local_to_utc_ns, zone
from thermodata_reader_table import clocks, stamps
from thermodata_reader_table.dates_fast import local_times
from thermodata_reader_table.layout import Group
from thermodata_reader_table.text_rows import EMPTY, Clock, Sheet, Tally, block_rows

_PART = 4 << 20
_NULLS = sorted({form(word) for word in EMPTY for form in (str, str.upper, str.title)} | {"NaN", "N/A", "#N/A"})


class UnsuitableError(Exception):
    """A part of the file needs more care."""


def suits(sheet: Sheet) -> bool:
    """Whether the head of the file gives hope: one time column, and an encoding that keeps line ends."""
    layout = sheet.layout
    return (
        all(len(g.time) == 1 and g.epoch is None and g.form is None for g in layout.groups)
        and not sheet.encoding.startswith("utf-16")
        and len(sheet.delimiter) == 1
        and len(layout.names) < 5000
    )


def blocks(path: Path, sheet: Sheet, source: Source, tally: Tally) -> Iterator[Block]:
    """Blocks as long as all goes well; UnsuitableError else, with the rows that were delivered in `tally`."""
    times = [_Times(path, sheet, source, g) for g in sheet.layout.groups]
    size = block_rows(sheet, source)
    held: Any = None
    for batch in _batches(path, sheet):
        if sheet.cut:
            held, batch = batch, held  # the last row of the last batch is not to be trusted
            if batch is None:
                continue
        yield from _delivered(batch, sheet, times, tally, size)
    if held is not None:
        tally_rows = held.num_rows - 1
        yield from _delivered(held.slice(0, tally_rows), sheet, times, tally, size)
    if sheet.layout.first and tally.at == 0:
        raise UnsuitableError


def _delivered(batch: Any, sheet: Sheet, times: list[_Times], tally: Tally, size: int) -> Iterator[Block]:
    several = len(times) > 1
    for start in range(0, batch.num_rows, size):
        part = batch.slice(start, size)
        made = []
        for time in times:
            mine, bad = _without_end(part, time.group) if several else (part, 0)
            t_ns = time.of(mine.column(time.group.time[0]))
            good = t_ns != NAT
            every = bool(good.all())
            values: dict[str, Array] = {}
            for i in time.group.columns:
                column = _values(mine.column(i), sheet.kinds[i])
                values[sheet.layout.names[i]] = column if every else column[good]
            tally.bad_rows += int((~good).sum()) + bad
            if good.any():
                tally.last_ns = int(t_ns[good][-1])
                made.append(Block(time.group.stream, t_ns if every else t_ns[good], values))
        tally.at += part.num_rows
        yield from made


def _without_end(part: Any, group: Group) -> tuple[Any, int]:
    """(the rows in which a group has a time, how many of the others have a value of it)."""
    import pyarrow as pa
    import pyarrow.compute as call

    def empty(i: int) -> Any:
        column = part.column(i)
        nothing = call.is_null(column)
        if pa.types.is_string(column.type):
            nothing = call.or_(nothing, call.equal(call.utf8_trim_whitespace(column.fill_null("")), ""))
        return nothing

    gone = empty(group.time[0])
    if not call.any(gone).as_py():
        return part, 0
    ended = gone
    for i in group.columns:
        ended = call.and_(ended, empty(i))
    return part.filter(call.invert(gone)), int(call.sum(gone).as_py()) - int(call.sum(ended).as_py() or 0)


def _values(column: Any, kind: str) -> Array:
    if kind != "str":
        return numbers(column)
    if not len(column):
        return np.zeros(0, object)
    coded = column.fill_null("").dictionary_encode()
    words = np.array([clean(w) for w in coded.dictionary.to_pylist()] or [""], object)
    taken: Array = words[np.frombuffer(coded.indices.buffers()[1], np.int32, len(coded), coded.indices.offset * 4)]
    return taken


def numbers(column: Any) -> Array:
    """Doubles of an Arrow array, NaN where there is none. Its own to_numpy() imports pandas, which takes longer than
    most files."""
    if not len(column):
        return np.zeros(0)
    whole = column.fill_null(float("nan")) if column.null_count else column
    return np.frombuffer(whole.buffers()[1], np.float64, len(whole), whole.offset * 8)


def _batches(path: Path, sheet: Sheet) -> Iterator[Any]:
    """Record batches, the next one parsed while this one is used."""
    import pyarrow as pa
    import pyarrow.csv as pc

    layout = sheet.layout
    names = [str(i) for i in range(len(layout.names))]
    types = {n: pa.string() if kind == "str" else pa.float64() for n, kind in zip(names, sheet.kinds, strict=True)}
    for group in layout.groups:
        types[names[group.time[0]]] = pa.string() if group.dated else pa.float64()
    try:
        reader = pc.open_csv(
            path,
            read_options=pc.ReadOptions(
                block_size=_PART,
                skip_rows=layout.first,
                column_names=names,
                encoding=sheet.encoding.replace("utf-8-sig", "utf-8"),
            ),
            parse_options=pc.ParseOptions(
                delimiter=sheet.delimiter, quote_char='"' if sheet.quoted else False, newlines_in_values=False
            ),
            convert_options=pc.ConvertOptions(
                column_types=types, decimal_point=sheet.decimal, null_values=_NULLS, strings_can_be_null=False
            ),
        )
        with ThreadPoolExecutor(1) as pool:
            ahead = pool.submit(next, reader, None)
            while (batch := ahead.result()) is not None:
                ahead = pool.submit(next, reader, None)
                yield batch
    except (pa.ArrowException, UnicodeError, ValueError, OSError):
        raise UnsuitableError from None


class _Times:
    """Times of a column, part by part; UnsuitableError where only the whole column tells."""

    def __init__(self, path: Path, sheet: Sheet, source: Source, group: Group) -> None:
        self.group, self.timezone = group, source.timezone
        self.clock = Clock(path, sheet, source, group)
        self.seen = False

    def of(self, column: Any) -> Int1D:
        seconds = self.group.seconds
        if seconds is not None:
            return clocks.to_ns(numbers(column), seconds)
        if not len(column):
            return np.zeros(0, np.int64)
        texts: list[str] | None = None if self.seen else column.to_pylist()
        writing = self.clock.writing(texts or [])
        self.seen = True
        if writing.kind == "clock":
            raise UnsuitableError
        ns = local_times(
            column, writing.pattern, year_first=writing.kind == "year_first", month_first=writing.month_first
        )
        if ns is None:
            found = stamps.local(column.to_pylist(), writing)
            if found.zoned:
                raise UnsuitableError
            ns = found.ns
        return self._utc(ns)

    def _utc(self, ns: Int1D) -> Int1D:
        if self.timezone is None:
            return ns
        valid = ns[ns != NAT]
        if valid.size and _falls_back(int(valid.min()), int(valid.max()), self.timezone):
            raise UnsuitableError
        return local_to_utc_ns(ns.view("datetime64[ns]"), self.timezone)[0]


def _falls_back(first_ns: int, last_ns: int, timezone: str) -> bool:
    """Whether an hour may repeat between two local times, or within two days of them."""
    tz = zone(timezone)
    at, end = first_ns // 10**9 - 2 * 86_400, last_ns // 10**9 + 2 * 86_400
    if end - at > 400 * 86_400:
        return True
    before = None
    while at < end + 86_400:
        shift = datetime.fromtimestamp(at, UTC).astimezone(tz).utcoffset() or timedelta(0)
        if before is not None and shift < before:
            return True
        before, at = shift, at + 43_200
    return False
