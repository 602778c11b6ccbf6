"""The metadata of a TDMS segment, field by field: what a chunk holds, and the properties of each object."""

from __future__ import annotations

import struct
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

from thermodata_reader_crio.tdms.segments.chunk_layout import (
    DAQMX_NUMPY,
    MOST,
    NUMPY,
    STRING,
    TIMESTAMP,
    DamageError,
    RawIndex,
    Scaler,
)

NO_DATA, SAME_DATA = 0xFFFFFFFF, 0
# the documentation names the second one 0x1369; files hold 0x126A
FORMAT_CHANGING, DIGITAL_LINES = 0x1269, (0x126A, 0x1369)
_VOID, _BOOL = 0, 0x21
_MOST_ALIKE = 4096  # different lists that are remembered
T = TypeVar("T")
_UNSIZED = {
    0x0B: "extended floating point numbers",
    0x1B: "extended floating point numbers with unit",
    0x4F: "fixed-point numbers",
}
_CODES = {1: "b", 2: "h", 3: "i", 4: "q", 5: "B", 6: "H", 7: "I", 8: "Q", 9: "f", 10: "d", 0x19: "f", 0x1A: "d"}


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


Properties = tuple[tuple[str, Any], ...]


class Object(NamedTuple):
    """One object of a segment's list. held: its values in a chunk; None: none here; SAME: as before."""

    path: str
    held: RawIndex | int | None
    properties: Properties


SAME = SAME_DATA


def parse(data: bytes, order: str) -> tuple[list[Object], int]:
    """The objects of a metadata block, and how many of its bytes they take. order: '<' or '>'."""
    read = Cursor(data, order)
    held, properties = _RepeatedBytes(read, read.held), _RepeatedBytes(read, read.properties)
    found = []
    for _ in range(read.u32()):
        read.path = read.text()
        found.append(Object(read.path, held.next(), properties.next()))
    return found, read.at


class _RepeatedBytes(Generic[T]):
    """What stands at one place of each object in turn. Equal bytes say the same: of 100,000 channels most are like
    another one, so they are parsed once and share one value."""

    def __init__(self, cursor: Cursor, parse: Callable[[], T]) -> None:
        self._cursor, self._parse = cursor, parse
        self._known: dict[bytes, T] = {}
        self._last: tuple[bytes, T] | None = None

    def next(self) -> T:
        """The next one, and the cursor behind it."""
        cursor = self._cursor
        # a parse depends on the bytes that it takes alone, so those of the last one say where this one ends
        if self._last is not None and cursor.data.startswith(self._last[0], cursor.at):
            cursor.at += len(self._last[0])
            return self._last[1]
        start = cursor.at
        value = self._parse()
        if len(self._known) >= _MOST_ALIKE:
            self._known.clear()
        taken = cursor.data[start : cursor.at]
        self._last = taken, self._known.setdefault(taken, value)
        return self._last[1]


class Cursor:
    """Reads the fields of a metadata block; anything beyond its end is damage."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data, self.order, self.at = data, order, 0
        self.path = ""  # of the object in hand, for what is said of damage
        self._u32 = struct.Struct(order + "I").unpack_from
        self._index = struct.Struct(order + "IIQ").unpack_from

    def take(self, n: int) -> bytes:
        """The next n bytes."""
        if n > len(self.data) - self.at:
            raise DamageError(f"a field of {n} bytes in metadata that ends after {len(self.data) - self.at}")
        self.at += n
        return self.data[self.at - n : self.at]

    def number(self, code: str) -> Any:
        """The next number, by struct's code for it."""
        return struct.unpack(self.order + code, self.take(struct.calcsize(code)))[0]

    def u32(self) -> int:
        """The next number of 4 bytes."""
        at = self.at
        if at + 4 > len(self.data):
            self.take(4)
        self.at = at + 4
        return int(self._u32(self.data, at)[0])

    def text(self) -> str:
        """The next text, behind its length."""
        raw = self.take(self.u32())
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError:
            return raw.decode("cp1252", "backslashreplace")  # older LabVIEW wrote the system's code page

    def timestamp(self) -> Timestamp:
        """The next 16 bytes as a point in time."""
        if self.order == "<":
            fraction, seconds = struct.unpack("<Qq", self.take(16))
        else:
            seconds, fraction = struct.unpack(">qQ", self.take(16))
        return Timestamp(seconds, fraction)

    def property(self) -> tuple[str, Any]:
        """The next property: its name and its value."""
        name, kind = sys.intern(self.text()), self.u32()
        if kind == STRING:
            return name, self.text()
        if kind in _CODES:
            return name, self.number(_CODES[kind])
        if kind == TIMESTAMP:
            return name, self.timestamp()
        if kind == _BOOL:
            return name, bool(self.number("B"))
        if kind in NUMPY:
            return name, self.take(int(NUMPY[kind][1:])).hex()
        if kind == _VOID:
            return name, ""
        raise DamageError(f"property '{name[:80]}' has the unknown type 0x{kind:X}")

    def properties(self) -> Properties:
        """The next list of properties, behind their number."""
        return tuple([self.property() for _ in range(self.u32())])

    def held(self) -> RawIndex | int | None:
        """What the next object has in a chunk: its index; None: nothing; SAME: what it had before."""
        header = self.u32()
        if header == NO_DATA:
            return None
        if header == SAME_DATA:
            return SAME
        if header == FORMAT_CHANGING or header in DIGITAL_LINES:
            return self.daqmx(header)
        return self.raw_index()

    def raw_index(self) -> RawIndex:
        """How a channel of plain values lies in a chunk."""
        if self.at + 16 > len(self.data):
            self.take(16)
        kind, dimension, n = self._index(self.data, self.at)
        self.at += 16
        if dimension != 1:
            raise DamageError(f"{self.path[:80]} has a raw data index of dimension {dimension}")
        nbytes = int(self.number("Q")) if kind == STRING else 0
        if max(n, nbytes) > MOST:
            raise DamageError(f"{self.path[:80]} declares a chunk of {max(n, nbytes)} values")
        if kind == STRING:
            if 4 * n > nbytes:
                raise DamageError(f"{self.path[:80]} declares {n} texts in {nbytes} bytes")
            return RawIndex(kind, n, nbytes)
        if kind in NUMPY:
            return RawIndex(kind, n, n * int(NUMPY[kind][1:]))
        if n == 0 and (kind == _VOID or kind in _UNSIZED):
            return RawIndex(5, 0, 0)
        if kind in _UNSIZED:
            raise DamageError(
                f"{self.path[:80]} holds {_UNSIZED[kind]} (type 0x{kind:X}), whose size the format leaves to "
                "the computer that wrote them: convert them to DBL in LabVIEW"
            )
        raise DamageError(f"{self.path[:80]} has the unknown data type 0x{kind:X}")

    def daqmx(self, header: int) -> RawIndex:
        """How a channel of DAQmx lies in the raw buffers of a chunk. header: which of its two kinds."""
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
        if len({s.scale_id for s in scalers}) < len(scalers):
            raise DamageError("a DAQmx index with the same scaler twice")
        return RawIndex(kind, n, 0, tuple(scalers), widths)
