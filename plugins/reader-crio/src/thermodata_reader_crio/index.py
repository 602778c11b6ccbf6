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

LEAD_IN = 28
META, NEW_LIST, RAW, INTERLEAVED, BIG_ENDIAN = 1 << 1, 1 << 2, 1 << 3, 1 << 5, 1 << 6
UNKNOWN_END = 0xFFFFFFFFFFFFFFFF
MOST = 1 << 48      # values or bytes a chunk; more is damage, and would overflow
NO_DATA, SAME_DATA = 0xFFFFFFFF, 0
FORMAT_CHANGING, DIGITAL_LINE = 0x1269, 0x126A
CLOCK = ("wf_start_time", "wf_start_offset", "wf_increment")
STRING, BOOL, TIMESTAMP, DAQMX = 0x20, 0x21, 0x44, 0xFFFFFFFF

# TDMS type -> numpy's name; a timestamp is 16 bytes (fraction of 2^-64 s, seconds since 1904)
NUMPY = {1: "i1", 2: "i2", 3: "i4", 4: "i8", 5: "u1", 6: "u2", 7: "u4", 8: "u8", 9: "f4", 10: "f8",
         0x19: "f4", 0x1A: "f8", BOOL: "u1", TIMESTAMP: "V16", 0x08000C: "c8", 0x10000D: "c16"}
DAQMX_NUMPY = {0: "u1", 1: "i1", 2: "u2", 3: "i2", 4: "u4", 5: "i4", 6: "u8", 7: "i8", 8: "f4", 9: "f8"}
_SIZE = {key: int(name[1:]) for key, name in NUMPY.items()}


@dataclass(frozen=True, slots=True)
class Scaler:
    """A column of a DAQmx buffer: bit is set for a digital line."""

    scale_id: int
    dtype: str
    buffer: int
    offset: int
    bit: int | None


@dataclass(frozen=True, slots=True)
class RawIndex:
    """How one channel lies in one chunk: n values of a type (nbytes in all), or DAQmx scalers."""

    type: int
    n: int
    nbytes: int
    scalers: tuple[Scaler, ...] = ()
    widths: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Layout:
    """What a chunk holds: (object path, its index) in order."""

    objects: tuple[tuple[str, RawIndex], ...]
    interleaved: bool
    big_endian: bool

    def buffers(self) -> list[tuple[int, int]]:
        """DAQmx: (values, width in bytes) of each raw buffer."""
        widths = self.objects[0][1].widths
        rows = [0] * len(widths)
        for _, index in self.objects:
            for scaler in index.scalers:
                rows[scaler.buffer] = max(rows[scaler.buffer], index.n)
        return list(zip(rows, widths, strict=True))

    @property
    def daqmx(self) -> bool:
        return bool(self.objects) and bool(self.objects[0][1].scalers)

    @property
    def chunk_bytes(self) -> int:
        if self.daqmx:
            return sum(n * width for n, width in self.buffers())
        return sum(index.nbytes for _, index in self.objects)


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


class DamageError(Exception):
    """What makes the rest of the file unreadable."""


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
            _check(layout)
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
        read = _Cursor(data, ">" if toc & BIG_ENDIAN else "<")
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


