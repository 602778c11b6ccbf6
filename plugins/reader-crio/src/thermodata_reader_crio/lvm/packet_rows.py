"""The parsed rows of an LVM packet as blocks of its streams, and as losses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Loss, Source
from thermodata.reader.text.rows.grid import Grid, Rows
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_crio.comments import flags_of, is_odd, texts
from thermodata_reader_crio.lvm.header import Packet
from thermodata_reader_crio.lvm.recording import comment_name
from thermodata_reader_crio.lvm.starts import Starts
from thermodata_reader_crio.lvm.streams import Streams
from thermodata_reader_crio.lvm.times import Times


@dataclass(frozen=True)
class _Cells:
    """What the cells of some rows say beside their numbers. empty, over: column -> rows without a value, and rows with
    a word for overload; hopeless: rows that are none (None: there are none); words: the free text, or None."""

    empty: dict[int, Bool1D]
    over: dict[int, Bool1D]
    hopeless: Bool1D | None
    words: Array | None


@dataclass(frozen=True, slots=True)
class OfFile:
    """What the packets of a file share. streams: their channels, as all headings name them; starts: when rows began."""

    name: str
    streams: Streams
    starts: Starts
    source: Source


class PacketRows:
    """Turns the rows of one packet into blocks, part by part. done: rows so far."""

    def __init__(self, file: OfFile, packet: Packet, times: Times, grid: Grid) -> None:
        self.name, self.packet, self.streams, self.times, self.grid = file.name, packet, file.streams, times, grid
        self.block_rows = int(file.source.options.get("block_rows", 0))
        streams = file.streams
        self.done = 0
        # as of this heading: later ones are met while its last rows are parsed
        self._changes = {
            group[0]: streams.units.changed(streams.of(packet, group), packet, group)
            for group in streams.groups(packet)
        }
        self._holes: dict[int, list[int]] = {}  # of a group: lines without it behind its last row, or its start

    def items(self, rows: Rows) -> Iterator[Block | Loss]:
        """The blocks of all streams, then the losses."""
        cells = self._cells(rows)
        lost = {bad.line for bad in rows.bad} | {line for line, _ in rows.nul}
        unheld = np.ones(rows.n, bool)  # rows that no group should have so far: an empty one is told once
        for group in self.streams.groups(self.packet):
            block, good = self._block(rows, group, cells)
            goes_on = self._has_samples(group, cells, rows.n)
            if good is not None:
                said = self._has_value(group, cells, rows.n) | (unheld & goes_on)
                lost |= set(rows.line[~good & said].tolist())
            lost |= self._lines_lacking(group, rows, good, goes_on)
            unheld &= ~goes_on
            size = self.block_rows or max(1, block.t_ns.size)
            for a in range(0, block.t_ns.size, size):
                yield block.part(a, a + size)
        self.done += rows.n
        yield from self._losses(rows, cells, lost)

    def _lines_lacking(self, group: list[int], rows: Rows, good: Bool1D | None, goes_on: Bool1D) -> set[int]:
        """The lines that a group lacks before one that it has: those behind the last one are its end."""
        has = np.flatnonzero(goes_on if good is None else good & goes_on)
        lacks = np.zeros(0, np.int64) if good is None else np.flatnonzero(~good & goes_on)
        last = int(has[-1]) if has.size else -1
        pending = self._holes.get(group[0], [])
        self._holes[group[0]] = [*(pending if last < 0 else ()), *rows.line[lacks[lacks > last]].tolist()]
        return {*(pending if last >= 0 else ()), *rows.line[lacks[lacks < last]].tolist()}

    def _cells(self, rows: Rows) -> _Cells:
        packet, over = self.packet, {}
        empty: dict[int, Bool1D] = {}
        for c in packet.columns:
            column = rows.columns[c]
            if column.empty.any():
                empty[c] = column.empty & ~column.over
                if column.over.any():
                    over[c] = column.over
        hopeless: Bool1D | None = None
        wrong = [r for c in range(packet.width) for r, _ in rows.columns[c].odd]
        if wrong or rows.nul:
            hopeless = np.isin(rows.line, [line for line, _ in rows.nul])
            # a word at the start of a line is none of a row: a heading that the end of the file cut
            hopeless[[r for r, _ in rows.columns[0].odd]] = True
            if wrong and len(empty) == len(packet.columns):
                nothing = np.logical_and.reduce(list(empty.values()))
                hopeless[wrong] |= nothing[wrong]
        words = texts(rows.columns[packet.width].values) if packet.comment else None
        return _Cells(empty, over, hopeless, words)

    def _block(self, rows: Rows, group: list[int], cells: _Cells) -> tuple[Block, Bool1D | None]:
        """One group's block; and which rows have a time and a value: None for all."""
        packet, n = self.packet, rows.n
        x = packet.x[group[0]]
        t_ns, good = self.times.of(group[0], rows.columns[x].values if x is not None else None, self.done, n)
        if cells.hopeless is not None:
            good = good & ~cells.hopeless
        keep = good & self._has_samples(group, cells, n) if cells.empty else good
        values: dict[str, Array] = {packet.names[i]: rows.columns[packet.columns[i]].values for i in group}
        flags = self._flags(group, cells)
        self._in_first_unit(group, values, flags)
        stream = self.streams.of(packet, group)
        names = self.streams.members[stream]
        for name in names:
            if name not in values:  # other headings of the file have it
                values[name], flags[name] = np.full(n, np.nan), np.full(n, Flag.NOT_MEASURING, np.uint16)
        values[comment_name(names)] = cells.words if cells.words is not None else np.full(n, "", object)
        at = rows.line + 1
        if not keep.all():
            t_ns, at = t_ns[keep], at[keep]
            values = {k: v[keep] for k, v in values.items()}
            flags = {k: v[keep] for k, v in flags.items()}
        return Block(stream, t_ns, values, flags or None, at), None if good.all() else good

    def _flags(self, group: list[int], cells: _Cells) -> dict[str, Array]:
        """Flags of the channels that have any: of their cells, and of what the free text says of all of them."""
        said = None if cells.words is None else flags_of(cells.words)
        flags: dict[str, Array] = {}
        for i in group:
            column = self.packet.columns[i]
            parts = [] if said is None else [said]
            if column in cells.empty:
                parts.append(cells.empty[column] * np.uint16(Flag.NOT_MEASURING))
            if column in cells.over:
                parts.append(cells.over[column] * np.uint16(Flag.SATURATED))
            if parts:
                flags[self.packet.names[i]] = np.bitwise_or.reduce(parts)
        return flags

    def _in_first_unit(self, group: list[int], values: dict[str, Array], flags: dict[str, Array]) -> None:
        """Converts the values of channels whose unit changed; what does not convert is not measured."""
        for change in self._changes[group[0]]:
            own = values[change.name]
            if change.scale is not None:
                values[change.name] = own * change.scale[0] + change.scale[1]
                continue
            values[change.name] = np.full(own.size, np.nan)
            known = flags.get(change.name, np.zeros(own.size, np.uint16))
            flags[change.name] = known | np.uint16(Flag.NOT_MEASURING)

    def left_out(self) -> Iterator[Loss]:
        """The channels that this heading gives another kind of unit, once each."""
        for group in self.streams.groups(self.packet):
            stream = self.streams.of(self.packet, group)
            for change in self._changes[group[0]]:
                if change.scale is None and self.streams.units.is_new(stream, change):
                    where = f"{self.name} line {self.packet.line}"
                    yield Loss(where, reason=f"{change.name}: {change}", signal=change.name)

    def _has_value(self, group: list[int], cells: _Cells, n: int) -> Bool1D:
        """Rows with a number in any of a group's columns."""
        columns = [self.packet.columns[i] for i in group]
        if any(c not in cells.empty for c in columns):
            return np.ones(n, bool)
        measured: Bool1D = ~np.logical_and.reduce([cells.empty[c] for c in columns])
        return measured

    def _has_samples(self, group: list[int], cells: _Cells, n: int) -> Bool1D:
        """False where a channel has no sample: its heading announces fewer than others have, and its cells are
        empty."""
        own = self.packet.samples(group[0])
        if own is None or own >= self.packet.most_samples:
            return np.ones(n, bool)
        sampled: Bool1D = self._has_value(group, cells, n) | (np.arange(self.done, self.done + n) < own)
        return sampled

    def _losses(self, rows: Rows, cells: _Cells, lost: set[int]) -> Iterator[Loss]:
        if lost:
            yield Loss(
                f"{self.name} line {min(lost) + 1}",
                reason=f"{counted(len(lost), 'line', 'that is no row', 'that are no rows')} of "
                f"{counted(self.packet.width, 'number')}",
            )
        lines = [int(rows.line[r]) for c in range(self.packet.width) for r, _ in rows.columns[c].odd]
        wrong = [line for line in lines if line not in lost]
        if wrong:
            yield Loss(
                f"{self.name} line {min(wrong) + 1}",
                reason=f"{counted(len(wrong), 'cell', 'that is no number', 'that are no numbers')}: their rows "
                "are kept, these values are flagged",
            )
        if cells.words is None:
            return
        comments = cells.words.tolist()
        odd = {word for word in set(comments) if word and is_odd(word, self.grid.decimal)}
        if odd:
            moved = [r for r, word in enumerate(comments) if word in odd]
            yield Loss(
                f"{self.name} line {int(rows.line[moved[0]]) + 1}",
                reason=f"{counted(len(moved), 'row')} with a number, or bytes of no text, where the comment stands",
            )
