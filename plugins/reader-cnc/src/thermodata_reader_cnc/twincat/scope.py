"""TwinCAT Scope's text export: groups of channels, each with its own time column and rate, in one table.

A row is no instant: it holds the next sample of every group. Groups that run slower end sooner (blank or missing
cells), or are filled with copies of their last row, which are dropped.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.text.cells.values.number import to_float, to_int
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import Sample, chunks, from_line, sample
from thermodata.reader.text.file.locate import line_of
from thermodata.reader.text.file.losses import Losses
from thermodata.reader.times.time_units import EPOCHS, to_ns
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted, with_count
from thermodata_reader_cnc.number_rows import NumberRows, everywhere, number_rows, without_end
from thermodata_reader_cnc.twincat.scope_header import Header, read_header

_STARTS = re.compile(r"^Start\s?(?:time of (?:export|record)|Record)\b", re.IGNORECASE)
_TICKS = EPOCHS["filetime"]
_FAR_NS = 3_000_000_000 * 10**9  # 95 years of a recording
_SOME = 5
_SAMPLED = 100  # rows of either end, by which a step is told
_END = b"EOF"
EXAMPLE = (
    b"Name\tProject\r\nFile\tC:\\scope.svdx\r\nStartTime of export\t131000000000000000\r\n\r\nName\tx\r\n"
    b"SampleTime[ms]\t1\r\n0\t0.5\r\n1\t0.6\r\n"
)


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    if (
        lines
        and any(_STARTS.match(line) for line in lines[:20])
        and any(re.match(r"^\"?Name\"?[\t;,|]", line) for line in lines[:2])
    ):
        return "TwinCAT Scope: the header names the start of the export"
    return None


def _header(path: Path, source: Source) -> tuple[Header, Sample]:
    first = sample(path, source.encoding)
    lines = (
        first.head[:-1]
        if first.whole and not first.ends_with_newline and first.head[-1].strip() != "EOF"
        else first.head
    )
    return read_header(lines, path.name), first


def _is_complete(header: Header, first: Sample) -> bool | None:
    """True behind an EOF row; False without a line end, or where the last rows do not reach the announced end."""
    last = (first.rest or first.head)[-_SAMPLED:]
    if "EOF" in (line.strip() for line in last[-3:]):
        return True
    if not first.ends_with_newline:
        return False
    times = [ns for line in last for column in header.groups if (ns := _time(header, line, column)) is not None]
    return None if header.end_ns is None or not times or header.end_ns - max(times) <= _slack(header, first) else False


def _time(header: Header, line: str, column: int) -> int | None:
    cells = line.split(header.delimiter)
    text = clean(cells[column]) if column < len(cells) else ""
    number = to_int(text) if header.ticks else to_float(text, header.decimal)
    if number is None:
        return None
    ns = int(_to_ns(np.array([number]), header)[0])
    return None if ns == NAT else ns


def _to_ns(times: Array, header: Header) -> Int1D:
    """UTC nanoseconds of a time column, shape (n,); NAT where it holds no time of our days."""
    if header.ticks:
        ns = to_ns(times, _TICKS.seconds, _TICKS.zero_s)
        return np.where(ns > 0, ns, NAT)
    ns = to_ns(times, 1e-3)
    return np.where((ns == NAT) | (np.abs(ns) >= _FAR_NS), NAT, ns + header.start_ns)


def _slack(header: Header, first: Sample) -> int:
    """How far before the announced end the fastest group's last row may be [ns]: nearly a step, which is the header's
    or, where it names none, its rows'. Of a single row nothing tells a step, and the end itself has to be reached."""
    if header.fastest_ms:
        return round(0.9e6 * header.fastest_ms)
    begin = first.head[header.first_row : header.first_row + _SAMPLED]
    steps = [_step(header, lines, column) for lines in (begin, first.rest[-_SAMPLED:]) for column in header.groups]
    return round(0.9 * min((step for step in steps if step), default=0))