class _Cursor:
    """Reads the fields of a metadata block; anything beyond its end is damage."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data, self.order, self.at = data, order, 0

    def take(self, n: int) -> bytes:
        if n > len(self.data) - self.at:
            raise DamageError(f"a field of {n} bytes in metadata that ends after {len(self.data) - self.at}")
        self.at += n
        return self.data[self.at - n:self.at]

    def number(self, code: str) -> Any:
        return struct.unpack(self.order + code, self.take(struct.calcsize(code)))[0]

    def u32(self) -> int:
        return int(self.number("I"))

    def text(self) -> str:
        raw = self.take(self.u32())
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError:
            return raw.decode("cp1252", "backslashreplace")  # older LabVIEW wrote the system's code page

    def timestamp(self) -> tuple[int, int]:
        if self.order == "<":
            fraction, seconds = struct.unpack("<Qq", self.take(16))
        else:
            seconds, fraction = struct.unpack(">qQ", self.take(16))
        return seconds, fraction

    def property(self) -> tuple[str, Any]:
        name, kind = self.text(), self.u32()
        if kind == STRING:
            return name, self.text()
        if kind == TIMESTAMP:
            return name, Timestamp(*self.timestamp())
        if kind == BOOL:
            return name, bool(self.number("B"))
        codes = {1: "b", 2: "h", 3: "i", 4: "q", 5: "B", 6: "H", 7: "I", 8: "Q", 9: "f", 10: "d", 0x19: "f", 0x1A: "d"}
        if kind in codes:
            return name, self.number(codes[kind])
        if kind in _SIZE:
            return name, self.take(_SIZE[kind]).hex()
        raise DamageError(f"property '{name}' has the unknown type 0x{kind:X}")

    def raw_index(self, header: int) -> RawIndex:
        if header not in (20, 28):
            raise DamageError(f"a raw data index of length {header}")
        kind, dimension, n = self.u32(), self.u32(), int(self.number("Q"))
        if dimension != 1:
            raise DamageError(f"a raw data index of dimension {dimension}")
        nbytes = int(self.number("Q")) if kind == STRING else 0
        if max(n, nbytes) > MOST:
            raise DamageError(f"a chunk of {n} values")
        if kind == STRING:
            return RawIndex(kind, n, nbytes)
        if kind not in _SIZE:
            raise DamageError(f"the unknown data type 0x{kind:X}")
        return RawIndex(kind, n, n * _SIZE[kind])

    def daqmx(self, header: int) -> RawIndex:
        kind, dimension, n, count = self.u32(), self.u32(), int(self.number("Q")), self.u32()
        if dimension != 1:
            raise DamageError(f"a DAQmx index of dimension {dimension}")
        scalers = []
        for _ in range(count):
            code, buffer, offset = self.u32(), self.u32(), self.u32()
            self.number("I" if header == FORMAT_CHANGING else "B")
            scale_id = self.u32()
            if code not in DAQMX_NUMPY:
                raise DamageError(f"the unknown DAQmx type {code}")
            bit = None if header == FORMAT_CHANGING else offset % 8
            scalers.append(Scaler(scale_id, DAQMX_NUMPY[code], buffer, offset if bit is None else offset // 8, bit))
        widths = tuple(self.u32() for _ in range(self.u32()))
        if not scalers or n > MOST:
            raise DamageError("a DAQmx index without a scaler" if not scalers else f"a chunk of {n} values")
        return RawIndex(kind, n, 0, tuple(scalers), widths)


@dataclass(frozen=True, slots=True)
class Timestamp:
    """Seconds since 1904-01-01 UTC and a fraction in units of 2^-64 s."""

    seconds: int
    fraction: int

    @property
    def ns(self) -> int:
        """Nanoseconds since 1970, rounded; exact in integers."""
        return (self.seconds - 2_082_844_800) * 1_000_000_000 + ((self.fraction * 1_000_000_000 + (1 << 63)) >> 64)

    def __str__(self) -> str:
        import numpy as np

        return f"{np.datetime64(self.ns, 'ns')}Z" if -(2**63) < self.ns < 2**63 else f"{self.seconds} s since 1904"


def _check(layout: Layout) -> None:
    if layout.objects and layout.chunk_bytes >= 1 << 62:
        raise DamageError("a chunk of impossible size")
    mixed = {bool(index.scalers) for _, index in layout.objects}
    if len(mixed) > 1:
        raise DamageError("DAQmx and plain channels in one segment")
    if layout.daqmx:
        if len({index.widths for _, index in layout.objects}) > 1:
            raise DamageError("DAQmx channels with different buffers in one segment")
        for path, index in layout.objects:
            for scaler in index.scalers:
                if scaler.buffer >= len(index.widths) or \
                        scaler.offset + int(scaler.dtype[1:]) > index.widths[scaler.buffer]:
                    raise DamageError(f"{path} lies outside its DAQmx buffer")
    elif layout.interleaved and (
        len({index.n for _, index in layout.objects}) > 1 or any(i.type == STRING for _, i in layout.objects)
    ):
        raise DamageError("interleaved channels of different lengths, or of text")


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
