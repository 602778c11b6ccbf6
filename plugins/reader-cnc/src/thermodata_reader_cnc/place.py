"""Where a row stands in its file: the line of a text, the lines of its reports in a log of events, the record of a
trace.

A text's rows are delivered before its next chunk is read, so the chunk that was read last holds them. That chunk is
read again in smaller pieces, down to a line; a row that then reads otherwise is told by its number only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.plugin import Block, Loss, Source
from thermodata_reader_cnc.chunks import CUT, Chunk

_PIECES = 512  # of a chunk that is read again
_Row = tuple[int, tuple[Any, ...]]
_Blocks = Callable[[Path, Source], Iterator[Block | Loss]]


def place(form: str, module: Any, path: Path, source: Source, stream: str, row: int) -> str | None:
    """Where a row (counted from 0) of a stream stands in a file of a format; None where that can't be told."""
    if form in ("shdr", "opcua", "mtconnect"):
        from thermodata_reader_cnc import placeevents

        return placeevents.place(form, module, path, source, stream, row)
    if form == "tracexml":
        from thermodata_reader_cnc import placetrace

        return placetrace.place(path, source, stream, row)
    return _line(module.blocks, path, source, stream, row)


def find(blocks: _Blocks, path: Path, source: Source, stream: str, row: int) -> _Row | None:
    """(time, values) of a row; None where there is no such row."""
    done = 0
    for item in blocks(path, source):
        if isinstance(item, Block) and item.stream == stream:
            if row < done + item.t_ns.size:
                return _row(item, row - done)
            done += item.t_ns.size
    return None


def _row(block: Block, at: int) -> _Row:
    return int(block.t_ns[at]), tuple(repr(column[at]) for column in block.values.values())


def _line(blocks: _Blocks, path: Path, source: Source, stream: str, row: int) -> str | None:
    region: tuple[int, int] | None = None
    wanted: _Row | None = None
    while region is None or region[1] > 1:
        pieces = _Pieces(region)
        token = CUT.set(pieces.cut)
        try:
            found = find(blocks, path, source, stream, row)
        finally:
            CUT.reset(token)
        if found is None or (wanted is not None and found != wanted) or pieces.now == region:
            return None
        wanted, region = found, pieces.now
    return f"line {region[0] + 1}"


class _Pieces:
    """Cuts the chunk that holds a region, as (first line, lines), into pieces; now: the region of what was read
    last."""

    def __init__(self, region: tuple[int, int] | None) -> None:
        self.region = region
        self.now = (0, 0)

    def cut(self, chunks: Iterator[Chunk]) -> Iterator[Chunk]:
        for chunk in chunks:
            lines = _lines(chunk.data)
            if self.region is None or not chunk.line <= self.region[0] < chunk.line + lines:
                self.now = (chunk.line, lines)
                yield chunk
                continue
            first, count = self.region
            step = max(1, -(-count // _PIECES))
            edges = {chunk.line, *range(first, first + count, step), first + count, chunk.line + lines}
            yield from self._parts(chunk, sorted(edges))

    def _parts(self, chunk: Chunk, edges: list[int]) -> Iterator[Chunk]:
        at = 0
        ends = np.flatnonzero(np.frombuffer(chunk.data, np.uint8) == 10) + 1
        for begin, stop in pairwise(edges):
            end = int(ends[stop - chunk.line - 1]) if stop - chunk.line <= ends.size else len(chunk.data)
            odd = tuple(n for n in chunk.odd if begin <= n < stop)
            self.now = (begin, stop - begin)
            yield Chunk(chunk.data[at:end], begin, chunk.size, chunk.last and end == len(chunk.data), odd)
            at = end


def _lines(data: bytes) -> int:
    return data.count(b"\n") + (1 if data and not data.endswith(b"\n") else 0)
