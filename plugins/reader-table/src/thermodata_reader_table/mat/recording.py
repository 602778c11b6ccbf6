"""MAT files of MATLAB, version 5 and 7.3: what describe() and blocks() say of them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Recording, Signal, Source
from thermodata.reader.text import split_unit
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.mat.files import opened
from thermodata_reader_table.mat.timed_streams import LOOK, Clocked, TimedStream

_BLOCK_VALUES = 1_000_000


def describe(path: Path, source: Source) -> Recording:
    """Streams and signals of a file. FormatError: no time and signals, or which belong together is not clear."""
    with opened(path) as tree:
        found = Clocked(tree, source, path.name)
        signals = tuple(
            Signal(name, s.name, c.unit or split_unit(name)[1], c.dtype, None, {**c.said, **s.properties})
            for s in found.streams
            for name, c in zip(s.names, s.columns, strict=True)
        )
        start: int | None = None
        if found.absolute:
            firsts = [int(t[t != NAT][0]) for s in found.streams if (t := s.times(0, LOOK))[t != NAT].size]
            start = min(firsts, default=0)
        return Recording(
            signals,
            "absolute" if found.absolute else "relative",
            start,
            tree.complete,
            tuple(found.notes),
        )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The values as stored, times in ns since 1970 UTC (or since the start), and the variables that are lost."""
    with opened(path) as tree:
        found = Clocked(tree, source, path.name)
        yield from found.losses
        for stream in found.streams:
            yield from _blocks(stream, source, path.name)


def _blocks(stream: TimedStream, source: Source, where: str) -> Iterator[Block | Loss]:
    rows = max(1, int(source.options.get("block_rows", max(1000, _BLOCK_VALUES // (len(stream.columns) + 1)))))
    missing = 0
    for start in range(0, stream.time.length, rows):
        t_ns = stream.times(start, start + rows)
        good = t_ns != NAT
        whole = bool(good.all())
        values: dict[str, Array] = {}
        for name, column in zip(stream.names, stream.columns, strict=True):
            part: Any = column.load(start, start + rows)
            if part.size != t_ns.size:
                raise FormatError(
                    f"'{name}' ends before its time",
                    where=where,
                    expected=f"{t_ns.size} values",
                    got=str(part.size),
                    hint="save it with as many values as its time has",
                )
            values[name] = part if whole else part[good]
        missing += int((~good).sum())
        yield Block(stream.name, t_ns if whole else t_ns[good], values)
    if missing:
        yield Loss(
            f"{where} {stream.time.path}",
            None,
            None,
            missing / stream.time.length,
            f"{counted(missing, 'row')} without a time",
        )
