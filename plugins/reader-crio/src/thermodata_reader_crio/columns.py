"""Where each channel's values lie in a TDMS file, and reading any rows of them in few large reads.

A column is one raw number a sample: a channel, or one scaler of a DAQmx channel. Its values lie in runs: n values,
`stride` bytes apart, from a byte of the file. 24 h at 10 Hz may be 86,400 segments of 10 rows, so runs are arrays,
and rows are cut out of one buffer by strides, not value by value.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import BinaryIO, Literal

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata_reader_crio.index import Index, Piece
from thermodata_reader_crio.metadata import NUMPY, STRING, Layout

__all__ = ["Column", "columns", "read"]

_GAP_BYTES = 16 * 1024   # a hole up to this size is cheaper to read over than to seek over


@dataclass(frozen=True)
class Column:
    """offset: file position of each run, shape (k,); n: its values; stride: bytes between them (for text: the
    bytes of the whole run). planned: values that the file announced, more than there are where it was cut."""

    path: str
    scale_id: int | None
    dtype: str
    big_endian: bool
    bit: int | None
    offset: Int1D
    n: Int1D
    stride: Int1D
    planned: int

    @cached_property
    def row(self) -> Int1D:
        """First row of each run, and the end: shape (k + 1,)."""
        return np.concatenate(([0], np.cumsum(self.n))).astype(np.int64)

    @property
    def length(self) -> int:
        return int(self.row[-1])

    @property
    def itemsize(self) -> int:
        return 0 if self.dtype == "str" else int(self.dtype[1:])


@dataclass(frozen=True)
class _Slot:
    """A column's place in one chunk layout."""

    path: str
    scale_id: int | None
    dtype: str
    bit: int | None
    start: int
    n: int
    stride: int
    nbytes: int