def _step(header: Header, lines: Sequence[str], column: int) -> float:
    """The median step of one time column over some rows [ns]; 0 where there is none. Repeated rows are no steps."""
    times = [ns for line in lines if (ns := _time(header, line, column)) is not None]
    steps = np.diff(times)
    steps = steps[steps > 0]
    return float(np.median(steps)) if steps.size else 0.0


def describe(path: Path, source: Source) -> Recording:
    """Channels of an export, by its header."""
    header, first = _header(path, source)
    channels = [c for each in header.groups.values() for c in each]
    notes = [first.note] if first.note else []
    scaled = [f"'{c.name}' ({c.scaling})" for c in channels if c.scaling]
    if scaled:
        notes.append(
            f"the header names a scaling for {with_count(scaled, _SOME)}; whether the values were "
            "exported with it, the file does not say: they are kept as they stand"
        )
    return Recording(
        tuple(Signal(c.name, c.stream, c.unit, c.dtype, None, c.properties) for c in channels),
        "absolute",
        header.start_ns,
        _is_complete(header, first),
        tuple(notes),
    )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows, a block a group; cells that are blank because a group ended or runs slower are no rows."""
    header, first = _header(path, source)
    dtypes = ["float64"] * header.width
    for time, channels in header.groups.items():
        dtypes[time] = "int64" if header.ticks else "float64"
        for channel in channels:
            dtypes[channel.column] = channel.dtype
    losses, groups = Losses(path.name, max(1, path.stat().st_size)), _Groups(header)
    for chunk in from_line(chunks(path, first.encoding), header.first_row):
        data, tail = without_end(chunk.data, _END)
        data = groups.padded(data, chunk.line, losses)
        rows = number_rows(data, chunk.line, header.delimiter, header.decimal, dtypes)
        longest: tuple[Int1D, Int1D] = np.empty(0, np.int64), np.empty(0, np.int64)
        for block in groups.blocks(rows, losses):
            if block.at is not None and block.at.size > longest[1].size:
                longest = block.t_ns, block.at
            yield block
        for bad in rows.bad:
            if bad.text.strip() != "EOF":
                row = int(np.searchsorted(longest[1], bad.line + 1))
                losses.add(bad.line, f"expected {header.width} numbers, got '{bad.text[:80]}'", bad.size, row)
        if tail:
            text, line = tail.decode("utf-8", "replace"), chunk.line + data.count(b"\n")
            reason = f"the last row has no line end and may be cut: '{text[:60]}'"
            losses.add(line, reason, len(tail), longest[1].size)
        yield from losses.dated(longest[0])
    yield from losses.rest()
    yield from groups.missing(path.name, _is_complete(header, first), _slack(header, first))


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row."""
    return line_of(blocks(path, source), stream, row)


