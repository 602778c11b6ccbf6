"""Finds the next record behind a damaged stretch, by the structure that records have."""

from __future__ import annotations

import mmap

import numpy as np

from thermodata_reader_mcap.container.mapped_file import MAPPED, release_pages
from thermodata_reader_mcap.container.records import (
    CHUNK,
    DATA_END,
    FOOTER,
    HEAD,
    HEADER,
    IN_DATA,
    IN_SUMMARY,
    MAGIC,
    MESSAGE,
    Bytes,
    Record,
    content_end,
)

_WINDOW = 4 << 20
_FOLLOWING = 2  # so many records must follow in a chain, or the end of the bytes
_MOST_MESSAGE = 1 << 32  # a message of more bytes is no message, where nothing else vouches for it


def next_record(view: Bytes, at: int, stop: int | None = None, kinds: frozenset[int] = IN_DATA) -> int | None:
    """The first place from `at` on (and before `stop`) where a chain of records begins; None where none does."""
    size = len(view) if stop is None else stop
    data, wanted = np.frombuffer(view, np.uint8), np.zeros(256, bool)
    wanted[[*(kinds - {HEADER}), *({DATA_END} if kinds is IN_DATA else ())]] = True
    gone = at
    for begin in range(at, size - HEAD.size + 1, _WINDOW):
        if begin - gone > MAPPED and isinstance(view, memoryview):
            gone = release_pages(view, -(-gone // mmap.PAGESIZE) * mmap.PAGESIZE, begin)
        part = data[begin : min(begin + _WINDOW, size - HEAD.size + 1) + HEAD.size - 1]
        n = part.size - HEAD.size + 1
        # the three highest bytes of a length are zero: no record has 2^40 bytes
        found = wanted[part[:n]] & (part[6 : 6 + n] == 0) & (part[7 : 7 + n] == 0) & (part[8 : 8 + n] == 0)
        for place in (np.flatnonzero(found) + begin).tolist():
            if _chain(view, place):
                return int(place)
    return None


def _chain(view: Bytes, at: int) -> bool:
    strong = False
    for k in range(_FOLLOWING + 1):
        if at == len(view) or view[at : at + len(MAGIC)] == MAGIC:
            return k > 0
        if at + HEAD.size > len(view):
            return strong
        opcode, length = HEAD.unpack_from(view, at)
        stop = at + HEAD.size + length
        if opcode == DATA_END:
            return bool(length == 4)
        if k and (opcode in IN_SUMMARY - IN_DATA or opcode == FOOTER):
            return True
        if opcode not in IN_DATA:
            return False
        if stop > len(view):
            return strong  # the file is cut inside it
        if opcode == MESSAGE and length > _MOST_MESSAGE:
            return False
        if content_end(view, Record(opcode, at + HEAD.size, stop)) != stop:
            return False
        if opcode == CHUNK:
            return True  # its lengths agree three times
        strong = strong or opcode != MESSAGE or k > 0
        at = stop
    return True
