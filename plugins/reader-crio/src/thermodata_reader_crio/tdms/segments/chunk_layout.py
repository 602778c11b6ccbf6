"""What one chunk of a TDMS segment holds: each channel's type and number of values, and the order of the bytes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

MOST = 1 << 48  # values or bytes a chunk; more is damage, and would overflow
STRING, BOOL, TIMESTAMP = 0x20, 0x21, 0x44

# TDMS type -> numpy's name; a timestamp is 16 bytes (fraction of 2^-64 s, seconds since 1904)
NUMPY = {
    1: "i1",
    2: "i2",
    3: "i4",
    4: "i8",
    5: "u1",
    6: "u2",
    7: "u4",
    8: "u8",
    9: "f4",
    10: "f8",
    0x19: "f4",
    0x1A: "f8",
    BOOL: "u1",
    TIMESTAMP: "V16",
    0x08000C: "c8",
    0x10000D: "c16",
}
DAQMX_NUMPY = {
    0: "u1",
    1: "i1",
    2: "u2",
    3: "i2",
    4: "u4",
    5: "i4",
    6: "u8",
    7: "i8",
    8: "f4",
    9: "f8",
    0xFFFFFFFF: "V16",
}


class DamageError(Exception):
    """What makes a segment unreadable."""


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


@dataclass(frozen=True)
class Layout:
    """What a chunk holds: (object path, its index) in order."""

    objects: tuple[tuple[str, RawIndex], ...]
    interleaved: bool
    big_endian: bool

    @cached_property
    def buffers(self) -> list[tuple[int, int]]:
        """DAQmx: (values, width in bytes) of each raw buffer."""
        widths = self.objects[0][1].widths
        rows = [0] * len(widths)
        for _, index in self.objects:
            for scaler in index.scalers:
                rows[scaler.buffer] = max(rows[scaler.buffer], index.n)
        return list(zip(rows, widths, strict=True))

    @cached_property
    def daqmx(self) -> bool:
        """Whether the chunk holds raw buffers of DAQmx."""
        return bool(self.objects) and bool(self.objects[0][1].scalers)

    @cached_property
    def by_rows(self) -> bool:
        """Whether plain values lie row by row. A single channel of text may carry the flag of interleaved data."""
        return self.interleaved and not self.daqmx and not any(i.type == STRING for _, i in self.objects)

    @cached_property
    def chunk_bytes(self) -> int:
        """Bytes of one whole chunk."""
        if self.daqmx:
            return sum(n * width for n, width in self.buffers)
        return sum(index.nbytes for _, index in self.objects)


def check(layout: Layout) -> None:
    """DamageError for a chunk that cannot be."""
    if len({bool(index.scalers) for _, index in layout.objects}) > 1:
        raise DamageError("DAQmx and plain channels in one segment")
    if layout.daqmx:
        if len({index.widths for _, index in layout.objects}) > 1:
            raise DamageError("DAQmx channels with different buffers in one segment")
        for path, index in layout.objects:
            for scaler in index.scalers:
                if (
                    scaler.buffer >= len(index.widths)
                    or scaler.offset + int(scaler.dtype[1:]) > index.widths[scaler.buffer]
                ):
                    raise DamageError(f"{path[:80]} lies outside its DAQmx buffer")
    elif (
        layout.interleaved
        and len(layout.objects) > 1
        and (len({index.n for _, index in layout.objects}) > 1 or any(i.type == STRING for _, i in layout.objects))
    ):
        raise DamageError("interleaved channels of different lengths, or of text")
    if layout.objects and layout.chunk_bytes >= 1 << 62:
        raise DamageError("a chunk of impossible size")
