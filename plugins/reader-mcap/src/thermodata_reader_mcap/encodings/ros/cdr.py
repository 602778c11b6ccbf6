"""The bytes of a CDR payload (ROS 2) or of one as ROS 1 stores it: order, alignment, lengths."""

from __future__ import annotations

import struct
from dataclasses import dataclass

FORMATS = {
    "?": "?",
    "i1": "b",
    "u1": "B",
    "i2": "h",
    "u2": "H",
    "i4": "i",
    "u4": "I",
    "i8": "q",
    "u8": "Q",
    "f4": "f",
    "f8": "d",
}
PADDING = 7  # bytes behind a message that writers leave


class PayloadError(Exception):
    """A payload that is none of the schema's messages."""


@dataclass(slots=True)
class Cursor:
    """Where in a payload its reading stands. order: "<" or ">". base: where alignment counts from; widest: the largest
    alignment (0: none, as ROS 1 stores)."""

    data: bytes
    at: int
    order: str
    base: int
    widest: int

    def align(self, size: int) -> None:
        """Goes on to the next multiple of a size in bytes, as far as the encapsulation aligns."""
        size = min(size, self.widest)
        if size > 1:
            self.at += -(self.at - self.base) % size

    def take(self, size: int) -> int:
        """The next bytes' place; PayloadError where the payload ends before."""
        begin = self.at
        if size > len(self.data) - begin:
            raise PayloadError(f"ends {begin + size - len(self.data)} bytes early")
        self.at = begin + size
        return begin

    def length(self) -> int:
        """The length of what follows, which can't be more than there are bytes."""
        self.align(4)
        (n,) = struct.unpack_from(self.order + "I", self.data, self.take(4))
        if n > len(self.data) - self.at:
            raise PayloadError(f"a length of {n} in {len(self.data)} bytes")
        return int(n)


_KINDS = {0: (">", 8), 1: ("<", 8), 6: (">", 4), 7: ("<", 4)}  # CDR and plain CDR 2, big and little endian


def begin(payload: bytes, ros1: bool) -> Cursor:
    """The start of a payload. PayloadError: an encapsulation that is not plain."""
    if ros1:
        return Cursor(payload, 0, "<", 0, 0)
    if len(payload) < 4:
        raise PayloadError("shorter than its head")
    kind = _KINDS.get(payload[1]) if payload[0] == 0 else None
    if kind is None:
        raise PayloadError(f"encapsulation {payload[0]:02x}{payload[1]:02x} is not supported")
    return Cursor(payload, 4, kind[0], 4, kind[1])
