"""The rows of an LVM file as blocks: one part of lines is parsed in a thread while the one before is used."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text.file.lines import sample, without_cut_line
from thermodata.reader.text.rows.grid import Rows
from thermodata.reader.text.rows.typed import parse
from thermodata_reader_crio.lvm.grid import decimal_of, first_rows, grid_of
from thermodata_reader_crio.lvm.header import Header, Packet
from thermodata_reader_crio.lvm.packet_rows import OfFile, PacketRows
from thermodata_reader_crio.lvm.recording import streams_of
from thermodata_reader_crio.lvm.scan import Item, RowPart, scan
from thermodata_reader_crio.lvm.starts import starts_of
from thermodata_reader_crio.lvm.times import Times


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The rows of every packet, part by part, each with its line; and a loss for what does not read."""
    encoding = sample(path, source.encoding).encoding
    file = OfFile(path.name, streams_of(path, encoding), starts_of(path, encoding, source.timezone), source)
    header = Header()
    reading: _Reading | None = None
    waiting: _Parsing | None = None
    last_ns: int | None = None
    with ThreadPoolExecutor(1) as pool:
        for item in _and_end(scan(path, encoding)):
            begun = reading.begin(item, pool) if isinstance(item, RowPart) and reading is not None else None
            if waiting is not None:
                for made in waiting.items():
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
                reading = None if item is None else _Reading(file, header, item)


def _and_end(items: Iterator[Item]) -> Iterator[Item | None]:
    yield from items
    yield None


@dataclass(frozen=True)
class _Parsing:
    """Rows that are being parsed, and what was lost of their lines already."""

    into: PacketRows
    losses: list[Loss]
    rows: Future[Rows]

    def items(self) -> Iterator[Block | Loss]:
        yield from self.losses
        yield from self.into.items(self.rows.result())


class _Reading:
    """The rows of one packet, part by part."""

    def __init__(self, file: OfFile, header: Header, packet: Packet) -> None:
        self.file, self.header, self.packet = file, header, packet
        self.into: PacketRows | None = None
        streams = file.streams
        for group in streams.groups(packet):
            # named, and their units taken, in the order of the headings, whether rows follow or not
            streams.units.changed(streams.of(packet, group), packet, group)

    def begin(self, part: RowPart, pool: Executor) -> _Parsing | None:
        """Has lines parsed, while what came before them is used."""
        data = part.data
        losses: list[Loss] = []
        if self.into is None:
            if not data.strip():
                return None
            times = Times(self.header, self.packet, first_rows(data, self.header, self.packet), self.file.starts)
            grid = grid_of(self.header, self.packet, decimal_of(data, self.header, self.packet)[0])
            self.into = PacketRows(self.file, self.packet, times, grid)
            losses += self.into.left_out()
        if not part.ended:
            data, cut = without_cut_line(data, self.header.separator)
            if cut:
                line = part.line + data.count(b"\n") + 1
                losses.append(Loss(f"{self.file.name} line {line}", reason="the last line has no end: it may be cut"))
        return _Parsing(self.into, losses, pool.submit(parse, data, part.line, self.into.grid))

    def end(self, last_ns: int | None) -> Iterator[Loss]:
        """Whether as many rows came as the heading announced."""
        done = 0 if self.into is None else self.into.done
        most, where = self.packet.most_samples, f"{self.file.name} line {self.packet.line}"
        if done < most:
            fraction = (most - done) / most
            yield Loss(where, last_ns, None, fraction, f"{done} rows of {most} that the heading announces")
        elif self.header.several and most and done > most:
            yield Loss(where, reason=f"{done} rows where the heading announces {most}: a heading may be missing")
