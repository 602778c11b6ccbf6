"""The index of a TDMS file: a walk over its segments, without the bulk.

Layout of the format: National Instruments, "TDMS File Format Internal Structure". Each segment is a lead-in of
28 bytes, metadata (which objects, how many values a chunk, which properties) and raw data in chunks.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

from thermodata.errors import FormatError
from thermodata_reader_crio.metadata import (
    CLOCK,
    DIGITAL_LINE,
    FORMAT_CHANGING,
    NO_DATA,
    SAME_DATA,
    Cursor,
    DamageError,
    Layout,
    RawIndex,
    check,
)

LEAD_IN = 28
META, NEW_LIST, RAW, INTERLEAVED, BIG_ENDIAN = 1 << 1, 1 << 2, 1 << 3, 1 << 5, 1 << 6
UNKNOWN_END = 0xFFFFFFFFFFFFFFFF


@dataclass(frozen=True, slots=True)
class Piece:
    """Chunks of one layout that follow each other: `tail` bytes of a last, shorter chunk after `chunks` full ones;
    cut: that tail is what the end of the file left of a full chunk."""

    layout: int
    position: int
    chunks: int
    tail: int = 0
    cut: bool = False


@dataclass(slots=True)
class Index:
    """The walk's result. good_end: the first byte that no good segment covers; expected_end: where the file
    should have ended, if the last lead-in says so."""

    size: int
    properties: dict[str, dict[str, Any]] = field(default_factory=dict)
    layouts: list[Layout] = field(default_factory=list)
    pieces: list[Piece] = field(default_factory=list)
    clock_changes: dict[str, list[tuple[int, dict[str, Any]]]] = field(default_factory=dict)
    good_end: int = 0
    expected_end: int | None = None
    damage: str | None = None
    segments: int = 0


class _Walk:
    """The state that segments inherit: the current list of objects and each object's last index."""

    def __init__(self, index: Index) -> None:
        self.index = index
        self.active: dict[str, bool] = {}
        self.last: dict[str, RawIndex] = {}
        self.generation = 0
        self.layout = -1
        self.layout_ids: dict[Layout, int] = {}
        self.active_ids: dict[tuple[tuple[str, bool], ...], int] = {(): 0}
        self.active_id = 0
        self.memo: dict[tuple[int, int, int, bytes], tuple[int, dict[str, bool], int]] = {}
        self.chunk_bytes: list[int] = []
        self.chunks: dict[int, int] = {}

    def metadata(self, data: bytes, toc: int) -> None:
        # Loggers repeat their metadata in each of many thousand segments; what is known is not parsed again.
        # The key is all that a parse depends on, so long as it changes no index and no property.
        key = (self.active_id, self.generation, toc, data)
        if key in self.memo:
            self.layout, self.active, self.active_id = self.memo[key]
            return
        before = self.generation
        self._parse(data, toc)
        layout = Layout(tuple((path, self.last[path]) for path, on in self.active.items() if on),
                        bool(toc & INTERLEAVED), bool(toc & BIG_ENDIAN))
        if layout not in self.layout_ids:
            check(layout)
            self.layout_ids[layout] = len(self.index.layouts)
            self.index.layouts.append(layout)
            self.chunk_bytes.append(layout.chunk_bytes)
        self.layout = self.layout_ids[layout]
        self.active_id = self.active_ids.setdefault(tuple(self.active.items()), len(self.active_ids))
        if self.generation == before:
            if len(self.memo) > 64:
                self.memo.clear()
            self.memo[key] = self.layout, self.active, self.active_id

    def _parse(self, data: bytes, toc: int) -> None:
        read = Cursor(data, ">" if toc & BIG_ENDIAN else "<")
        active = {} if toc & NEW_LIST else dict(self.active)
        for _ in range(read.u32()):
            path = read.text()
            header = read.u32()
            if header == NO_DATA:
                active[path] = False
            elif header == SAME_DATA:
                if path not in self.last:
                    raise DamageError(f"{path} repeats an index that it never had")
                active[path] = True
            else:
                found = read.daqmx(header) if header in (FORMAT_CHANGING, DIGITAL_LINE) else read.raw_index(header)
                if self.last.get(path) != found:
                    self.last[path] = found
                    self.generation += 1
                active[path] = True
            known = self.index.properties.setdefault(path, {})
            changed = {}
            for _ in range(read.u32()):
                name, value = read.property()
                if name not in known or known[name] != value:
                    self.generation += 1
                    if name in CLOCK:
                        changed[name] = value
                known[name] = value
            if changed:
                self.index.clock_changes.setdefault(path, []).append((self._values_of(path), changed))
        self.active = active

    def _values_of(self, path: str) -> int:
        """How many values of a channel the full chunks so far hold."""
        return sum(chunks * index.n for number, chunks in self.chunks.items()
                   for name, index in self.index.layouts[number].objects if name == path)


