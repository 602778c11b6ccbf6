"""MAT files of MATLAB, version 5 and 7.3: arrays found by mat_layout, delivered in blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.layout import unique
from thermodata.reader.text.time_groups import one_time
from thermodata.reader.zone import NAT
from thermodata_reader_table import clocks, stamps
from thermodata_reader_table.mat_layout import Axis, Column, Planner, Stream
from thermodata_reader_table.mat_tree import Tree

_BLOCK_VALUES = 1_000_000
_LOOK = 2000


def is_hdf5(start: bytes) -> bool:
    """Whether a file's first kilobyte holds the signature of HDF5 (after MATLAB's block of 512 bytes)."""
    return any(start[at : at + 8] == b"\x89HDF\r\n\x1a\n" for at in (0, 512))


@contextmanager
def opened(path: Path) -> Iterator[Tree]:
    """The variables of a MAT file of either version."""
    with path.open("rb") as file:
        start = file.read(1024)
    if is_hdf5(start):
        try:
            from thermodata_reader_table import mat73
        except ImportError:
            raise FormatError("MAT 7.3 (HDF5) needs h5py", where=path.name, hint="pip install h5py") from None
        with mat73.opened(path) as tree:
            yield tree
        return
    from thermodata_reader_table import mat5

    yield mat5.read(path)


@dataclass(frozen=True)
class Timed:
    """A stream with its clock understood. unit: of clocks; None for dates as text (then whole holds all)."""

    name: str
    axis: Axis
    columns: tuple[Column, ...]
    names: tuple[str, ...]
    unit: str | None
    absolute: bool
    properties: Mapping[str, str]
    whole: Int1D | None

    def times(self, start: int, stop: int) -> Int1D:
        if self.whole is not None:
            return self.whole[start:stop]
        if self.axis.load is None:
            rows = np.arange(start, min(stop, self.axis.length), dtype=np.float64)
            return clocks.to_ns(self.axis.zero_s + rows * self.axis.step_s, 1.0)
        assert self.unit is not None
        return clocks.times(self.axis.load(start, stop), self.unit, None).t_ns


class Clocked:
    """All streams of a tree with their times; notes say what was taken for granted."""

    def __init__(self, tree: Tree, source: Source, where: str) -> None:
        planner = Planner(tree, source.table or {}, where)
        plan = planner.plan()
        self.losses, self.notes = plan.losses, plan.notes
        self.source, self.where = source, where
        used: list[str] = []
        self.streams: list[Timed] = []
        for stream in plan.streams:
            # by its time, however many there are: a cut file keeps the names of the whole one
            name = unique([*used, stream.axis.path])[-1]
            used.append(name)
            self.streams.append(self._timed(name, stream))
        kinds = {s.absolute for s in self.streams}
        if len(kinds) > 1:
            raise FormatError(
                "some times are dates, others count from a start",
                where=where,
                got=", ".join(f"{s.axis.path} ({'date' if s.absolute else s.unit})" for s in self.streams[:8]),
                expected="one kind of time in a file",
                hint="name the one to read: table: {time: {column: ...}}, and the others in a source "
                "of their own, or save them so",
            )
        self.absolute = kinds == {True}

    def _timed(self, name: str, stream: Stream) -> Timed:
        axis, unit = stream.axis, None
        whole: Int1D | None = None
        absolute = False
        if axis.texts is not None:
            form = one_time(self.source.table, self.where).get("format")
            found = stamps.parse(axis.texts, self.source.timezone, form, f"{self.where} {axis.path}")
            whole, absolute = found.t_ns, found.absolute
            self._note(found.notes)
        elif axis.load is not None:
            unit = self._unit(axis)
            absolute = clocks.is_absolute(unit)
            if absolute and clocks.EPOCHS[unit].local:
                found = clocks.times(axis.load(0, axis.length), unit, self.source.timezone)
                whole = found.t_ns
                self._note(found.notes)
        names = tuple(unique([c.name for c in stream.columns]))
        return Timed(name, axis, tuple(stream.columns), names, unit, absolute, stream.properties, whole)

    def _unit(self, axis: Axis) -> str:
        assert axis.load is not None
        declared = one_time(self.source.table, self.where).get("unit")
        text = declared or axis.unit
        if text is not None:
            try:
                return clocks.check_unit(str(text), f"{self.where} {axis.path}")
            except FormatError:
                if declared is not None:
                    raise
                self._note((f"unit '{text}' of '{axis.path}' is none of time",))
        epoch = clocks.found_epoch(axis.load(0, _LOOK))
        if epoch is not None:
            self._note(
                (
                    f"'{axis.path}' has no unit: by its size it is {epoch}; declare table: {{time: {{unit: ...}}}} "
                    "if that is wrong",
                )
            )
            return epoch
        self._note(
            (f"'{axis.path}' has no unit: taken as seconds; declare table: {{time: {{unit: ...}}}} if that is wrong",)
        )
        return "s"

    def _note(self, notes: tuple[str, ...]) -> None:
        self.notes.extend(n for n in notes if n not in self.notes)


def describe(path: Path, source: Source) -> Recording:
    with opened(path) as tree:
        found = Clocked(tree, source, path.name)
        signals = tuple(
            Signal(name, s.name, column.unit or split_unit(name)[1], column.dtype, None, s.properties)
            for s in found.streams
            for name, column in zip(s.names, s.columns, strict=True)
        )
        start: int | None = None
        if found.absolute:
            firsts = [int(t[t != NAT][0]) for s in found.streams if (t := s.times(0, _LOOK))[t != NAT].size]
            start = min(firsts, default=0)
        return Recording(
            signals, "absolute" if found.absolute else "relative", start, tree.complete, tuple(found.notes)
        )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    with opened(path) as tree:
        found = Clocked(tree, source, path.name)
        yield from found.losses
        for stream in found.streams:
            yield from _blocks(stream, source, path.name)


def _blocks(stream: Timed, source: Source, where: str) -> Iterator[Block | Loss]:
    rows = max(1, int(source.options.get("block_rows", max(1000, _BLOCK_VALUES // (len(stream.columns) + 1)))))
    missing = 0
    for start in range(0, stream.axis.length, rows):
        t_ns = stream.times(start, start + rows)
        good = t_ns != NAT
        whole = bool(good.all())
        values: dict[str, Array] = {}
        for name, column in zip(stream.names, stream.columns, strict=True):
            part: Any = column.load(start, start + rows)
            if part.size != t_ns.size:
                raise FormatError(
                    f"'{name}' ends before its time", where=where, expected=f"{t_ns.size} values", got=str(part.size)
                )
            values[name] = part if whole else part[good]
        missing += int((~good).sum())
        yield Block(stream.name, t_ns if whole else t_ns[good], values)
    if missing:
        yield Loss(
            f"{where} {stream.axis.path}", None, None, missing / stream.axis.length, f"{missing} rows without a time"
        )
