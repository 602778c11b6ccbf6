"""The data elements of a MAT 5 file: a tag of type and length, then bytes; packed ones by zlib."""

from __future__ import annotations

import mmap
import struct
import tempfile
import zlib
from dataclasses import dataclass

MATRIX, PACKED, UTF8, UTF16, UTF32 = 14, 15, 16, 17, 18
MAX_UNPACKED = 6 << 30  # bytes of one file
_IN_MEMORY = 32 << 20  # longer variables are unpacked to a temporary file


class DamagedError(Exception):
    """Something in a variable does not add up; says what."""


@dataclass(frozen=True, slots=True)
class Element:
    """One element: its type, its bytes [start, stop), and where the next one begins."""

    kind: int
    start: int
    stop: int
    next: int


def element_at(data: memoryview, at: int, stop: int, order: str, *, padded: bool = True) -> Element:
    """The element at a place; raises DamagedError where it passes `stop`."""
    if at + 8 > stop:
        raise DamagedError("ends inside an element's tag")
    kind, size = struct.unpack_from(f"{order}II", data, at)
    if kind >> 16:
        size, kind = kind >> 16, kind & 0xFFFF
        if size > 4:
            raise DamagedError(f"a short element of {size} bytes")
        return Element(kind, at + 4, at + 4 + size, at + 8)
    end = at + 8 + size
    if end > stop:
        raise DamagedError(f"an element of {size} bytes where {stop - at - 8} are left")
    after = end if kind == PACKED or not padded else min(stop, (end + 7) // 8 * 8)
    return Element(kind, at + 8, end, after)


def unpacked(packed: memoryview, budget: list[int]) -> memoryview:
    """A zlib stream, whole and with its checksum right."""
    unpack = zlib.decompressobj()
    kept, spill, total = bytearray(), None, 0
    try:
        for at in range(0, len(packed), 1 << 18):
            raw = bytes(packed[at : at + (1 << 18)])
            while raw:
                part = unpack.decompress(raw, 1 << 20)
                raw = unpack.unconsumed_tail
                total += len(part)
                if total > budget[0]:
                    raise DamagedError(f"unpacks to more than {MAX_UNPACKED >> 30} GiB")
                kept += part
                if len(kept) > _IN_MEMORY:
                    # lives as long as the arrays that look into it
                    spill = spill or tempfile.TemporaryFile()  # noqa: SIM115 - closed below
                    spill.write(kept)
                    kept = bytearray()
            if unpack.eof:
                break
    except zlib.error as error:
        raise DamagedError(f"does not unpack ({error})") from None
    if not unpack.eof:
        raise DamagedError("its packed data end too early")
    budget[0] -= total
    if spill is None:
        return memoryview(bytes(kept))
    with spill:
        spill.write(kept)
        spill.flush()
        return memoryview(mmap.mmap(spill.fileno(), 0, access=mmap.ACCESS_READ))
