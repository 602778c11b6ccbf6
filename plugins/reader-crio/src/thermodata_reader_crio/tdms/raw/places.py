"""The places of raw numbers in a chunk of a TDMS file: by blocks, by rows, or in the buffers of DAQmx."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from thermodata_reader_crio.tdms.segments.chunk_layout import NUMPY, STRING, Layout
from thermodata_reader_crio.tdms.segments.index import Shape

TEXT = "str"


class Kind(NamedTuple):
    """Type of the raw numbers; bit: of a digital line."""

    dtype: str
    big_endian: bool
    bit: int | None

    @property
    def item(self) -> int:
        """Bytes of one number; 0 for text."""
        return 0 if self.dtype == TEXT else int(self.dtype[1:])


class Slot(NamedTuple):
    """start: first byte in a chunk; n: values that are there; stride: bytes from value to value; full: values of a
    whole chunk."""

    path: str
    part: int | str | None
    kind: Kind
    start: int
    n: int
    stride: int
    full: int


def slots(layout: Layout, shape: Shape) -> list[Slot]:
    """Places in a full chunk, or in a shorter last one: cut off by the end of the file (what is there of each
    channel), or written shorter (all channels by the same share)."""
    if layout.daqmx:
        return _daqmx(layout, shape.tail)
    if layout.by_rows:
        return _rows(layout, shape.tail)
    return _blocks(layout, shape)


def _daqmx(layout: Layout, tail: int | None) -> list[Slot]:
    start, left, bases = 0, tail, []
    for rows, width in layout.buffers:
        have = rows if left is None else min(rows, max(left, 0) // width if width else 0)
        bases.append((start, have, width))
        start += rows * width
        left = None if left is None else left - rows * width
    found = []
    for path, index in layout.objects:
        # scalers of one channel that lie in several buffers end with the shorter one
        have = min(bases[s.buffer][1] for s in index.scalers)
        for scaler in index.scalers:
            base, _, width = bases[scaler.buffer]
            found.append(
                Slot(
                    path,
                    scaler.scale_id,
                    Kind(scaler.dtype, layout.big_endian, scaler.bit),
                    base + scaler.offset,
                    min(index.n, have),
                    width,
                    index.n,
                )
            )
    return found


def _rows(layout: Layout, tail: int | None) -> list[Slot]:
    sizes = [int(NUMPY[index.type][1:]) for _, index in layout.objects]
    width, at = sum(sizes), 0
    found: list[Slot] = []
    for (path, index), size in zip(layout.objects, sizes, strict=True):
        n = index.n if tail is None else tail // width
        found += _parts(path, NUMPY[index.type], layout.big_endian, at, n, width, index.n)
        at += size
    return found


def _blocks(layout: Layout, shape: Shape) -> list[Slot]:
    tail, at = shape.tail, 0
    found: list[Slot] = []
    for path, index in layout.objects:
        n, nbytes = index.n, index.nbytes
        if index.type == STRING:
            if tail is not None:
                n = n if at + nbytes <= tail and shape.cut else 0
            found.append(Slot(path, None, Kind(TEXT, layout.big_endian, None), at, n, nbytes, index.n))
            at += nbytes
            continue
        size = int(NUMPY[index.type][1:])
        if tail is not None and shape.cut:
            n = min(n, max(tail - at, 0) // size)
        elif tail is not None:
            n = n * tail // layout.chunk_bytes
            nbytes = n * size
        found += _parts(path, NUMPY[index.type], layout.big_endian, at, n, size, index.n)
        at += nbytes
    return found


def _parts(path: str, dtype: str, big_endian: bool, start: int, n: int, stride: int, full: int) -> Sequence[Slot]:
    if dtype[0] != "c":
        return [Slot(path, None, Kind(dtype, big_endian, None), start, n, stride, full)]
    half = int(dtype[1:]) // 2
    kind = Kind(f"f{half}", big_endian, None)
    return [Slot(path, part, kind, start + i * half, n, stride, full) for i, part in enumerate(("re", "im"))]
