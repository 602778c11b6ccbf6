"""Whether an HDF5 data set holds what it declares. HDF5 without checksums, as MATLAB writes it, reads a damaged layout
as zeros or as other bytes of the file without a word."""

from __future__ import annotations

from bisect import bisect_right
from itertools import product
from typing import Any

import numpy as np

_DEFLATE, _SHUFFLE, _FLETCHER = 1, 2, 3
_FEW = 5000  # chunks up to which they are held against the other data sets
_MAX_CHUNK = 256 << 20
_NONE = bytearray(1)  # room for no chunk: a search without a read
_RATIO = 1100  # deflate packs to a thousandth at best


class Spans:
    """The bytes of a file that are spoken for."""

    def __init__(self) -> None:
        self._starts: list[int] = []
        self._stops: list[int] = []

    def take(self, start: int, size: int) -> None:
        """ValueError where another data set has some of these bytes."""
        i = bisect_right(self._starts, start)
        if (i and self._stops[i - 1] > start) or (i < len(self._starts) and self._starts[i] < start + size):
            raise ValueError(f"{size} bytes at {start} belong to two data sets")
        self._starts.insert(i, start)
        self._stops.insert(i, start + size)


def check_stored(item: Any, kind: str, spans: Spans) -> None:
    """ValueError where a data set's type is not its MATLAB class's, or its bytes are not all there, or stand where
    they cannot. kind: the MATLAB class, or ''."""
    import h5py

    plain = {"double": "<f8", "single": "<f4", "logical": "|u1", "char": "<u2"}.get(kind)
    plain = plain or (np.dtype(kind).str if kind else None)
    # h5py shows a type with other exponent bits, or with padding, as the nearest that numpy has
    if not any(item.id.get_type().equal(h5py.h5t.py_create(item.dtype.newbyteorder(order))) for order in "<>"):
        raise ValueError(f"numbers of an unknown kind ({item.dtype})")
    if plain is not None and item.dtype.str != plain and kind not in ("char", "logical"):
        raise ValueError(f"a {kind} stored as {item.dtype}")
    size, declared = int(item.file.id.get_filesize()), check_size(item)
    if not declared:
        return
    if item.chunks is None:
        at = item.id.get_offset()
        # small values may stand inside the object's own header, which has no address
        if at is not None and not 0 < at <= size - declared:
            raise ValueError(f"{declared} bytes at {at} of {size}")
        if at is not None:
            spans.take(int(at), declared)
        return
    _check_chunks(item, size, declared, spans)


def check_size(item: Any) -> int:
    """The bytes that a data set declares. ValueError where it holds others: of one in pieces, any though it is
    empty."""
    declared, stored = int(item.size) * int(item.id.get_type().get_size()), int(item.id.get_storage_size())
    if stored != declared and (item.chunks is None or not declared):
        raise ValueError(f"declares {declared} bytes and holds {stored}")
    return declared


def check_found(item: Any) -> int:
    """The number of chunks of a data set, each of which a search finds; 0 where it is in one piece. ValueError where
    one is missing.

    A list of the chunks is no proof: it leaves out the last number of each key (the byte within a value, always 0),
    by which the search goes as well, and a chunk that the search misses reads as zeros.
    """
    if item.chunks is None or not item.size:
        return 0
    chunks = tuple(int(c) for c in item.chunks)
    whole = int(np.prod(chunks, dtype=object)) * item.dtype.itemsize
    if whole > _MAX_CHUNK:
        raise ValueError(f"chunks of {chunks}: more than {_MAX_CHUNK >> 20} MiB at once")
    counts = [-(-n // c) for n, c in zip(item.shape, chunks, strict=True)]
    wanted, listed = int(np.prod(counts, dtype=object)), int(item.id.get_num_chunks())
    if listed != wanted:
        raise ValueError(f"{listed} of {wanted} chunks are there")
    # the library tells the size of a chunk without filters unsearched, so that only a read of it searches
    room = _NONE if item.id.get_create_plist().get_nfilters() else bytearray(whole)
    for place in product(*(range(0, n * c, c) for n, c in zip(counts, chunks, strict=True))):
        _search(item.id, place, room)
    return wanted


def _search(item: Any, place: tuple[int, ...], room: bytearray) -> None:
    try:
        try:
            item.read_direct_chunk(place, out=room)
        except ValueError as error:
            # found and larger than the room, or one of the library's own errors, which a read repeats
            if "bytes required" not in str(error):
                item.read_direct_chunk(place)
    except (OSError, RuntimeError, ValueError):
        raise ValueError(f"a search does not find the chunk at {place}") from None


def _check_chunks(item: Any, size: int, declared: int, taken: Spans) -> None:
    create = item.id.get_create_plist()
    filters = [create.get_filter(i) for i in range(create.get_nfilters())]
    for code, _, values, _ in filters:
        if code not in (_DEFLATE, _SHUFFLE, _FLETCHER):
            raise ValueError(f"packed by an unknown filter ({code})")
        if code == _SHUFFLE and tuple(values[:1]) != (item.dtype.itemsize,):
            raise ValueError(f"shuffled by {values} bytes, of {item.dtype.itemsize}")
    if int(item.id.get_storage_size()) * _RATIO < declared:
        raise ValueError(f"declares {declared} bytes and holds {item.id.get_storage_size()}")
    wanted = check_found(item)
    whole = int(np.prod(item.chunks, dtype=object)) * item.dtype.itemsize
    packs = any(code == _DEFLATE for code, *_ in filters)
    spare = 4 if any(code == _FLETCHER for code, *_ in filters) else 0
    spans: list[tuple[int, int]] = []
    places: set[tuple[int, ...]] = set()

    def look(chunk: Any) -> None:
        # a filter that made nothing smaller is left out of a chunk, and its bit says so
        left_out = {code for i, (code, *_) in enumerate(filters) if chunk.filter_mask >> i & 1}
        if chunk.filter_mask >> len(filters) or _FLETCHER in left_out:
            raise ValueError(f"a chunk with filter mask {chunk.filter_mask}")
        if (not packs or _DEFLATE in left_out) and chunk.size != whole + spare:
            raise ValueError(f"a chunk of {chunk.size} bytes, not {whole}")
        spans.append((int(chunk.byte_offset), int(chunk.size)))
        places.add(tuple(int(o) for o in chunk.chunk_offset))

    item.id.chunk_iter(look)
    if len(places) != wanted or any(
        o % c or o >= n for place in places for o, c, n in zip(place, item.chunks, item.shape, strict=True)
    ):
        raise ValueError("chunks that are not where they belong")
    spans.sort()
    if len(spans) < _FEW:
        for at, length in spans:
            taken.take(at, length)
    for (at, length), (after, _) in zip(spans, [*spans[1:], (size, 0)], strict=True):
        if at <= 0 or at + length > after:
            raise ValueError(f"a chunk of {length} bytes at {at} runs into the next")
