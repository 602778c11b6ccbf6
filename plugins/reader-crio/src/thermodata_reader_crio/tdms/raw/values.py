"""Reading any rows of some columns of a TDMS file in few large reads, in bounded memory.

Rows are cut out of one buffer by strides, not value by value; values that lie in long runs are read straight into
their place.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import BinaryIO, Literal

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata_reader_crio.tdms.raw.columns import Column
from thermodata_reader_crio.tdms.raw.places import TEXT, Kind
from thermodata_reader_crio.tdms.raw.text import read_words

_GAP_BYTES = 16 * 1024  # a hole up to this size is cheaper to read over than to seek over
_LONG_RUN_BYTES = 32 * 1024  # a run from this size on is read straight into its place
_BUFFER_BYTES = 32 * 1024 * 1024
_MANY_RANGES = 64


@dataclass(frozen=True)
class _Cut:
    """Runs of one column, cut to the wanted rows: first byte, values, bytes from value to value: shape (k,);
    which: the place that each has."""

    offset: Int1D
    n: Int1D
    stride: Int1D
    which: Int1D


def read(file: BinaryIO, wanted: list[Column], first: int, last: int) -> list[Array]:
    """Rows [first, last) of each column, in native byte order; shorter where a column ends before.

    Timestamps come as int64 nanoseconds since 1970, text as object. OSError where the file became shorter.
    """
    numeric = [c for c in wanted if c.kinds[0].dtype != TEXT]
    found = {id(c): a for c, a in zip(numeric, _numbers(file, numeric, first, last), strict=True)}
    return [found[id(c)] if id(c) in found else read_words(file, c, first, last) for c in wanted]


def _numbers(file: BinaryIO, wanted: list[Column], first: int, last: int) -> list[Array]:
    out = [np.empty(max(0, min(last, c.length) - first), "i8" if c.dtype == "V16" else c.dtype) for c in wanted]
    todo = [(first, last)]
    while todo and wanted:
        a, b = todo.pop()
        memo: dict[tuple[int, bytes, bytes], _Cut] = {}
        cuts = [_cut(c, a, b, memo) for c in wanted]
        if all(_long(cut, c) for cut, c in zip(cuts, wanted, strict=True)):
            for cut, c, to in zip(cuts, wanted, out, strict=True):
                _read_straight(file, cut, c.kinds[0], to[a - first : b - first])
            continue
        start, end, base, places = _extents(cuts, wanted)
        if int((end - start).sum()) > _BUFFER_BYTES and b - a > 1:
            todo += [((a + b) // 2, b), (a, (a + b) // 2)]
            continue
        buffer = _fetch(file, start, end, base)
        for cut, c, place, to in zip(cuts, wanted, places, out, strict=True):
            _place(buffer, place, cut, c, to[a - first : b - first])
    return out


def _cut(column: Column, first: int, last: int, memo: dict[tuple[int, bytes, bytes], _Cut]) -> _Cut:
    last = min(last, column.length)
    if first >= last:
        empty = np.zeros(0, np.int64)
        return _Cut(empty, empty, empty, empty)
    key = (id(column.runs), column.n.tobytes(), column.stride.tobytes())
    shared = memo.get(key)
    if shared is None:
        shared = memo[key] = _expand(column, first, last)
    if column.start.size == 1:
        return _Cut(shared.offset + column.start[0], shared.n, shared.stride, shared.which)
    return _Cut(shared.offset + column.start[shared.which], shared.n, shared.stride, shared.which)


def _expand(column: Column, first: int, last: int) -> _Cut:
    """Runs of rows [first, last), counted from the start of each chunk: a run a chunk, or one for all chunks of a
    piece whose values lie evenly through them."""
    runs, row = column.runs, column.row
    a = int(np.searchsorted(row, first, "right")) - 1
    b = int(np.searchsorted(row, last, "left"))
    which, position = runs.which[a:b], runs.position[a:b]
    n, stride, pitch = column.n[which], column.stride[which], runs.pitch[which]
    low, high = np.zeros(b - a, np.int64), runs.chunks[a:b].copy()
    high[-1] = -((int(row[b - 1]) - last) // int(n[-1]))
    low[0] = (first - int(row[a])) // int(n[0])
    keep = n > 0
    if not keep.all():
        which, position, n, stride, pitch, low, high = (x[keep] for x in (which, position, n, stride, pitch, low, high))
    evenly = (n == 1) | (n * stride == pitch)
    skip = first - (int(row[a]) + int(low[0]) * int(n[0]))
    position = position + low * pitch
    chunks = high - low
    reps = np.where(evenly, 1, chunks)
    count = np.repeat(np.where(evenly, chunks * n, n), reps)
    stride = np.repeat(np.where(evenly, pitch // np.maximum(n, 1), stride), reps)
    inside = np.arange(int(reps.sum()), dtype=np.int64) - np.repeat(np.cumsum(reps) - reps, reps)
    offset = np.repeat(position, reps) + inside * np.repeat(pitch, reps)
    offset[0] += skip * stride[0]
    count[0] -= skip
    count[-1] -= int(count.sum()) - (last - first)
    return _Cut(offset, count, stride, np.repeat(which, reps))


# ---- long runs -----------------------------------------------------------------------------------


def _long(cut: _Cut, column: Column) -> bool:
    kind = column.kinds[0]
    plain = len(set(column.kinds)) == 1 and kind.bit is None and kind.dtype != "V16" and not kind.big_endian
    if not plain or not cut.n.size:
        return plain
    return bool((cut.stride == kind.item).all()) and int(cut.n.sum()) * kind.item >= _LONG_RUN_BYTES * cut.n.size


def _read_straight(file: BinaryIO, cut: _Cut, kind: Kind, out: Array) -> None:
    view = memoryview(out.view(np.uint8).data)
    at = 0
    for offset, count in zip(cut.offset.tolist(), (cut.n * kind.item).tolist(), strict=True):
        _exactly(file, offset, view[at : at + count])
        at += count


def _exactly(file: BinaryIO, offset: int, into: memoryview) -> None:
    file.seek(offset)
    if file.readinto(into) != len(into):  # type: ignore[attr-defined]
        raise OSError(f"the file became shorter while it was read (byte {offset})")


# ---- short runs ----------------------------------------------------------------------------------


def _extents(cuts: list[_Cut], columns: list[Column]) -> tuple[Int1D, Int1D, Int1D, list[Int1D]]:
    """(first byte, end, place in the buffer) of each merged read; and where in the buffer each run starts."""
    items = [np.array([k.item for k in c.kinds], np.int64) for c in columns]
    starts = np.concatenate([c.offset for c in cuts])
    if not starts.size:
        empty = np.zeros(0, np.int64)
        return empty, empty, empty, [empty] * len(cuts)
    ends = np.concatenate(
        [c.offset + (c.n - 1) * c.stride + item[c.which] for c, item in zip(cuts, items, strict=True)]
    )
    order = np.argsort(starts, kind="stable")
    sorted_starts = starts[order]
    reach = np.maximum.accumulate(ends[order])
    new = np.concatenate(([True], sorted_starts[1:] > reach[:-1] + _GAP_BYTES))
    begin = sorted_starts[new]
    end = reach[np.concatenate((np.flatnonzero(new)[1:] - 1, [reach.size - 1]))]
    base = np.cumsum(end - begin) - (end - begin)
    number = np.empty(starts.size, np.int64)
    number[order] = np.cumsum(new) - 1
    place = starts - begin[number] + base[number]
    return begin, end, base, np.split(place, np.cumsum([c.offset.size for c in cuts])[:-1])


def _fetch(file: BinaryIO, start: Int1D, end: Int1D, base: Int1D) -> Array:
    buffer = np.empty(int((end - start).sum()), np.uint8)
    view = memoryview(buffer.data)
    for at, begin, count in zip(base.tolist(), start.tolist(), (end - start).tolist(), strict=True):
        _exactly(file, begin, view[at : at + count])
    return buffer


def _place(buffer: Array, place: Int1D, cut: _Cut, column: Column, out: Array) -> None:
    """The values of a column's runs, from the buffer to their rows; kind by kind, where its type changes."""
    if len(set(column.kinds)) == 1:
        out[:] = _values(buffer, place, cut, column.kinds[0])
        return
    done = 0
    edges = [0, *(np.flatnonzero(np.diff(cut.which)) + 1).tolist(), place.size]
    for a, b in pairwise(edges):
        part = _Cut(cut.offset[a:b], cut.n[a:b], cut.stride[a:b], cut.which[a:b])
        values = _values(buffer, place[a:b], part, column.kinds[int(cut.which[a])])
        out[done : done + values.size] = values
        done += values.size


