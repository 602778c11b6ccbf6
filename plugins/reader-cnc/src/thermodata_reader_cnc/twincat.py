"""TwinCAT Scope's text export: groups of channels, each with its own time column and rate, in one table.

A row is no instant: it holds the next sample of every group. Groups that run slower end sooner (blank or missing
cells), or are filled with copies of their last row, which are dropped.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Loss, Recording, Signal, Source
from thermodata_reader_cnc.chunks import Sample, chunks, sample
from thermodata_reader_cnc.halves import BadLine, Grid, Numbers
from thermodata_reader_cnc.losses import Losses
from thermodata_reader_cnc.twincatheader import Header, read_header

_STARTS = re.compile(r"^Start\s?(?:time of (?:export|record)|Record)\b", re.IGNORECASE)
_EPOCH_TICKS = 116_444_736_000_000_000
_FAR_MS = 3e12  # 95 years of a recording
_SOME = 5


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


def _complete(header: Header, first: Sample) -> bool | None:
    """True behind an EOF row; False without a line end, or where the last rows do not reach the announced end."""
    last = (first.rest or first.head)[-100:]
    if "EOF" in (line.strip() for line in last[-3:]):
        return True
    if not first.ends_with_newline:
        return False
    times = [ns for line in last for column in header.groups if (ns := _time(header, line, column)) is not None]
    return None if header.end_ns is None or not times or header.end_ns - max(times) <= _slack(header) else False


def _time(header: Header, line: str, column: int) -> int | None:
    cells = line.split(header.delimiter)
    text = cells[column].strip().strip('"').replace(",", ".") if column < len(cells) else ""
    if not re.fullmatch(r"[+-]?\d{1,20}(?:\.\d{0,20})?", text):
        return None
    if header.ticks:
        return (int(text.split(".")[0]) - _EPOCH_TICKS) * 100
    return header.start_ns + round(float(text) * 1e6)


def _slack(header: Header) -> int:
    """How far before the announced end the fastest group's last row may be [ns]."""
    return round(0.9e6 * header.fastest_ms) if header.fastest_ms else 10_000_000


def describe(path: Path, source: Source) -> Recording:
    """Channels of an export, by its header."""
    header, first = _header(path, source)
    channels = [c for each in header.groups.values() for c in each]
    notes = [first.note] if first.note else []
    scaled = [f"'{c.name}' ({c.scaling})" for c in channels if c.scaling]
    if scaled:
        more = f" and {len(scaled) - _SOME} more" if len(scaled) > _SOME else ""
        notes.append(
            f"the header names a scaling for {', '.join(scaled[:_SOME])}{more}; whether the values were "
            "exported with it, the file does not say: they are kept as they stand"
        )
    return Recording(
        tuple(Signal(c.name, c.stream, c.unit, c.dtype, None, c.properties) for c in channels),
        "absolute",
        header.start_ns,
        _complete(header, first),
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
    grid = Grid(header.delimiter, header.decimal, dtypes)
    losses, rows = Losses(path.name, max(1, path.stat().st_size)), _Rows(header)
    for chunk in chunks(path, first.encoding):
        data, line = chunk.data, chunk.line
        while line < header.first_row and data:
            cut = data.find(b"\n") + 1 or len(data)
            data, line = data[cut:], line + 1
        tail = b""
        if not data.endswith(b"\n"):
            cut = data.rfind(b"\n") + 1
            data, tail = data[:cut], data[cut:]
        last = np.empty(0, np.int64)
        for part in grid.parts(rows.padded(data, line, losses).replace(b'"', b""), line):
            if isinstance(part, BadLine):
                if part.text.strip() not in ("", "EOF"):
                    losses.add(part.line, f"expected {header.width} numbers, got '{part.text[:80]}'", len(part.text), 0)
                continue
            for block in rows.blocks(part, line, losses):
                last = block.t_ns
                yield block
        if tail.strip() not in (b"", b"EOF"):
            text = tail.decode("utf-8", "replace")
            losses.add(
                line + data.count(b"\n"),
                f"the last row has no line end and may be cut: '{text[:60]}'",
                len(tail),
                last.size,
            )
        yield from losses.dated(last)
    yield from losses.rest()
    yield from rows.missing(path.name, _complete(header, first))


class _Rows:
    """Rows of one export, with what is carried from part to part."""

    def __init__(self, header: Header) -> None:
        self.header = header
        self.width = header.width  # of the rows by now: it only shrinks, as groups end
        self.starts = sorted(header.groups)
        self.last: dict[int, tuple[int, list[object]]] = {}
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

    def blocks(self, part: Numbers, line: int, losses: Losses) -> Iterator[Block]:
        """A block a group of the rows of one part."""
        for time, channels in self.header.groups.items():
            there = part.there[time]
            for channel in channels:
                if channel.dtype != "float64":
                    there = there & part.there[channel.column]
            lost = part.there[time] ^ there
            for channel in channels:
                if not lost.any() and not part.there[time].all():
                    holds = part.there[channel.column] & _holds(part.columns[channel.column])
                    lost = lost | (~part.there[time] & holds)
            if lost.any():
                losses.add(line, f"{int(lost.sum())} rows of '{channels[0].name}' with a blank cell", 0, 0)
            times = part.columns[time]
            good = there & (
                np.abs(times) < _FAR_MS
                if not self.header.ticks
                else (times > _EPOCH_TICKS) & (times < 2 * _EPOCH_TICKS)
            )
            if int((there & ~good).sum()) and (self.header.ticks or np.isfinite(times[there & ~good]).any()):
                losses.add(line, f"{int((there & ~good).sum())} rows whose time is none", 0, 0)
            if not good.any():
                continue
            t_ns = (
                (times[good] - _EPOCH_TICKS) * 100
                if self.header.ticks
                else self.header.start_ns + np.round(times[good] * 1e6).astype(np.int64)
            )
            values = {c.name: part.columns[c.column][good] for c in channels}
            fresh = self._fresh(time, t_ns, values)
            if fresh.any():
                self.reached = max(int(t_ns.max()), t_ns.min() if self.reached is None else self.reached)
                yield Block(channels[0].stream, t_ns[fresh], {name: v[fresh] for name, v in values.items()})

    def _fresh(self, time: int, t_ns: Array, values: dict[str, Array]) -> Bool1D:
        """The rows that are no exact copies of the row before them."""
        same = np.zeros(t_ns.size, bool)
        same[1:] = np.diff(t_ns) == 0
        before = self.last.get(time)
        same[0] = before is not None and before[0] == t_ns[0]
        for k, column in enumerate(values.values()):
            equal = (column[1:] == column[:-1]) | ((column[1:] != column[1:]) & (column[:-1] != column[:-1]))
            same[1:] &= equal
            same[0] = same[0] and before is not None and bool(before[1][k] == column[0])
        self.last[time] = int(t_ns[-1]), [column[-1] for column in values.values()]
        result: Bool1D = ~same
        return result

    def missing(self, name: str, complete: bool | None) -> Iterator[Loss]:
        """What the header announces behind the last row, where no EOF says that this is all."""
        end, reached = self.header.end_ns, self.reached
        if complete is True or end is None or end - (reached or self.header.start_ns) <= _slack(self.header):
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


def _holds(column: Array) -> Bool1D:
    result: Bool1D = np.isfinite(column) if column.dtype.kind == "f" else np.ones(column.size, bool)
    return result