def _slots(layout: Layout, tail: int | None = None, cut: bool = False) -> list[_Slot]:
    """Places in a full chunk, or in a shorter last one of `tail` bytes: cut off by the end of the file (what is
    there of each channel), or written shorter (all channels by the same share)."""
    found: list[_Slot] = []
    if layout.daqmx:
        start, left, bases = 0, tail, []
        for rows, width in layout.buffers():
            have = rows if left is None else min(rows, max(left, 0) // width if width else 0)
            bases.append((start, have, width))
            start += rows * width
            left = None if left is None else left - rows * width
        for path, index in layout.objects:
            for scaler in index.scalers:
                base, have, width = bases[scaler.buffer]
                n = min(index.n, have)
                found.append(_Slot(path, scaler.scale_id, scaler.dtype, scaler.bit, base + scaler.offset, n, width,
                                   n * width))
        return found
    width = sum(_item(index.type) for _, index in layout.objects)
    at = 0
    for path, index in layout.objects:
        size = _item(index.type)
        dtype = "str" if index.type == STRING else NUMPY[index.type]
        if layout.interleaved:
            n = index.n if tail is None else tail // width
            found.append(_Slot(path, None, dtype, None, at, n, width, n * width))
            at += size
            continue
        n, nbytes = index.n, index.nbytes
        if tail is not None:
            if index.type == STRING:
                n = n if at + nbytes <= tail and cut else 0
            elif cut:
                n = min(n, max(tail - at, 0) // size)
            else:
                n = n * tail // layout.chunk_bytes
                nbytes = n * size
        found.append(_Slot(path, None, dtype, None, at, n, nbytes if index.type == STRING else size, nbytes))
        at += nbytes
    return found


def _item(kind: int) -> int:
    return 0 if kind == STRING else int(NUMPY[kind][1:])


def columns(index: Index) -> dict[str, list[Column]]:
    """Each channel's columns (several for a DAQmx channel with several scalers), in the file's order."""
    runs: dict[tuple[str, int | None], list[tuple[Int1D, Int1D, Int1D]]] = {}
    kinds: dict[tuple[str, int | None], tuple[str, int | None, bool]] = {}
    planned: dict[tuple[str, int | None], int] = {}
    for number, group in _grouped(index.pieces):
        layout = index.layouts[number]
        full = _slots(layout)
        position = np.array([p.position for p in group], np.int64)
        count = np.array([p.chunks for p in group], np.int64)
        # chunk k of piece i starts at position[i] + k * chunk
        starts = np.repeat(position, count) + layout.chunk_bytes * (
            np.arange(count.sum(), dtype=np.int64) - np.repeat(np.cumsum(count) - count, count))
        last = group[-1]
        ends = _slots(layout, last.tail, last.cut) if last.tail else [None] * len(full)
        for slot, end in zip(full, ends, strict=True):
            key = (slot.path, slot.scale_id)
            kind = (slot.dtype, slot.bit, layout.big_endian)
            if kinds.setdefault(key, kind)[:2] != kind[:2]:
                raise ValueError(f"{slot.path} changes its type from {kinds[key][0]} to {slot.dtype}")
            offset = starts + slot.start
            n = np.full(starts.size, slot.n, np.int64)
            if end is not None and end.n:
                offset = np.append(offset, last.position + last.chunks * layout.chunk_bytes + end.start)
                n = np.append(n, np.int64(end.n))
            if offset.size and slot.n:
                stride = np.full(offset.size, slot.stride, np.int64)
                runs.setdefault(key, []).append((offset, n, stride))
            planned[key] = planned.get(key, 0) + int(n.sum()) + (
                slot.n - (end.n if end else 0) if last.cut and (last.tail or not count.sum()) else 0)
    found: dict[str, list[Column]] = {}
    empty = np.zeros(0, np.int64)
    for key, (dtype, bit, big) in kinds.items():
        parts = runs.get(key, [])
        offset, n, stride = (np.concatenate([p[i] for p in parts]) if parts else empty for i in range(3))
        found.setdefault(key[0], []).append(Column(key[0], key[1], dtype, big, bit, offset, n, stride, planned[key]))
    return found


def _grouped(pieces: list[Piece]) -> list[tuple[int, list[Piece]]]:
    """Consecutive pieces of one layout; a piece with a tail ends its group."""
    groups: list[tuple[int, list[Piece]]] = []
    for piece in pieces:
        if not groups or groups[-1][0] != piece.layout or groups[-1][1][-1].tail:
            groups.append((piece.layout, []))
        groups[-1][1].append(piece)
    return groups


# ---- reading -------------------------------------------------------------------------------------


def read(file: BinaryIO, wanted: list[Column], first: int, last: int) -> list[Array]:
    """Rows [first, last) of each column, in native byte order; shorter where a column ends before."""
    cuts = [None if c.dtype == "str" else _runs(c, first, last) for c in wanted]
    numeric = [(cut, c) for cut, c in zip(cuts, wanted, strict=True) if cut is not None]
    buffer, places = _fetch(file, numeric)
    found: list[Array] = []
    for column, cut in zip(wanted, cuts, strict=True):
        if cut is None:
            found.append(_text(file, column, first, last))
        else:
            found.append(_values(buffer, next(places), cut, column))
    return found


def _runs(column: Column, first: int, last: int) -> tuple[Int1D, Int1D, Int1D]:
    """(offset, n, stride) of the runs that rows [first, last) touch, cut to them."""
    last = min(last, column.length)
    if first >= last:
        empty = np.zeros(0, np.int64)
        return empty, empty, empty
    a = int(np.searchsorted(column.row, first, "right")) - 1
    b = int(np.searchsorted(column.row, last, "left"))
    offset, n, stride = column.offset[a:b].copy(), column.n[a:b].copy(), column.stride[a:b]
    skip = first - int(column.row[a])
    offset[0] += skip * stride[0]
    n[0] -= skip
    n[-1] -= int(column.row[b]) - last
    return offset, n, stride


def _fetch(file: BinaryIO, cuts):  # type: ignore[no-untyped-def]
    """All runs in one buffer, read in merged extents; and, column by column, where in it each run starts."""
    starts = np.concatenate([c[0] for c, _ in cuts]) if cuts else np.zeros(0, np.int64)
    if not starts.size:
        return np.zeros(0, np.uint8), iter([c[0] for c, _ in cuts])
    ends = np.concatenate([c[0] + (c[1] - 1) * c[2] + column.itemsize for c, column in cuts])
    order = np.argsort(starts, kind="stable")
    reach = np.maximum.accumulate(ends[order])
    new = np.concatenate(([True], starts[order][1:] > reach[:-1] + _GAP_BYTES))
    extent_start = starts[order][new]
    extent_end = reach[np.concatenate((np.flatnonzero(new)[1:] - 1, [reach.size - 1]))]
    size = extent_end - extent_start
    base = np.cumsum(size) - size
    buffer = np.empty(int(size.sum()), np.uint8)
    view = memoryview(buffer.data)
    for at, begin, count in zip(base.tolist(), extent_start.tolist(), size.tolist(), strict=True):
        file.seek(begin)
        if file.readinto(view[at:at + count]) != count:  # type: ignore[attr-defined]
            raise OSError(f"the file became shorter while it was read (byte {begin})")
    number = np.empty(starts.size, np.int64)
    number[order] = np.cumsum(new) - 1
    place = starts - extent_start[number] + base[number]
    bounds = np.cumsum([c[0].size for c, _ in cuts])[:-1]
    return buffer, iter(np.split(place, bounds))


def _values(buffer: Array, place: Int1D, cut: tuple[Int1D, Int1D, Int1D], column: Column) -> Array:
    _, n, stride = cut
    item = column.itemsize
    total = int(n.sum())
    out = np.empty((total, item), np.uint8)
    done = 0
    for a, b in _even(place, n, stride):
        k, rows, step = b - a, int(n[a]), int(stride[a])
        pitch = int(place[a + 1] - place[a]) if k > 1 else 0
        block = np.lib.stride_tricks.as_strided(buffer[int(place[a]):], (k, rows, item), (pitch, step, 1),
                                                writeable=False)
        out[done:done + k * rows] = block.reshape(k * rows, item)
        done += k * rows
    order: Literal["<", ">"] = ">" if column.big_endian else "<"
    if column.dtype == "V16":
        return _timestamps(out.reshape(-1), order)
    native = np.dtype(column.dtype)
    values = out.reshape(-1).view(native.newbyteorder(order)).astype(native, copy=False)
    return values if column.bit is None else (values >> column.bit) & 1


def _even(place: Int1D, n: Int1D, stride: Int1D) -> list[tuple[int, int]]:
    """[a, b) ranges of runs of one length and stride at one pitch."""
    if place.size < 2:
        return [(0, place.size)] if place.size else []
    same = (n[1:] == n[:-1]) & (stride[1:] == stride[:-1])
    pitch = np.diff(place)
    ranges, a = [], 0
    # a run joins its predecessor where length, stride and pitch go on as they were
    joins = same.copy()
    joins[1:] &= ~(same[:-1]) | (pitch[1:] == pitch[:-1])
    breaks = np.flatnonzero(~joins) + 1
    for b in [*breaks.tolist(), place.size]:
        ranges.append((a, b))
        a = b
    return ranges


def _timestamps(raw: Array, order: str) -> Int1D:
    """TDMS timestamps as nanoseconds since 1970, rounded, in exact integers."""
    fields = [("f", "u8"), ("s", "i8")] if order == "<" else [("s", "i8"), ("f", "u8")]
    both = raw.view(np.dtype([(name, order + kind) for name, kind in fields]))
    fraction = both["f"].astype(np.uint64)
    billion, low_mask, shift = np.uint64(1_000_000_000), np.uint64(0xFFFFFFFF), np.uint64(32)
    low = ((fraction & low_mask) * billion) >> shift
    ns = ((fraction >> shift) * billion + low + np.uint64(1 << 31)) >> shift
    return (both["s"].astype(np.int64) - 2_082_844_800) * 1_000_000_000 + ns.astype(np.int64)


def _text(file: BinaryIO, column: Column, first: int, last: int) -> Array:
    """Strings: each run holds n end offsets of 4 bytes, then the bytes."""
    last = min(last, column.length)
    if first >= last:
        return np.empty(0, object)
    a = int(np.searchsorted(column.row, first, "right")) - 1
    b = int(np.searchsorted(column.row, last, "left"))
    words: list[str] = []
    order = ">u4" if column.big_endian else "<u4"
    for i in range(a, b):
        file.seek(int(column.offset[i]))
        n, raw = int(column.n[i]), file.read(int(column.stride[i]))
        ends = np.frombuffer(raw, order, n).astype(np.int64)
        body = raw[4 * n:]
        for begin, end in zip(np.concatenate(([0], ends[:-1])), ends, strict=True):
            words.append(body[begin:end].decode("utf-8", "backslashreplace"))
    skip = first - int(column.row[a])
    return np.array(words[skip:skip + last - first], object)
