"""LVM, the text file of LabVIEW ("LabVIEW Measurement"): a file header, then packets of a header and rows.

Format: National Instruments, "LVM File Specification". Version 0.92 has no Decimal_Separator, and writes a comma in
its times beside points in its data. The last column is free text ("LOST COMMUNICATION").
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.text import decimal_mark, file_encoding, local_to_utc_ns, split_unit
from thermodata_reader_crio.clock import step_ns

END = "***End_of_Header***"
STREAM = "data"
_ROWS = 20_000
_1904_TO_1970 = 2_082_844_800
_TIME = re.compile(r"^(\d{1,2}):(\d{2}):(\d{2})(?:[.,](\d+))?$")


@dataclass(frozen=True)
class Packet:
    """One heading: its keys (each a list, one value a channel) and the names of its channels.

    columns: where each channel stands in a row; x: where its X value does, None for X_Columns No.
    """

    keys: dict[str, list[str]]
    names: tuple[str, ...]
    columns: tuple[int, ...]
    x: tuple[int | None, ...]
    multi: bool
    comment: int | None
    line: int

    def key(self, name: str, channel: int, default: str = "") -> str:
        values = self.keys.get(name, [])
        # with X_Columns Multi the values stand in every second column
        at = 2 * channel if self.multi else channel
        return values[at] if at < len(values) else default


@dataclass(frozen=True)
class Layout:
    """What the file's header says. decimal: None until the data shows it."""

    separator: str
    decimal: str | None
    x_columns: str
    several: bool
    date: str
    time: str


def _header(lines: Iterator[tuple[int, str]], path: Path) -> Layout:
    keys: dict[str, str] = {}
    separator = "\t"
    for number, line in lines:
        if line.startswith(END):
            break
        if number > 500:
            raise FormatError("LVM header without an end", where=path.name, expected=END, got="500 lines without it")
        name, _, value = line.partition("\t" if "\t" in line else "," if "," in line else ";")
        keys[name.strip()] = value.strip("\t ") if value.strip() else value
        if name.strip() == "Separator":
            separator = {"tab": "\t", "comma": ","}.get(value.strip().lower(), value.strip() or "\t")
    else:
        raise FormatError("LVM file that ends inside its header", where=path.name, expected=END)
    decimal = keys.get("Decimal_Separator")
    return Layout(separator, decimal if decimal in (".", ",") else None, keys.get("X_Columns", "No").strip(),
                  keys.get("Multi_Headings", "No").strip() == "Yes", keys.get("Date", ""), keys.get("Time", ""))


def _rows_a_block(source: Source) -> int:
    return max(1, int(source.options.get("block_rows", _ROWS)))


def _scan(path: Path, source: Source) -> Iterator[Layout | Packet | tuple[int, list[str]] | Loss]:
    """Header, then each packet and its rows as (line number of the first, lines); a Loss where the file was cut."""
    encoding, _ = file_encoding(path, source.encoding)
    limit = _rows_a_block(source)
    with path.open(encoding=encoding, newline="\n", errors="strict") as file:
        lines = ((i, text.rstrip("\r\n") if text.endswith("\n") else text + "\0") for i, text in enumerate(file, 1))
        layout = _header(lines, path)
        yield layout
        packet: Packet | None = None
        keys: dict[str, list[str]] = {}
        expects_names = False
        rows: list[str] = []
        first = 0
        for number, line in lines:
            cut = line.endswith("\0")
            text = line.rstrip("\0")
            if packet is not None and text.startswith(("Channels" + layout.separator, "Samples" + layout.separator)):
                if rows:
                    yield first, rows
                    rows = []
                packet, keys = None, {}
            if packet is None:
                if expects_names:
                    packet = _packet(text, keys, layout, path, number)
                    yield packet
                    expects_names = False
                elif text.startswith(END):
                    expects_names = True
                elif text.strip():
                    name, *values = text.split(layout.separator)
                    keys[name] = [v.strip() for v in values]
                continue
            if not text.strip():
                continue
            if cut:
                yield Loss(f"{path.name} line {number}", None, None, None, "the last line has no end: it may be cut")
                break
            if not rows:
                first = number
            rows.append(text)
            if len(rows) >= limit:
                yield first, rows
                rows = []
        if rows:
            yield first, rows
        if packet is None:
            raise FormatError("LVM file without a heading of columns", where=path.name, expected="X_Value ...")


