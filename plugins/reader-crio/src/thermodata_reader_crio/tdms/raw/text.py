"""Text of a TDMS file: each chunk holds the end of each of its n texts (4 bytes a text), then their bytes."""

from __future__ import annotations

from typing import BinaryIO

import numpy as np

from thermodata.plugin import Array
from thermodata_reader_crio.tdms.raw.columns import Column

_PART = 50_000  # texts at once
_PART_BYTES = 8 << 20  # and their bytes
_LONGEST = 64 << 20  # a text of more is damage


def read_words(file: BinaryIO, column: Column, first: int, last: int) -> Array:
    """Rows [first, last) of a column of text, shape (n,), object; None where the file's own offsets can't be."""
    last = min(last, column.length)
    out = np.empty(max(0, last - first), object)
    row, runs = column.row, column.runs
    piece = int(np.searchsorted(row, first, "right")) - 1
    at = first
    while at < last:
        place = int(runs.which[piece])
        n, size = int(column.n[place]), int(column.stride[place])
        if n == 0 or at >= int(row[piece + 1]):
            piece += 1
            continue
        chunk, skip = divmod(at - int(row[piece]), n)
        count = min(n - skip, last - at, _PART)
        begin = int(runs.position[piece]) + chunk * int(runs.pitch[place]) + int(column.start[place])
        order = ">u4" if column.kinds[place].big_endian else "<u4"
        words = _chunk(file, begin, n, size, skip, count, order)
        out[at - first : at - first + len(words)] = words
        at += len(words)
    return out


def _chunk(file: BinaryIO, begin: int, n: int, size: int, skip: int, count: int, order: str) -> list[str | None]:
    """Texts [skip, skip + count) of a chunk of n texts in `size` bytes; fewer, but one, where they are long."""
    lead = 1 if skip else 0
    file.seek(begin + 4 * (skip - lead))
    ends = np.frombuffer(file.read(4 * (count + lead)), order).astype(np.int64)
    ends = ends if lead else np.concatenate(([0], ends))
    if ends.size != count + 1:
        raise OSError(f"the file became shorter while it was read (byte {begin})")
    body = size - 4 * n
    good = (ends[1:] >= ends[:-1]) & (ends[1:] <= body) & (ends[1:] - ends[:-1] < _LONGEST)
    fits = int(np.searchsorted(np.cumsum(np.where(good, ends[1:] - ends[:-1], 0)), _PART_BYTES, "right"))
    count = max(1, min(count, fits))
    good, ends = good[:count], ends[: count + 1]
    if not good.any():
        return [None] * count
    if not good.all():
        return [
            _read_text(file, begin + 4 * n + a, b - a) if fine else None
            for a, b, fine in zip(ends[:-1].tolist(), ends[1:].tolist(), good.tolist(), strict=True)
        ]
    low, high = int(ends[0]), int(ends[-1])
    raw = _exactly(file, begin + 4 * n + low, high - low)
    return [_text(raw[a - low : b - low]) for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)]


def _read_text(file: BinaryIO, at: int, size: int) -> str:
    return _text(_exactly(file, at, size))


def _exactly(file: BinaryIO, at: int, size: int) -> bytes:
    file.seek(at)
    raw = file.read(size)
    if len(raw) < size:
        raise OSError(f"the file became shorter while it was read (byte {at})")
    return raw


def _text(raw: bytes) -> str:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "backslashreplace")
