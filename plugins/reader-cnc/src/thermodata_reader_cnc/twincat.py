"""TwinCAT Scope's text export: groups of channels, each with its own time column and rate, in one table.

The header's rows repeat their key where a group begins; in the data that column is the group's time [ms]. Values
are exported scaled, so the header's factors are history and no scaling.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata_reader_cnc.chunks import chunks, sample
from thermodata_reader_cnc.halves import BadLine, Grid, Numbers
from thermodata_reader_cnc.losses import Losses

_START = re.compile(r"^Start\s?time of (?:export|record)\s*[\t;,]\s*(\d{17,19})", re.IGNORECASE)
_EPOCH_100NS = 116_444_736_000_000_000       # from 1601-01-01 to 1970-01-01
_ROWS = frozenset({"SymbolComment", "Data-Type", "SampleTime[ms]", "VariableSize", "SymbolBased", "IndexGroup",
                   "IndexOffset", "SymbolName", "NetID", "NetId", "Port", "Offset", "ScaleFactor", "BitMask", "Unit",
                   "Unit ScaleFactor", "Unit Offset"})
_DATA = re.compile(r"^\s*-?\d")
_INTEGERS = re.compile(r"^(U?)(?:INT|SINT|DINT|LINT)(\d*)$|^BYTE$|^WORD$|^DWORD$")


@dataclass(frozen=True, slots=True)
class Channel:
    column: int
    name: str
    stream: str
    unit: str | None
    dtype: str
    properties: dict[str, str]


@dataclass(frozen=True, slots=True)
class Header:
    """first_row: 0-based line of the first data row. groups: time column -> its channels."""

    start_ns: int
    delimiter: str
    decimal: str
    width: int
    first_row: int
    groups: dict[int, list[Channel]]


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    if lines and lines[0].startswith("Name") and any(re.match(r"^Start\s?time of", line, re.I) for line in lines[:8]):
        return "TwinCAT Scope: the header names the start of the export"
    return None


def read_header(lines: Sequence[str], where: str) -> Header:
    """The header of an export; FormatError for what is missing."""
    start = next((m for line in lines[:10] if (m := _START.match(line))), None)
    if start is None:
        raise FormatError("no start of the export", where=where, expected="'Starttime of export' and a FILETIME",
                          got=lines[1][:60] if len(lines) > 1 else "nothing")
    names_at = next((k for k, line in enumerate(lines[1:60], 1) if re.match(r"^Name[\t;,]", line)), None)
    if names_at is None:
        raise FormatError("no row of channel names", where=where, expected="a second row 'Name'")
    delimiter = lines[names_at][4]
    rows: dict[str, list[str]] = {}
    first = names_at
    for first in range(names_at, min(len(lines), names_at + 60)):
        cells = lines[first].split(delimiter)
        if cells[0].strip() in _ROWS or first == names_at:
            rows[cells[0].strip()] = cells
        elif _DATA.match(lines[first]):
            break
    else:
        raise FormatError("no data behind the header", where=where, expected="rows of numbers")
    names = rows["Name"]
    width = max(len(names), len(lines[first].split(delimiter)))
    data = [line for line in lines[first:first + 200] if _DATA.match(line)]
    decimal = "," if delimiter != "," and any("," in line for line in data) else "."
    groups: dict[int, list[Channel]] = {}
    time = 0
    for column, name in enumerate(names):
        if name.strip() == "Name":
            time = column
            groups[time] = []
        elif name.strip():
            groups[time].append(_channel(column, name.strip(), len(groups), rows))
    taken: dict[tuple[str, str], int] = {}
    for channels in groups.values():
        for k, channel in enumerate(channels):
            count = taken[channel.stream, channel.name] = taken.get((channel.stream, channel.name), 0) + 1
            if count > 1:
                channels[k] = Channel(channel.column, f"{channel.name}#{count}", channel.stream, channel.unit,
                                      channel.dtype, channel.properties)
    return Header((int(start[1]) - _EPOCH_100NS) * 100, delimiter, decimal, width, first,
                  {t: c for t, c in groups.items() if c})


def _channel(column: int, name: str, group: int, rows: dict[str, list[str]]) -> Channel:
    def cell(key: str) -> str:
        cells = rows.get(key, [])
        return cells[column].strip() if column < len(cells) else ""

    unit = re.sub(r"\s*\(.*\)$", "", cell("Unit")) or None         # "V (Voltage)", "(None)"
    kind, plain = cell("Data-Type").upper(), all(cell(k) in ("", "0") for k in ("Offset", "Unit Offset")) \
        and all(cell(k) in ("", "1") for k in ("ScaleFactor", "Unit ScaleFactor"))
    dtype = "float64"
    if plain and kind in ("BIT", "BOOL"):
        dtype = "bool"
    elif plain and (match := _INTEGERS.match(kind)):
        dtype = "uint64" if match[1] and match[2] in ("64", "") else "int64"
    said = {key: cell(key) for key in ("SymbolName", "SymbolComment", "Data-Type", "SampleTime[ms]")}
    return Channel(column, name, f"scope{group}", unit, dtype, {k: v for k, v in said.items() if v})


def _header(path: Path, source: Source) -> tuple[Header, bool | None]:
    first = sample(path, source.encoding)
    last = [line.strip() for line in (first.rest or first.head)[-3:]]
    complete = True if "EOF" in last else None if first.ends_with_newline else False
    return read_header(first.head, path.name), complete


def describe(path: Path, source: Source) -> Recording:
    """Channels of an export, by its header."""
    header, complete = _header(path, source)
    signals = tuple(Signal(c.name, c.stream, c.unit, c.dtype, None, c.properties)
                    for channels in header.groups.values() for c in channels)
    return Recording(signals, "absolute", header.start_ns, complete)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows, a block a group; cells that are blank because a group ended or runs slower are no rows."""
    header, _ = _header(path, source)
    encoding = sample(path, source.encoding).encoding
    dtypes = ["float64"] * header.width
    for channels in header.groups.values():
        for channel in channels:
            dtypes[channel.column] = channel.dtype
    grid = Grid(header.delimiter, header.decimal, dtypes)
    losses = Losses(path.name, max(1, path.stat().st_size))
    for chunk in chunks(path, encoding):
        data, line = chunk.data, chunk.line
        while line < header.first_row and data:
            cut = data.find(b"\n") + 1 or len(data)
            data, line = data[cut:], line + 1
        tail = b""
        if chunk.last and not data.endswith(b"\n"):
            cut = data.rfind(b"\n") + 1
            data, tail = data[:cut], data[cut:]
        last = np.empty(0, np.int64)
        for part in grid.parts(data, line):
            if isinstance(part, BadLine):
                if part.text.strip() not in ("", "EOF"):
                    losses.add(part.line, f"expected {header.width} numbers, got '{part.text[:80]}'", len(part.text), 0)
                continue
            for time, channels in header.groups.items():
                block = _block(header, part, time, channels)
                if block is not None:
                    last = block.t_ns
                    yield block
        if tail.strip() not in (b"", b"EOF"):
            text = tail.decode("utf-8", "replace")
            losses.add(line + data.count(b"\n"), f"the last row has no line end and may be cut: '{text[:60]}'",
                       len(tail), last.size)
        yield from losses.dated(last)
    yield from losses.rest()


def _block(header: Header, part: Numbers, time: int, channels: list[Channel]) -> Block | None:
    rows = part.there[time] & np.isfinite(part.columns[time])
    for channel in channels:
        if channel.dtype != "float64":
            rows &= part.there[channel.column]
    if not rows.any():
        return None
    t_ns = header.start_ns + np.round(part.columns[time][rows] * 1e6).astype(np.int64)
    return Block(channels[0].stream, t_ns, {c.name: part.columns[c.column][rows] for c in channels})