def _packet(line: str, keys: dict[str, list[str]], layout: Layout, path: Path, number: int) -> Packet:
    cells = [c.strip() for c in line.split(layout.separator)]
    comment = len(cells) - 1 if cells and cells[-1] == "Comment" else None
    last = len(cells) if comment is None else comment
    if layout.x_columns == "Multi":
        columns = list(range(1, last, 2))
        x: list[int | None] = [c - 1 for c in columns]
    else:
        columns = list(range(1, last))
        x = [0 if layout.x_columns == "One" else None] * len(columns)
    names: list[str] = []
    for c in columns:
        name = cells[c] or f"column {c + 1}"
        twin = sum(n == name or n.startswith(f"{name}#") for n in names)
        names.append(name if not twin else f"{name}#{twin + 1}")
    if not names:
        raise FormatError("LVM heading without channels", where=f"{path.name} line {number}", got=line[:80])
    return Packet(keys, tuple(names), tuple(columns), tuple(x), layout.x_columns == "Multi",
                  comment, number)


def _start_ns(layout: Layout, packet: Packet, channel: int, source: Source, notes: list[str]) -> int | None:
    """UTC of the packet's Date and Time (local, as the source's zone says); None where there is none."""
    date = packet.key("Date", channel) or layout.date
    time = _TIME.match(packet.key("Time", channel) or layout.time)
    if not time or not re.match(r"^\d{4}/\d{1,2}/\d{1,2}$", date):
        return None
    year, month, day = (int(p) for p in date.split("/"))
    try:
        naive = np.datetime64(f"{year:04}-{month:02}-{day:02}T{int(time[1]):02}:{time[2]}:{time[3]}", "ns")
    except ValueError:
        return None
    utc, more = local_to_utc_ns(np.array([naive]), source.timezone)
    notes.extend(n for n in more if n not in notes)
    return int(utc[0]) + int((time[4] or "0")[:9].ljust(9, "0"))


def _number(text: str, default: float) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return default


def _groups(packet: Packet) -> list[list[int]]:
    """Channels that share their X values: all, but for X_Columns Multi, where each may have its own."""
    keys = () if packet.x[0] is not None and not packet.multi else ("Samples", "Date", "Time", "X0", "Delta_X")
    groups: dict[tuple[str, ...], list[int]] = {}
    for i in range(len(packet.names)):
        groups.setdefault(tuple(packet.key(k, i) for k in keys), []).append(i)
    return list(groups.values())


class _Streams:
    """Stream names by the channels in them: packets with the same channels go on in the same streams."""

    def __init__(self) -> None:
        self.names: dict[tuple[str, ...], str] = {}

    def of(self, packet: Packet, group: list[int]) -> str:
        key = tuple(packet.names[i] for i in group)
        return self.names.setdefault(key, STREAM if not self.names else f"{STREAM}@{len(self.names) + 1}")


def describe(path: Path, source: Source) -> Recording:
    _, note = file_encoding(path, source.encoding)
    notes = [note] if note else []
    streams, signals, start = _Streams(), dict[tuple[str, str], Signal](), None
    layout: Layout | None = None
    for item in _scan(path, source):
        if isinstance(item, Layout):
            layout = item
        elif isinstance(item, Packet):
            assert layout is not None
            for number, group in enumerate(_groups(item)):
                stream = streams.of(item, group)
                for i in group:
                    unit = item.key("Y_Unit_Label", i) or split_unit(item.names[i])[1]
                    signals.setdefault((stream, item.names[i]), Signal(item.names[i], stream, unit or None))
                if item.comment is not None and number == 0:
                    signals.setdefault((stream, "Comment"), Signal("Comment", stream, None, "str"))
            if start is None:
                start = _origin(layout, item, source, notes)
            if not layout.several:
                break
    if start is None:
        notes.append("no date in the file: times count from its start")
    return Recording(tuple(signals.values()), "relative" if start is None else "absolute", start, None, tuple(notes))


