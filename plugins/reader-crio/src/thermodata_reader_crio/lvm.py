"""LVM, the text file of LabVIEW ("LabVIEW Measurement"): a file header, then packets of a heading and rows.

Format: National Instruments, "Specification for the LabVIEW Measurement File". Version 0.92 has no
Decimal_Separator, and writes a comma in its times beside points in its data. The last column is free text ("LOST
COMMUNICATION").
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Bool1D, Loss, Recording, Signal, Source
from thermodata.reader.text import last_line_is_whole, split_unit
from thermodata.schema.flag import Flag
from thermodata_reader_crio.comments import flags_of, texts
from thermodata_reader_crio.lvm_header import Header, Packet
from thermodata_reader_crio.lvm_scan import Item, RowPart, has_heading_behind, scan
from thermodata_reader_crio.lvm_streams import Streams, is_time
from thermodata_reader_crio.lvm_times import Times, decimal_of, first_rows
from thermodata_reader_crio.rows import Grid, Rows, mask, number, parse
from thermodata_reader_crio.textparts import LineBlock, decode, encoding_of

COMMENT = "Comment"


def describe(path: Path, source: Source) -> Recording:
    encoding, note = encoding_of(path, source.encoding)
    notes = [note] if note else []
    streams = _streams(path, encoding)
    signals: dict[tuple[str, str], Signal] = {}
    start: int | None = None
    header, packet, fresh = Header(), None, False
    dated = False
    for item in scan(path, encoding, notes):
        if isinstance(item, Header):
            header = item
        elif isinstance(item, Packet):
            packet, fresh = item, True
            _declare(streams, packet, signals, notes)
        elif isinstance(item, RowPart) and packet is not None and fresh:
            fresh = False
            last = not has_heading_behind(path, encoding, item)
            decimal_of(item.data, header, packet, notes)
            times = Times(header, packet, first_rows(item.data, header, packet), source, notes)
            for group in streams.groups(packet):
                base = times.base(group[0])
                dated = dated or times.dated(group[0])
                start = base if start is None else min(start, base)
            if last:
                break
    if not signals:
        raise FormatError(
            "an LVM file without a channel over time",
            where=path.name,
            expected="X_Dimension Time",
            got="spectra, or no channel",
        )
    if not dated:
        notes.append("no date in the file: times count from its start")
    shown = notes[:20] + ([f"and {len(notes) - 20} notes more"] if len(notes) > 20 else [])
    return Recording(
        tuple(signals.values()),
        "absolute" if dated else "relative",
        (start or 0) if dated else None,
        None,
        tuple(dict.fromkeys(shown)),
    )


def _streams(path: Path, encoding: str) -> Streams:
    """The streams; where each channel has an X column of its own, by reading these."""
    streams = Streams()
    header, packet, decimal = Header(), None, None
    for item in scan(path, encoding, []):
        if isinstance(item, Header):
            header = item
        elif isinstance(item, Packet):
            packet, decimal = item, None
            if not packet.multi and header.x_columns != "Multi":
                break
        elif isinstance(item, RowPart) and packet is not None and packet.multi:
            decimal = decimal or decimal_of(item.data, header, packet, [])
            rows = parse(item.data, _grid(header, packet, decimal))
            streams.compare(packet, [rows.numbers[x] for x in packet.x if x is not None])
    return streams


def _declare(streams: Streams, packet: Packet, signals: dict[tuple[str, str], Signal], notes: list[str]) -> None:
    notes.extend(packet.notes)
    for i, name in enumerate(packet.names):
        if not is_time(packet, i):
            notes.append(f"{name}: stands over {packet.key('X_Dimension', i)}, not over time; left out")
    for group in streams.groups(packet):
        stream = streams.of(packet, group)
        for i in group:
            name = packet.names[i]
            unit = packet.key("Y_Unit_Label", i) or split_unit(name)[1] or None
            known = signals.setdefault((stream, name), Signal(name, stream, unit))
            if known.unit != unit:
                notes.append(f"{name}: its unit changes from '{known.unit}' to '{unit}' in line {packet.line}")
        text = _comment([packet.names[i] for i in group])
        signals.setdefault((stream, text), Signal(text, stream, None, "str"))


def _comment(names: Collection[str]) -> str:
    """The name of the free text beside a row: of each stream, for it says something of all channels."""
    return COMMENT if COMMENT not in names else f"{COMMENT} (text)"


def _grid(header: Header, packet: Packet, decimal: str) -> Grid:
    """A row has all its cells, but where the heading says that channels have fewer samples than others."""
    counts = {packet.samples(i) for i in range(len(packet.names))}
    least = packet.width if len(counts) == 1 else 2
    return Grid(header.separator.encode(), decimal.encode(), packet.width, packet.comment, least)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    encoding, _ = encoding_of(path, source.encoding)
    streams = _streams(path, encoding)
    header = Header()
    reading: _Reading | None = None
    waiting: _Part | None = None
    last_ns: int | None = None
    with ThreadPoolExecutor(1) as pool:
        for item in _and_end(scan(path, encoding, [])):
            begun = reading.begin(item, pool) if isinstance(item, RowPart) and reading is not None else None
            if waiting is not None:
                for made in waiting.reading.finish(waiting):
                    if isinstance(made, Block):
                        last_ns = int(made.t_ns[-1])
                    yield made
            waiting = begun
            if isinstance(item, Header):
                header = item
            elif isinstance(item, Loss):
                yield Loss(item.where, last_ns, None, None, item.reason)
            elif isinstance(item, Packet) or item is None:
                if reading is not None:
                    yield from reading.end(last_ns)
                reading = None if item is None else _Reading(path, header, item, streams, source, encoding)


def _and_end(items: Iterator[Item]) -> Iterator[Item | None]:
    yield from items
    yield None


@dataclass(frozen=True)
class _Part:
    """Rows that are being parsed. line: of the first."""

    reading: _Reading
    line: int
    losses: list[Loss]
    rows: Future[Rows]


class _Reading:
    """The rows of one packet, part by part."""

    def __init__(
        self, path: Path, header: Header, packet: Packet, streams: Streams, source: Source, encoding: str
    ) -> None:
        self.path, self.header, self.packet, self.streams = path, header, packet, streams
        self.source, self.encoding = source, encoding
        self.times: Times | None = None
        self.grid: Grid | None = None
        self.done = 0
        for group in streams.groups(packet):
            streams.of(packet, group)  # named in the order of the headings, whether rows follow or not

    def begin(self, part: RowPart, pool: Executor) -> _Part | None:
        """Has lines parsed, while what came before them is used."""
        data, losses = part.data, []
        if self.times is None or self.grid is None:
            if not data.strip():
                return None
            self.times = Times(self.header, self.packet, first_rows(data, self.header, self.packet), self.source, [])
            self.grid = _grid(self.header, self.packet, decimal_of(data, self.header, self.packet, []))
        if not part.ended and not self._whole(data):
            cut = data.rfind(b"\n") + 1
            line = part.line + data.count(b"\n")
            data = data[:cut]
            losses.append(Loss(f"{self.path.name} line {line}", reason="the last line has no end: it may be cut"))
        return _Part(self, part.line, losses, pool.submit(parse, data, self.grid))

    def finish(self, part: _Part) -> Iterator[Block | Loss]:
        yield from part.losses
        yield from self._blocks(part.rows.result(), part.line)

    def _whole(self, data: bytes) -> bool:
        *_, before, last = [b"", *data.rsplit(b"\n", 2)][-3:] if data.count(b"\n") > 1 else [b"", b"", data]
        return bool(before) and last_line_is_whole(
            decode(last, self.encoding), decode(before, self.encoding), self.header.separator
        )

    def _blocks(self, rows: Rows, line: int) -> Iterator[Block | Loss]:
        assert self.grid is not None
        words = None if rows.text is None else texts(rows.text, self.encoding)
        lost = list(rows.bad)
        empty, hopeless = self._unmeasured(rows)
        for count, group in enumerate(self.streams.groups(self.packet)):
            block, good = self._block(rows, group, words, empty, hopeless, line)
            if good is not None:
                lost += rows.line[~good & (self._has_value(group, empty, rows.n) | (count == 0))].tolist()
            yield from self._sliced(block)
        self.done += rows.n
        odd = [] if words is None else self._odd(words.tolist())
        yield from self._losses(rows, sorted(set(lost)), odd, line)

    def _unmeasured(self, rows: Rows) -> tuple[dict[int, Bool1D], Bool1D | None]:
        """(empty cells of each column that has some, rows in which nothing is a number and something is wrong)."""
        if rows.whole:
            return {}, None
        empty = {c: np.isnan(rows.numbers[c]) for c in self.packet.columns}
        wrong = mask(rows.n, [r for r, _ in rows.wrong])
        # a word at the start of a line is none of a row: a heading that the end of the file cut
        words = mask(rows.n, [r for r, c in rows.wrong if c == 0])
        hopeless = words | np.logical_and.reduce([*empty.values(), wrong]) if wrong.any() else None
        return {c: m for c, m in empty.items() if m.any()}, hopeless

    def _block(
        self,
        rows: Rows,
        group: list[int],
        words: Array | None,
        empty: dict[int, Bool1D],
        hopeless: Bool1D | None,
        line: int,
    ) -> tuple[LineBlock, Bool1D | None]:
        """One group's block; and which rows have a time and a value: None for all."""
        assert self.times is not None
        packet, n = self.packet, rows.n
        x = packet.x[group[0]]
        t_ns, good = self.times.of(group[0], rows.numbers[x] if x is not None else None, self.done, n)
        if hopeless is not None:
            good = good & ~hopeless
        keep = good if rows.whole else good & self._sampled(group, empty, n)
        said = None if words is None else flags_of(words)
        values: dict[str, Array] = {packet.names[i]: rows.numbers[packet.columns[i]] for i in group}
        flags: dict[str, Array] = {}
        for i in group:
            flag = None if packet.columns[i] not in empty else empty[packet.columns[i]] * np.uint16(Flag.NOT_MEASURING)
            if said is not None:
                flag = said if flag is None else flag | said
            if flag is not None:
                flags[packet.names[i]] = flag
        lines = rows.line + line
        values[_comment(values)] = words if words is not None else np.full(n, "", object)
        if not keep.all():
            t_ns = t_ns[keep]
            values = {k: v[keep] for k, v in values.items()}
            flags = {k: v[keep] for k, v in flags.items()}
            lines = lines[keep]
        block = LineBlock(self.streams.of(packet, group), t_ns, values, flags or None, lines)
        return block, None if good.all() else good

    def _has_value(self, group: list[int], empty: dict[int, Bool1D], n: int) -> Bool1D:
        """Rows with a number in any of a group's columns."""
        columns = [self.packet.columns[i] for i in group]
        if any(c not in empty for c in columns):
            return np.ones(n, bool)
        found: Bool1D = ~np.logical_and.reduce([empty[c] for c in columns])
        return found

    def _sampled(self, group: list[int], empty: dict[int, Bool1D], n: int) -> Bool1D:
        """False where a channel has no sample: its heading announces fewer than others have, and its cells are
        empty."""
        packet = self.packet
        most = max((s for i in range(len(packet.names)) if (s := packet.samples(i)) is not None), default=0)
        own = packet.samples(group[0])
        if own is None or own >= most:
            return np.ones(n, bool)
        sampled: Bool1D = self._has_value(group, empty, n) | (np.arange(self.done, self.done + n) < own)
        return sampled

    def _odd(self, words: list[str]) -> list[int]:
        """Rows with a number, or bytes of no text, for a comment."""
        assert self.grid is not None
        odd = {w for w in set(words) if w and ("\0" in w or number(w.encode(), self.grid.decimal) is not None)}
        return [i for i, w in enumerate(words) if w in odd] if odd else []

    def _losses(self, rows: Rows, lost: list[int], odd: list[int], line: int) -> Iterator[Loss]:
        if lost:
            yield Loss(
                f"{self.path.name} line {line + lost[0]}",
                reason=f"{len(lost)} lines that are no rows of {self.packet.width} numbers",
            )
        cells = len({r for r, _ in rows.wrong} - set(lost))
        if cells:
            first = line + int(rows.line[rows.wrong[0][0]])
            yield Loss(
                f"{self.path.name} line {first}",
                reason=f"{len(rows.wrong)} cells that are no numbers: their rows are kept, these values are flagged",
            )
        if odd:
            yield Loss(
                f"{self.path.name} line {line + int(rows.line[odd[0]])}",
                reason=f"{len(odd)} rows with a number, or bytes of no text, where the comment stands",
            )

    def _sliced(self, block: LineBlock) -> Iterator[LineBlock]:
        size = int(self.source.options.get("block_rows", 0)) or max(1, block.t_ns.size)
        for a in range(0, block.t_ns.size, size):
            yield block.part(a, a + size)

    def end(self, last_ns: int | None) -> Iterator[Loss]:
        """Whether as many rows came as the heading announced."""
        packet = self.packet
        most = max((s for i in range(len(packet.names)) if (s := packet.samples(i)) is not None), default=0)
        where = f"{self.path.name} line {packet.line}"
        if self.done < most:
            yield Loss(
                where,
                last_ns,
                None,
                (most - self.done) / most,
                f"{self.done} rows of {most} that the heading announces",
            )
        elif self.header.several and most and self.done > most:
            yield Loss(where, reason=f"{self.done} rows where the heading announces {most}: a heading may be missing")
