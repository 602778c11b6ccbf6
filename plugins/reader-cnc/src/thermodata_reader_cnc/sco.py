"""Recordings of Heidenhain's TNCscope: blocks `%[NAME]` of `%KEY=value` that a lone `%` ends, then rows of numbers.

Each curve has its own count and cycle time [us]; curves of one cycle time are a stream. A first column that is no curve
counts the rows (or their time), so that a missing one shows. Times are relative, or absolute where the global block
names a date and a time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Signal, Source
from thermodata_reader_cnc.chunks import Sample, chunks, sample
from thermodata_reader_cnc.halves import BadLine, Grid
from thermodata_reader_cnc.losses import Losses
from thermodata_reader_cnc.scoheader import Curve, Header, read_header

_FAR = 1 << 20  # rows that the first column may skip


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    if any(line.startswith("%[CURVE") for line in lines[:500]) or lines[0].startswith("%[GLOBAL]"):
        return "TNCscope: blocks %[GLOBAL], %[CURVE...]"
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
    return Recording(
        signals,
        "relative" if relative else "absolute",
        0 if relative else header.start_ns,
        None if first.ends_with_newline else False,
        tuple(notes),
    )


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
                    rows.next += 1  # its time has passed all the same
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
                odd = (
                    np.isfinite(tail)
                    & (tail != 0)
                    & (tail != column[0] if place[0] >= curve.count else tail != column[place < curve.count][-1])
                )
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
                yield Loss(
                    where,
                    fraction=1 - self.seen[curve.name] / curve.count,
                    reason=(f"the header announces {curve.count} values, the file holds {self.seen[curve.name]}"),
                )
            if self.behind[curve.name]:
                yield Loss(
                    where, reason=f"{self.behind[curve.name]} values behind the announced {curve.count} are not read"
                )