def walk(path: Path) -> Index:
    """The index of a file. FormatError where not even its first segment can be read; damage further on ends the
    walk, and stands in `damage` with the good part kept."""
    size = path.stat().st_size
    index = Index(size)
    state = _Walk(index)
    with path.open("rb") as file:
        while index.good_end < size:
            try:
                whole = _segment(file, state)
            except DamageError as error:
                index.damage = f"byte {index.good_end}: {error}"
                break
            index.segments += 1
            if not whole:
                break
    if not index.segments:
        raise FormatError("not a readable TDMS file", where=f"{path.name} {index.damage or 'byte 0'}",
                          expected="a lead-in, its metadata and raw data", got=f"a file of {size} bytes")
    return index


def _segment(file: BinaryIO, state: _Walk) -> bool:
    """One segment; False where the file ends inside its raw data."""
    index = state.index
    start = index.good_end
    file.seek(start)
    lead = file.read(LEAD_IN)
    if len(lead) < LEAD_IN:
        raise DamageError(f"the file ends inside a lead-in, after {len(lead)} of {LEAD_IN} bytes")
    if lead[:4] != b"TDSm":
        raise DamageError(f"no lead-in: expected 'TDSm', got {lead[:4]!r}")
    toc = struct.unpack("<I", lead[4:8])[0]
    version, to_next, to_raw = struct.unpack((">" if toc & BIG_ENDIAN else "<") + "IQQ", lead[8:])
    if version not in (4712, 4713):
        raise DamageError(f"TDMS version {version}, known are 4712 and 4713")
    data = start + LEAD_IN + to_raw
    end = index.size + 1 if to_next == UNKNOWN_END else start + LEAD_IN + to_next
    if end < data:
        raise DamageError("a segment that ends before its data starts")
    if data > index.size:
        raise DamageError(f"the file ends inside metadata, {data - index.size} bytes short")
    if toc & META:
        state.metadata(file.read(to_raw), toc)
    elif state.layout < 0:
        raise DamageError("a first segment without metadata")
    cut = end > index.size
    if cut:
        index.expected_end = None if to_next == UNKNOWN_END else end
    if toc & RAW:
        layout = index.layouts[state.layout]
        if layout.interleaved != bool(toc & INTERLEAVED) or layout.big_endian != bool(toc & BIG_ENDIAN):
            raise DamageError("raw data in another byte order than its metadata")
        _pieces(state, data, min(end, index.size), cut)
    index.good_end = min(end, index.size)
    if cut:
        index.damage = f"byte {index.size}: the file ends inside raw data"
        return False
    return True


def _pieces(state: _Walk, data: int, end: int, cut: bool) -> None:
    chunk = state.chunk_bytes[state.layout]
    if chunk == 0:
        if end > data and not cut:
            raise DamageError(f"{end - data} bytes of raw data that no channel claims")
        return
    chunks, tail = divmod(end - data, chunk)
    if chunks or tail or cut:
        state.index.pieces.append(Piece(state.layout, data, chunks, tail, cut))
    state.chunks[state.layout] = state.chunks.get(state.layout, 0) + chunks