def _values(buffer: Array, place: Int1D, cut: _Cut, kind: Kind) -> Array:
    raw = _bytes(buffer, place, cut.n, cut.stride, kind.item)
    order: Literal["<", ">"] = ">" if kind.big_endian else "<"
    if kind.dtype == "V16":
        return timestamps(raw, order)
    values: Array = raw.view(np.dtype(kind.dtype).newbyteorder(order))
    return values if kind.bit is None else (values >> kind.bit) & 1


def _bytes(buffer: Array, place: Int1D, n: Int1D, stride: Int1D, item: int) -> Array:
    """The bytes of all values, one behind the other."""
    if place.size == 1 and stride[0] == item:
        return buffer[place[0] : place[0] + n[0] * item]
    ranges = _even(place, n, stride)
    total = int(n.sum())
    if len(ranges) > _MANY_RANGES:
        row = np.arange(total, dtype=np.int64) - np.repeat(np.cumsum(n) - n, n)
        where = np.repeat(place, n) + row * np.repeat(stride, n)
        windows = np.ndarray((buffer.size - item + 1,), f"V{item}", buffer.data, strides=(1,))
        gathered: Array = windows[where].view(np.uint8)
        return gathered
    out = np.empty((total, item), np.uint8)
    done = 0
    for a, b in ranges:
        k, rows, step = b - a, int(n[a]), int(stride[a])
        pitch = int(place[a + 1] - place[a]) if k > 1 else 0
        block = np.ndarray((k, rows, item), np.uint8, buffer.data, int(place[a]), (pitch, step, 1))
        out[done : done + k * rows].reshape(k, rows, item)[:] = block
        done += k * rows
    return out.reshape(-1)


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
    for b in [*(np.flatnonzero(~joins) + 1).tolist(), place.size]:
        ranges.append((a, b))
        a = b
    return ranges


def timestamps(raw: Array, order: str) -> Int1D:
    """TDMS timestamps as nanoseconds since 1970, rounded, in exact integers; outside of 1678 to 2261 the nearest
    of what int64 holds."""
    fields = [("f", "u8"), ("s", "i8")] if order == "<" else [("s", "i8"), ("f", "u8")]
    both = raw.view(np.dtype([(name, order + kind) for name, kind in fields]))
    fraction = both["f"].astype(np.uint64)
    billion, low_mask, shift = np.uint64(1_000_000_000), np.uint64(0xFFFFFFFF), np.uint64(32)
    low = ((fraction & low_mask) * billion) >> shift
    ns = ((fraction >> shift) * billion + low + np.uint64(1 << 31)) >> shift
    seconds = np.clip(both["s"].astype(np.int64), -6_900_000_000, 11_000_000_000) - 2_082_844_800
    return seconds * 1_000_000_000 + ns.astype(np.int64)
