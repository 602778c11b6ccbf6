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
from thermodata.reader.text.file.lines import Sample, chunks, from_line, sample
from thermodata.reader.text.file.locate import line_of
from thermodata.reader.text.file.losses import Losses
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_cnc.heidenhain.sco_header import Curve, Header, read_header
from thermodata_reader_cnc.number_rows import NumberRows, number_rows, without_end

_FAR = 1 << 20  # rows that the first column may skip
_END = b"%"  # alone, it may end the rows
EXAMPLE = b"%[GLOBAL]\r\n%VERSION=1\r\n%\r\n%[CURVE1]\r\n%CHANNELTYPE=1\r\n%\r\n%[DATA]\r\n0;1;2\r\n"


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
        header.start_ns,
        None if first.ends_with_newline else False,
        tuple(notes),
    )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows, a block a stream; a curve that ends before the others of its stream is NaN from there."""
    header, first = _header(path, source)
    losses, recording = Losses(path.name, max(1, path.stat().st_size)), _Rows(header)
    for chunk in from_line(chunks(path, first.encoding), header.first_row):
        data, tail = without_end(chunk.data, _END)
        rows = number_rows(data, chunk.line, ";", header.decimal, ["float64"] * header.width)
        bad = tuple(each for each in rows.bad if each.text.strip() != "%")
        for each in bad:
            losses.add(each.line, f"expected {header.width} numbers, got '{each.text[:80]}'", each.size, 0)
        if tail:
            line = chunk.line + data.count(b"\n")
            losses.add(line, "the last row has no line end and may be cut", len(tail), 0)
        if rows.n:
            yield from recording.blocks(rows, [each.line for each in bad], losses)
        yield from losses.dated(np.empty(0, np.int64))
    yield from losses.rest()
    yield from recording.missing(path.name)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row."""
    return line_of(blocks(path, source), stream, row)


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

    def blocks(self, rows: NumberRows, bad: Sequence[int], losses: Losses) -> Iterator[Block]:
        """The blocks of consecutive rows. bad: lines of rows that do not read: their time has passed all the same."""
        place = self._places(rows, np.array(bad, np.int64), losses)
        for members in self.streams.values():
            block = self._block(members, rows, place)
            if block is not None:
                yield block
        self.next = int(place.max()) + 1 + sum(line > int(rows.line[-1]) for line in bad)

    def _places(self, rows: NumberRows, bad: Int1D, losses: Losses) -> Int1D:
        """The number of each row from 0: by the first column where it counts, else by their order."""
        first, step = rows.columns[0], self.header.step
        in_order: Int1D = self.next + np.arange(rows.n, dtype=np.int64) + np.searchsorted(bad, rows.line)
        if step is None or not np.isfinite(first).all():
            return in_order
        if self.origin is None:
            self.origin = float(first[0]) - int(in_order[0]) * step
        counted = (first - self.origin) / step
        odd = np.abs(counted - np.round(counted)) >= 0.25
        odd |= (counted < self.next - 1) | (counted > in_order[-1] + 1 + _FAR)
        if odd.any():
            line = int(rows.line[np.argmax(odd)])
            losses.add(line, "the first column does not count the rows on evenly; they are taken in their order", 0, 0)
            self.header = replace(self.header, step=None)
            return in_order
        place: Int1D = np.round(counted).astype(np.int64)
        steps = np.diff(place, prepend=self.next - 1) != np.diff(in_order, prepend=self.next - 1)
        if steps.any():
            line = int(rows.line[np.argmax(steps)])
            losses.add(line, "the first column shows that rows are missing or repeated", 0, 0)
        return place

    def _block(self, members: list[Curve], rows: NumberRows, place: Int1D) -> Block | None:
        there = np.zeros(place.size, bool)
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        for curve in members:
            column = rows.columns[curve.column]
            if rows.over[curve.column].any():
                flags[curve.name] = rows.over[curve.column] * np.uint16(Flag.SATURATED)
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
        t_ns = (self.header.start_ns or 0) + place * members[0].cycle_ns
        return Block(members[0].stream, t_ns, values, flags or None, rows.line + 1).part(0, stop)

    def missing(self, name: str) -> Iterator[Loss]:
        """Where a curve's values are not as many as its header announces."""
        for curve in self.header.curves:
            where = f"{name} curve '{curve.name}'"
            if curve.count is not None and self.seen[curve.name] < curve.count:
                yield Loss(
                    where,
                    fraction=1 - self.seen[curve.name] / curve.count,
                    reason=(
                        f"the header announces {counted(curve.count, 'value')}, the file holds {self.seen[curve.name]}"
                    ),
                )
            if self.behind[curve.name]:
                yield Loss(
                    where,
                    reason=f"{counted(self.behind[curve.name], 'value')} behind the announced {curve.count}: not read",
                )