class _Groups:
    """The groups of one export, with what is carried from part to part."""

    def __init__(self, header: Header) -> None:
        self.header = header
        self.width = header.width  # of the rows by now: it only shrinks, as groups end
        self.starts = sorted(header.groups)
        self.last: dict[int, tuple[int, list[object]]] = {}
        self.last_row: list[object] | None = None
        self.reached: int | None = None

    def padded(self, data: bytes, line: int, losses: Losses) -> bytes:
        """Rows that end where a group begins, for the groups from there on have no more samples, filled up."""
        mark = self.header.delimiter.encode()
        full = self.header.width - 1
        if data.count(mark) == full * data.count(b"\n"):
            return data
        done = []
        for number, text in enumerate(data.split(b"\n")):
            row = text.rstrip(b"\r")
            count = row.count(mark)
            if count > full and row.endswith(mark) and not row[:-1].count(mark) > full:
                row = row[:-1]  # older exports end their rows with a delimiter
            elif (
                count < full
                and row.strip()
                and (count + 1 in self.starts or (count in self.starts and row.endswith(mark)))
            ):
                cells = count + 1 if count + 1 in self.starts else count
                if cells > self.width:
                    losses.add(line + number, f"expected {self.width} cells as in the rows before, got {cells}", 0, 0)
                self.width = cells
                row += mark * (full - count)
            elif count == full and self.width < self.header.width and row.strip():
                losses.add(line + number, "rows before this one lack the cells of groups that go on here", 0, 0)
                self.width = self.header.width
            done.append(row)
        return b"\n".join(done)

    def blocks(self, rows: NumberRows, losses: Losses) -> Iterator[Block]:
        """A block a group, of the rows of one part."""
        twice = self._rows_written_twice(rows)
        for time, channels in self.header.groups.items():
            blank = rows.empty[time]
            there = ~blank
            for channel in channels:
                if channel.dtype != "float64":
                    there &= ~rows.empty[channel.column]
            lost = ~blank & ~there
            for channel in channels:
                if not lost.any() and blank.any():
                    lost = lost | (blank & ~rows.empty[channel.column])
            if lost.any():
                line = int(rows.line[np.argmax(lost)])
                losses.add(line, f"{counted(int(lost.sum()), 'row')} of '{channels[0].name}' with a blank cell", 0, 0)
            t_ns = _to_ns(rows.columns[time], self.header)
            good = there & (t_ns != NAT)
            if (there & ~good).any():
                line = int(rows.line[np.argmax(there & ~good)])
                losses.add(line, f"{counted(int((there & ~good).sum()), 'row')} whose time is none", 0, 0)
            if not good.any():
                continue
            names = {c.name: c.column for c in channels}
            block = rows.block(channels[0].stream, t_ns[good], names, everywhere(good))
            fresh = self._fresh(time, block.t_ns, block.values) | twice[good]
            if fresh.any():
                latest = int(block.t_ns.max())
                self.reached = latest if self.reached is None else max(latest, self.reached)
                yield block if fresh.all() else _some_rows(block, fresh)

    def _rows_written_twice(self, rows: NumberRows) -> Bool1D:
        """The rows that stand twice, shape (n,): all groups of them repeat, where one that is slow repeats alone."""
        twice = np.ones(rows.n, bool)
        before, self.last_row = self.last_row, [column[-1] for column in rows.columns] if rows.n else self.last_row
        for k, column in enumerate(rows.columns if rows.n else ()):
            twice[1:] &= _are_same(column[1:], column[:-1])
            twice[0] = twice[0] and before is not None and bool(_are_same(column[:1], np.asarray([before[k]]))[0])
        return twice

    def _fresh(self, time: int, t_ns: Int1D, values: Mapping[str, Array]) -> Bool1D:
        """The rows that are no exact copies of the row before them."""
        same = np.zeros(t_ns.size, bool)
        same[1:] = np.diff(t_ns) == 0
        before = self.last.get(time)
        same[0] = before is not None and before[0] == t_ns[0]
        for k, column in enumerate(values.values()):
            same[1:] &= _are_same(column[1:], column[:-1])
            same[0] = same[0] and before is not None and bool(before[1][k] == column[0])
        self.last[time] = int(t_ns[-1]), [column[-1] for column in values.values()]
        result: Bool1D = ~same
        return result

    def missing(self, name: str, complete: bool | None, slack: int) -> Iterator[Loss]:
        """What the header announces more than `slack` [ns] behind the last row, where no EOF says that this is all."""
        end, reached = self.header.end_ns, self.reached
        if complete is True or end is None or end - (reached or self.header.start_ns) <= slack:
            return
        first = self.header.start_ns if reached is None else reached
        whole = max(1, end - self.header.start_ns)
        gone = min(1.0, max(0.0, (end - first) / whole))
        yield Loss(
            f"{name} end",
            max(first, self.header.start_ns),
            max(end, first),
            gone,
            "the header announces a later end of the export than its rows reach",
        )


def _are_same(one: Array, other: Array) -> Bool1D:
    """Where two columns hold the same, NaN being NaN."""
    same: Bool1D = (one == other) | ((one != one) & (other != other))
    return same


def _some_rows(block: Block, rows: Bool1D) -> Block:
    """Some rows of a block."""
    assert block.at is not None
    flags = None if block.flags is None else {name: f[rows] for name, f in block.flags.items()}
    return Block(
        block.stream, block.t_ns[rows], {name: v[rows] for name, v in block.values.items()}, flags, block.at[rows]
    )
