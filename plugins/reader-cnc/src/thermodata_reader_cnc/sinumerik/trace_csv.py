"""Sinumerik Trace as CSV: time in seconds, or in the unit that is said of it, then signals named by their paths
(`/Nck/!SD/... [u1; 1]`)."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.number import is_number, to_float
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import chunks, from_line, sample, split_last_line
from thermodata.reader.text.file.locate import line_of
from thermodata.reader.text.file.losses import Losses
from thermodata.reader.text.names.time_header import unit_of_time
from thermodata.reader.times.open_questions import unit_question
from thermodata.reader.times.time_units import SECONDS, check_unit, to_ns
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted
from thermodata_reader_cnc.number_rows import everywhere, number_rows

STREAM = "trace"
_PATH = re.compile(r"[/+](?:Nck|Channel|Bag|Tool|DriveVsa|Hmi)/", re.IGNORECASE)
_MOST_ROWS = 2000
_TIME = re.compile(r"^(time|zeit|t)\b", re.IGNORECASE)
_UNIT = re.compile(r"[ _/(\[](s|sec|ms|us|µs|min|h)[)\]]?$")  # behind what else a count is called: "Tick_ms"
_LOOKED_AT = 200  # rows, for what is said of a time
EXAMPLE = b'"Time","/Nck/!SD/nckServoDataActCurr32 [u1; 1]"\n0.000,1.5\n0.002,1.6\n0.004,1.7\n'


@dataclass(frozen=True, slots=True)
class Header:
    """first: 0-based line of the first data. time: its column; seconds: of its unit, None where nobody says that;
    names: '' for columns that are none."""

    first: int
    delimiter: str
    time: int
    names: tuple[str, ...]
    width: int
    decimal: str
    seconds: float | None = 1.0


def find_header(lines: Sequence[str]) -> Header | None:
    """The header among the first lines, or None: a row of names, or a block of rows, one a signal, before the data."""
    for row, line in enumerate(lines[:_MOST_ROWS]):
        if not _PATH.search(line):
            continue
        delimiter = max(",;\t", key=re.sub(r"\[[^\]]*\]", "", line).count)
        names = [clean(c) for c in fields(line, delimiter)]
        many = sum(_PATH.search(name) is not None for name in names)
        if many == 1 and sum(_PATH.search(text) is not None for text in lines[row + 1 : row + _MOST_ROWS]) > 0:
            return _row_a_signal(lines, row, delimiter)
        data = [text for text in lines[row + 1 : row + 200] if _is_data(text, delimiter)]
        if len(names) < 2 or (len(lines) > row + 3 and not data):
            continue
        width = _width(data, delimiter) if data else len(names)
        if width < len(names) - 1:
            continue
        return _header_of(names, row + 1, delimiter, width, data)
    return None


def _width(data: Sequence[str], delimiter: str) -> int:
    return Counter(text.count(delimiter) + 1 for text in data).most_common(1)[0][0]


def _is_data(line: str, delimiter: str) -> bool:
    cells = [clean(c) for c in line.split(delimiter)]
    return is_number(cells[0]) and all(not c or is_number(c) for c in cells)


def _row_a_signal(lines: Sequence[str], row: int, delimiter: str) -> Header | None:
    """A block of one row a signal: the columns behind the time in its order, or by the ids (f1, f2, ...) of a row of
    names before the data."""
    first = next(
        (
            k
            for k in range(row, min(len(lines), row + _MOST_ROWS))
            if _is_data(lines[k], delimiter) and lines[k].count(delimiter)
        ),
        None,
    )
    if first is None:
        return None
    by_id: dict[str, str] = {}
    paths: list[str] = []
    last = row
    for number, line in enumerate(lines[row:first], row):
        cells = [clean(c) for c in fields(line, delimiter)]
        path = next((c for c in cells if _PATH.search(c)), None)
        if path is not None:
            paths.append(path)
            last = number
            by_id.update({c: path for c in cells if re.fullmatch(r"[fs]\d+", c)})
    data = [text for text in lines[first : first + 200] if _is_data(text, delimiter)]
    width = _width(data, delimiter)
    for number in range(last + 1, first):  # a damaged row of data is no row of names
        cells = [clean(c) for c in fields(lines[number], delimiter)]
        if cells[0][:1] in "0123456789+-." and cells[0] and not any(c in by_id or _TIME.match(c) for c in cells):
            first = number
            break
    columns = [clean(c) for c in fields(lines[first - 1], delimiter)]
    if len(columns) >= width - 1 and any(c in by_id for c in columns):
        names = [by_id.get(c, c) for c in columns]
    elif len(paths) in (width - 1, width - 2):  # a last delimiter makes one more
        names = ["time", *paths]
    else:
        return None
    return _header_of(names, first, delimiter, width, data)


def _header_of(names: list[str], first: int, delimiter: str, width: int, data: Sequence[str]) -> Header:
    taken: dict[str, int] = {}
    for k, name in enumerate(names):
        taken[name] = taken.get(name, 0) + 1
        names[k] = name if taken[name] == 1 or not name else f"{name}#{taken[name]}"
    time = next((k for k, name in enumerate(names) if _TIME.match(name)), 0)
    decimal = "," if delimiter != "," and any("," in text for text in data) else "."
    width = max(width, len(names))
    names = (names + [""] * width)[:width]
    return Header(first, delimiter, time, tuple(names), width, decimal, _seconds(names[time]))


def _seconds(name: str) -> float | None:
    """The unit of the time [s] by the name of its column: a trace counts seconds where that is called a time. None
    where another name says no unit."""
    unit = unit_of_time(name) or next(iter(_UNIT.findall(name)), "s" if not name or _TIME.match(name) else None)
    return None if unit is None else SECONDS.get(unit.casefold())


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    if lines and lines[0].lstrip().startswith(("{", "[")):
        return None  # JSON whose texts name paths
    return None if find_header(lines) is None else "Sinumerik Trace CSV: a column named by a path such as /Nck/..."


def _header(path: Path, source: Source) -> tuple[Header, str, bool]:
    first = sample(path, source.encoding)
    header = find_header(first.head[:-1] if first.whole and not first.ends_with_newline else first.head)
    if header is None:
        raise FormatError(
            "no header of a trace",
            where=path.name,
            expected="columns named /Nck/... or /Channel/...",
            got=first.head[0][:80] if first.head else "nothing",
            hint="export the trace with its header; another table is read with reader: table",
        )
    said = (source.table or {}).get("time") or {}
    unit = said.get("unit") if isinstance(said, Mapping) else None
    if unit is not None:
        header = replace(header, seconds=SECONDS.get(check_unit(str(unit), path.name)))
    if header.seconds is None:
        cells = (fields(line, header.delimiter) for line in first.head[header.first : header.first + _LOOKED_AT])
        values = [to_float(clean(c[header.time]), header.decimal) for c in cells if len(c) == header.width]
        raise unit_question(header.names[header.time], np.array([v for v in values if v is not None]), path.name)
    return header, first.encoding, first.ends_with_newline


def describe(path: Path, source: Source) -> Recording:
    """Signals of a trace, by its header; times are relative."""
    header, _, whole = _header(path, source)
    names = [n for k, n in enumerate(header.names) if n and k != header.time]
    return Recording(tuple(Signal(n, STREAM) for n in names), "relative", None, None if whole else False)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows in chunks of the file, and lines that do not read."""
    header, encoding, _ = _header(path, source)
    names = {name: k for k, name in enumerate(header.names) if name and k != header.time}
    losses = Losses(path.name, max(1, path.stat().st_size))
    for chunk in from_line(chunks(path, encoding), header.first):
        data, tail = split_last_line(chunk.data) if chunk.last else (chunk.data, b"")
        rows = number_rows(data, chunk.line, header.delimiter, header.decimal, ["float64"] * header.width)
        t_ns = to_ns(rows.columns[header.time], header.seconds or 1.0)
        good = t_ns != NAT
        t_ns = t_ns[good]
        for bad in rows.bad:
            row = int(np.count_nonzero(good[: rows.before(bad.line)]))
            losses.add(bad.line, f"expected {header.width} numbers, got '{bad.text[:80]}'", bad.size, row)
        if not good.all():
            first, many = int(np.argmin(good)), int((~good).sum())
            losses.add(
                int(rows.line[first]),
                f"{counted(many, 'row')} without a time, or with one that is none, from here on",
                0,
                first,
            )
        if tail:
            line = chunk.line + data.count(b"\n")
            losses.add(line, "the last row has no line end and may be cut", len(tail), t_ns.size)
        if t_ns.size:
            yield rows.block(STREAM, t_ns, names, everywhere(good))
        yield from losses.dated(t_ns)
    yield from losses.rest()


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row."""
    return line_of(blocks(path, source), stream, row)
