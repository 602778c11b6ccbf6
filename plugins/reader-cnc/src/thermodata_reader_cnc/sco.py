"""Recordings of Heidenhain's TNCscope: blocks `%[NAME]` of `%KEY=value` that a lone `%` ends, then rows of numbers.

Each curve has its own count and cycle time [us]; curves of one cycle time are a stream. Times are relative, or
absolute where the global block names a date and a time.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Recording, Scaling, Signal, Source
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import when
from thermodata_reader_cnc.chunks import chunks, sample
from thermodata_reader_cnc.halves import BadLine, Grid
from thermodata_reader_cnc.localclock import LocalClock
from thermodata_reader_cnc.losses import Losses

_BLOCK = re.compile(r"^%\[(\w+?)\s*(\d*)\]")
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
    curves: tuple[Curve, ...]
    start_ns: int | None
    first_row: int
    width: int
    decimal: str


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
    data = [line for line in lines[first:first + 500] if line.strip() and not line.startswith("%")]
    width = max((line.count(";") + 1 for line in data), default=len(found))
    index = width - len(found) if not all(line.endswith(";") for line in data) else 0
    if width not in (len(found), len(found) + 1):
        raise FormatError("columns do not fit the curves", where=f"{where} line {first + 1}",
                          expected=f"{len(found)} columns, or one more for an index", got=str(width))
    curves, taken = [], dict[str, int]()
    for k, keys in enumerate(found):
        cycle = _number(keys.get("CYCLETIME"), where)
        if not cycle or cycle <= 0:
            raise FormatError("a curve without a cycle time", where=f"{where} curve {k + 1}",
                              expected="%CYCLETIME= in us", got=keys.get("CYCLETIME", "nothing"))
        kind = " ".join(filter(None, (keys.get("CHANNELTYPE"), keys.get("AXISTYPE"))))
        name = keys.get("NAME") or kind or f"curve {k + 1}"
        taken[name] = taken.get(name, 0) + 1
        name += f"#{taken[name]}" if taken[name] > 1 else ""
        count = _number(keys.get("COUNT"), where)
        curves.append(Curve(k + index, name, f"scope_{cycle:g}us", keys.get("DIMENSION") or None,
                            None if count is None else int(count), round(cycle * 1000), _scaling(keys, where), keys))
    shared = next((keys for name, keys in blocks if name == "GLOBAL"), {})
    decimal = "," if any("," in line for line in data) else "."
    return Header(tuple(curves), _start(shared, source), first, width, decimal)


def _number(text: str | None, where: str) -> float | None:
    if not text:
        return None
    try:
        return float(text.replace(",", "."))
    except ValueError:
        raise FormatError("a header value is no number", where=where, expected="a number", got=text) from None


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


def _header(path: Path, source: Source) -> tuple[Header, str, bool]:
    first = sample(path, source.encoding)
    return read_header(first.head, path.name, source), first.encoding, first.ends_with_newline


def describe(path: Path, source: Source) -> Recording:
    """Curves of a recording, by its header."""
    header, _, whole = _header(path, source)
    signals = tuple(Signal(c.name, c.stream, c.unit, "float64", c.scaling, c.properties) for c in header.curves)
    relative = header.start_ns is None
    return Recording(signals, "relative" if relative else "absolute", 0 if relative else header.start_ns,
                     None if whole else False)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows, a block a stream; a curve that ends before the others of its stream is NaN from there."""
    header, encoding, _ = _header(path, source)
    grid = Grid(";", header.decimal, ["float64"] * header.width)
    losses, row = Losses(path.name, max(1, path.stat().st_size)), 0
    streams: dict[str, list[Curve]] = {}
    for curve in header.curves:
        streams.setdefault(curve.stream, []).append(curve)
    seen = dict.fromkeys((c.name for c in header.curves), 0)
    for chunk in chunks(path, encoding):
        data, line = chunk.data, chunk.line
        while line < header.first_row and data:
            cut = data.find(b"\n") + 1 or len(data)
            data, line = data[cut:], line + 1
        if chunk.last and not data.endswith(b"\n") and data:
            cut = data.rfind(b"\n") + 1
            if data[cut:].strip() not in (b"", b"%"):
                losses.add(line + data.count(b"\n"), "the last row has no line end and may be cut", len(data) - cut, 0)
            data = data[:cut]
        for part in grid.parts(data, line):
            if isinstance(part, BadLine):
                if part.text.strip() not in ("", "%"):
                    losses.add(part.line, f"expected {header.width} numbers, got '{part.text[:80]}'", len(part.text), 0)
                    row += 1                             # its time has passed all the same
                continue
            for members in streams.values():
                block = _block(header, members, part.columns, row, seen)
                if block is not None:
                    yield block
            row += len(part.columns[0])
        yield from losses.dated(np.empty(0, np.int64))
    yield from losses.rest()
    for curve in header.curves:
        if curve.count is not None and seen[curve.name] < curve.count:
            yield Loss(f"{path.name} curve '{curve.name}'", fraction=1 - seen[curve.name] / curve.count,
                       reason=f"the header announces {curve.count} values, the file holds {seen[curve.name]}")


def _block(header: Header, members: list[Curve], columns: Sequence[Array], row: int,
           seen: dict[str, int]) -> Block | None:
    there = np.zeros(len(columns[0]), bool)
    for curve in members:
        finite = np.isfinite(columns[curve.column])
        seen[curve.name] += int(finite.sum())
        there |= finite
    if not there.any():
        return None
    stop = int(np.flatnonzero(there)[-1]) + 1
    t_ns = (header.start_ns or 0) + (row + np.arange(stop, dtype=np.int64)) * members[0].cycle_ns
    return Block(members[0].stream, t_ns, {c.name: columns[c.column][:stop] for c in members})
