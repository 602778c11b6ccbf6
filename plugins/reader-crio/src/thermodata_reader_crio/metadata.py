"""The metadata of a TDMS segment, field by field: what a chunk holds, and the properties of each object."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Any

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


class DamageError(Exception):
    """What makes the rest of the file unreadable."""


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


class Cursor:
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


def check(layout: Layout) -> None:
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