def _origin(layout: Layout, packet: Packet, source: Source, notes: list[str]) -> int | None:
    x0 = _number(packet.key("X0", 0), 0.0)
    if x0 > 1e9:
        return round((x0 - _1904_TO_1970) * 1e9)
    start = _start_ns(layout, packet, 0, source, notes)
    return None if start is None else start + round(x0 * 1e9)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    streams, notes = _Streams(), list[str]()
    layout: Layout | None = None
    packet: Packet | None = None
    decimal: str | None = None
    done = 0
    last_ns: int | None = None
    for item in _scan(path, source):
        if isinstance(item, Layout):
            layout, decimal = item, item.decimal
        elif isinstance(item, Packet):
            packet, done = item, 0
        elif isinstance(item, Loss):
            yield Loss(item.where, last_ns, None, None, item.reason)
        else:
            assert layout is not None
            assert packet is not None
            first, lines = item
            cells = [line.split(layout.separator) for line in lines]
            if decimal is None:
                decimal = decimal_mark(c for row in cells[:200] for c in row[: packet.comment])
            table = _table(cells, packet, decimal or ".")
            for block in _packet_blocks(table, cells, packet, layout, source, streams, done, notes):
                last_ns = int(block.t_ns[-1]) if block.t_ns.size else last_ns
                yield block
            if table.bad:
                yield Loss(f"{path.name} line {first + table.bad[0]}", None, None, None,
                           f"{len(table.bad)} lines that are no numbers")
            done += len(cells)


@dataclass(frozen=True)
class _Table:
    columns: dict[int, Array]
    bad: list[int]


def _table(cells: list[list[str]], packet: Packet, decimal: str) -> _Table:
    wanted = sorted({*packet.columns, *(x for x in packet.x if x is not None)})
    bad: list[int] = []
    found = {}
    for c in wanted:
        texts = [row[c].strip() if c < len(row) else "" for row in cells]
        if decimal == ",":
            texts = [t.replace(",", ".") for t in texts]
        try:
            found[c] = np.array([t or "nan" for t in texts]).astype(np.float64)
        except ValueError:
            values = np.full(len(texts), np.nan)
            for i, t in enumerate(texts):
                try:
                    values[i] = float(t or "nan")
                except ValueError:
                    bad.append(i)
            found[c] = values
    return _Table(found, sorted(set(bad)))


def _packet_blocks(table: _Table, cells: list[list[str]], packet: Packet, layout: Layout, source: Source,
                   streams: _Streams, done: int, notes: list[str]) -> Iterator[Block]:
    n = len(cells)
    good = np.ones(n, bool)
    good[table.bad] = False
    for number, group in enumerate(_groups(packet)):
        stream = streams.of(packet, group)
        lead = group[0]
        keep = good.copy()
        # channels with fewer samples than their neighbours leave their cells empty at the end
        samples = packet.key("Samples", lead)
        if len(_groups(packet)) > 1 and samples.isdigit():
            keep &= np.arange(done, done + n) < int(samples)
        if packet.multi and not _same_x(table, packet, group):
            raise FormatError("channels with equal headings and different X columns", where=f"line {packet.line}",
                              got=", ".join(packet.names[i] for i in group))
        t_ns = _times(table, packet, layout, source, lead, done, n, notes)
        values: dict[str, Array] = {packet.names[i]: table.columns[packet.columns[i]][keep] for i in group}
        if packet.comment is not None and number == 0:
            texts = [row[packet.comment] if packet.comment < len(row) else "" for row in cells]
            values["Comment"] = np.array(texts, object)[keep]
        yield Block(stream, t_ns[keep], values)


def _same_x(table: _Table, packet: Packet, group: list[int]) -> bool:
    x = [table.columns[packet.columns[i] - 1] for i in group]
    return all(np.array_equal(other, x[0], equal_nan=True) for other in x[1:])


def _times(table: _Table, packet: Packet, layout: Layout, source: Source, lead: int, done: int, n: int,
           notes: list[str]) -> Int1D:
    x0 = _number(packet.key("X0", lead), 0.0)
    start = _start_ns(layout, packet, lead, source, notes) or 0
    column = packet.x[lead]
    if column is not None:
        x = table.columns[column]
        if x.size and np.nanmedian(x) > 1e9:
            return np.rint((x - _1904_TO_1970) * 1e9).astype(np.int64)
        return np.rint(np.nan_to_num(x) * 1e9).astype(np.int64) + start
    step = step_ns(_number(packet.key("Delta_X", lead), 1.0) or 1.0)
    i = np.arange(done, done + n, dtype=np.int64)
    whole, rest = divmod(step.numerator, step.denominator)
    base = round((x0 - _1904_TO_1970) * 1e9) if x0 > 1e9 else start + round(x0 * 1e9)
    return base + i * whole + (i * rest) // step.denominator
