"""Recordings of Heidenhain's TNCscope: blocks `%[NAME]` of `%KEY=value` that a lone `%` ends, then rows of numbers.

Each curve has its own count and cycle time [us]; curves of one cycle time are a stream. A first column that is no curve
counts the rows (or their time), so that a missing one shows. Times are relative, or absolute where the global block
names a date and a time.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Scaling, Signal, Source
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import when
from thermodata_reader_cnc.chunks import Sample, chunks, sample
from thermodata_reader_cnc.halves import BadLine, Grid
from thermodata_reader_cnc.localclock import LocalClock
from thermodata_reader_cnc.losses import Losses

_FAR = 1 << 20                # rows that the first column may skip
_BLOCK = re.compile(r"^%\[([A-Za-z]+)[\s_]*(\d*)\]")
_KEY = re.compile(r"^%\s*([A-Za-z_ ]+?)\s*=\s*(.*)$")


@dataclass(frozen=True, slots=True)
class Curve:
    """count: rows that the header announces, None where it does not."""

    column: int
    name: str
    stream: str
    unit: str | None
    count: int | None
    cycle_ns: int
    scaling: Scaling | None
    properties: dict[str, str]


@dataclass(frozen=True, slots=True)
class Header:
    """width: cells of a row, a blank one behind a last ';' too. step: by how much the first column grows from row to
    row, None where it counts nothing."""

    curves: tuple[Curve, ...]
    start_ns: int | None
    first_row: int
    width: int
    decimal: str
    step: float | None


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    if any(line.startswith("%[CURVE") for line in lines[:500]) or lines[0].startswith("%[GLOBAL]"):
        return "TNCscope: blocks %[GLOBAL], %[CURVE...]"
    return None


def read_header(lines: Sequence[str], where: str, source: Source) -> Header:
    """Curves and start; FormatError for a header that cannot be used."""
    blocks: list[tuple[str, dict[str, str]]] = []
    first = None
    for number, line in enumerate(lines):
        if match := _BLOCK.match(line):
            if match[1].upper() == "DATA":
                first = number + 1
                break
            blocks.append((match[1].upper(), {}))
        elif blocks and (match := _KEY.match(line)):
            blocks[-1][1][match[1].strip().upper()] = match[2].strip().strip('"')
    found = [keys for name, keys in blocks if name == "CURVE"]
    if first is None or not found:
        raise FormatError("no curves or no data", where=where, expected="%[CURVE...] blocks, then %[DATA]",
                          got=", ".join(name for name, _ in blocks) or "nothing")
    data = [line.rstrip() for line in lines[first:first + 500] if line.strip() and not line.startswith("%")]
    width = Counter(line.count(";") + 1 for line in data).most_common(1)[0][0] if data else len(found)
    cells = width - 1 if data and sum(line.endswith(";") for line in data) > 0.9 * len(data) and width > len(found) \
        else width
    index = cells - len(found)
    if index not in (0, 1):
        raise FormatError("columns do not fit the curves", where=f"{where} line {first + 1}",
                          expected=f"{len(found)} columns, or one more for an index", got=str(cells))
    curves, taken = [], dict[str, int]()
    for k, keys in enumerate(found):
        cycle = _number(keys.get("CYCLETIME"), where)
        if not cycle or not 1e-3 <= cycle <= 1e12:
            raise FormatError("a curve without a cycle time", where=f"{where} curve {k + 1}",
                              expected="%CYCLETIME= in us", got=keys.get("CYCLETIME", "nothing"))
        kind = " ".join(filter(None, (keys.get("CHANNELTYPE"), keys.get("AXISTYPE"))))
        name = keys.get("NAME") or kind or f"curve {k + 1}"
        taken[name] = taken.get(name, 0) + 1
        name += f"#{taken[name]}" if taken[name] > 1 else ""
        count = _number(keys.get("COUNT"), where)
        if count is not None and not 0 <= count < 1e15:
            raise FormatError("a curve with an impossible count", where=f"{where} curve {k + 1}",
                              expected="%COUNT= of values", got=keys["COUNT"][:40])
        curves.append(Curve(k + index, name, f"scope_{cycle:g}us", keys.get("DIMENSION") or None,
                            None if count is None else int(count), round(cycle * 1000), _scaling(keys, where), keys))
    shared = next((keys for name, keys in blocks if name == "GLOBAL"), {})
    decimal = "," if any("," in line for line in data) else "."
    step = _step([line.split(";")[0].replace(",", ".") for line in data]) if index else None
    return Header(tuple(curves), _start(shared, source), first, width, decimal, step)


def _step(cells: Sequence[str]) -> float | None:
    """By how much the first column grows from row to row; None where it does not do so evenly."""
    try:
        values = np.array(cells, np.float64)
    except ValueError:
        return None
    if values.size < 3 or not np.isfinite(values).all():
        return None
    step = float(np.median(np.diff(values)))
    return step if step > 0 and np.mean(np.abs(np.diff(values) / step - 1) < 0.01) > 0.5 else None


def _number(text: str | None, where: str) -> float | None:
    if not text:
        return None
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        raise FormatError("a header value is no number", where=where, expected="a number", got=text[:40]) from None
    return value if np.isfinite(value) else None


def _scaling(keys: dict[str, str], where: str) -> Scaling | None:
    gain, offset = _number(keys.get("FACTOR") or keys.get("SCALE"), where), _number(keys.get("OFFSET"), where)
    if gain in (None, 1.0) and not offset:
        return None
    return Scaling("linear", {"gain": 1.0 if gain is None else gain, "offset": offset or 0.0})


def _start(shared: dict[str, str], source: Source) -> int | None:
    """UTC start by the global block's date and time; None where it has none that reads."""
    for order in ("dmy", "ymd"):
        day = when.parse_one(shared.get("DATE", ""), when.DATE[order])
        clock = when.parse_one(shared.get("TIME", ""), when.TIME_OF_DAY)
        if NAT not in (day, clock):
            return int(LocalClock(source.timezone).utc(np.array([day + clock]))[0])
    return None


def _header(path: Path, source: Source) -> tuple[Header, Sample]:
    first = sample(path, source.encoding)
    lines = first.head[:-1] if first.whole and not first.ends_with_newline else first.head
    return read_header(lines, path.name, source), first


def describe(path: Path, source: Source) -> Recording:
    """Curves of a recording, by its header."""
    header, first = _header(path, source)
    signals = tuple(Signal(c.name, c.stream, c.unit, "float64", c.scaling, c.properties) for c in header.curves)
    relative = header.start_ns is None
    notes = [first.note] if first.note else []
    if not relative and source.timezone is None:
        notes.append("no time zone declared: times are taken as UTC")
    return Recording(signals, "relative" if relative else "absolute", 0 if relative else header.start_ns,
                     None if first.ends_with_newline else False, tuple(notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows, a block a stream; a curve that ends before the others of its stream is NaN from there."""
    header, first = _header(path, source)
    grid = Grid(";", header.decimal, ["float64"] * header.width)
    losses, rows = Losses(path.name, max(1, path.stat().st_size)), _Rows(header)
    for chunk in chunks(path, first.encoding):
        data, line = chunk.data, chunk.line
        while line < header.first_row and data:
            cut = data.find(b"\n") + 1 or len(data)
            data, line = data[cut:], line + 1
        if not data.endswith(b"\n") and data:
            cut = data.rfind(b"\n") + 1
            if data[cut:].strip() not in (b"", b"%"):
                losses.add(line + data.count(b"\n"), "the last row has no line end and may be cut", len(data) - cut, 0)
            data = data[:cut]
        for part in grid.parts(data, line):
            if isinstance(part, BadLine):
                if part.text.strip() not in ("", "%"):
                    losses.add(part.line, f"expected {header.width} numbers, got '{part.text[:80]}'", len(part.text), 0)
                    rows.next += 1                       # its time has passed all the same
                continue
            yield from rows.blocks(part.columns, line, losses)
        yield from losses.dated(np.empty(0, np.int64))
    yield from losses.rest()
    yield from rows.missing(path.name)


class _Rows:
    """Rows of one recording: where each stands in time, and how many values each curve had."""

    def __init__(self, header: Header) -> None:
        self.header = header
        self.next = 0
        self.origin: float | None = None
        self.seen = dict.fromkeys((c.name for c in header.curves), 0)
        self.behind = dict.fromkeys((c.name for c in header.curves), 0)
        self.streams: dict[str, list[Curve]] = {}
        for curve in header.curves:
            self.streams.setdefault(curve.stream, []).append(curve)

    def blocks(self, columns: Sequence[Array], line: int, losses: Losses) -> Iterator[Block]:
        """The blocks of consecutive rows."""
        place = self._places(columns, line, losses)
        for members in self.streams.values():
            block = self._block(members, columns, place)
            if block is not None:
                yield block
        self.next = int(place.max()) + 1

    def _places(self, columns: Sequence[Array], line: int, losses: Losses) -> Int1D:
        """The number of each row from 0: by the first column where it counts, else by their order."""
        n = columns[0].size
        step = self.header.step
        if step is None or not np.isfinite(columns[0]).all():
            return self.next + np.arange(n, dtype=np.int64)
        if self.origin is None:
            self.origin = float(columns[0][0])
        counted = (columns[0] - self.origin) / step
        even = np.abs(counted - np.round(counted)) < 0.25
        if not even.all() or counted.min() < self.next - 1 or counted.max() > self.next + n + _FAR:
            losses.add(line, "the first column does not count the rows on evenly; they are taken in their order", 0, 0)
            self.header = replace(self.header, step=None)
            return self.next + np.arange(n, dtype=np.int64)
        place: Int1D = np.round(counted).astype(np.int64)
        if (np.diff(place, prepend=self.next - 1) != 1).any():
            losses.add(line, "the first column shows that rows are missing or repeated", 0, 0)
        return place

    def _block(self, members: list[Curve], columns: Sequence[Array], place: Int1D) -> Block | None:
        there = np.zeros(place.size, bool)
        values: dict[str, Array] = {}
        for curve in members:
            column = columns[curve.column]
            if curve.count is not None and (place >= curve.count).any():
                tail = column[place >= curve.count]
                odd = np.isfinite(tail) & (tail != 0) & (tail != column[0] if place[0] >= curve.count else
                                                         tail != column[place < curve.count][-1])
                self.behind[curve.name] += int(odd.sum())
                column = np.where(place < curve.count, column, np.nan)
            finite = np.isfinite(column)
            self.seen[curve.name] += int(finite.sum())
            there |= finite
            values[curve.name] = column
        if not there.any():
            return None
        stop = int(np.flatnonzero(there)[-1]) + 1
        t_ns = (self.header.start_ns or 0) + place[:stop] * members[0].cycle_ns
        return Block(members[0].stream, t_ns, {name: column[:stop] for name, column in values.items()})

    def missing(self, name: str) -> Iterator[Loss]:
        """Where a curve's values are not as many as its header announces."""
        for curve in self.header.curves:
            where = f"{name} curve '{curve.name}'"
            if curve.count is not None and self.seen[curve.name] < curve.count:
                yield Loss(where, fraction=1 - self.seen[curve.name] / curve.count, reason=(
                    f"the header announces {curve.count} values, the file holds {self.seen[curve.name]}"))
            if self.behind[curve.name]:
                yield Loss(where, reason=f"{self.behind[curve.name]} values behind the announced {curve.count} are not "
                                         "read")
