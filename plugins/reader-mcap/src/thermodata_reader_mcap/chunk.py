"""The records inside a chunk: decompressed and checked, or as much as a cut one still gives."""

from __future__ import annotations

import zlib
from typing import Any

from thermodata_reader_mcap.walk import ChunkHead

_MOST = 4 << 30      # a chunk that claims more is damaged, not large


class ChunkError(Exception):
    """A chunk that cannot be trusted; the message says why."""


def records(view: memoryview, head: ChunkHead, cut: bool) -> bytes:
    """The chunk's records. cut: the file ends inside the chunk; what is there is decompressed as far as it goes.

    ChunkError: unknown compression, damaged data, or a checksum that differs.
    """
    stored = view[head.start:head.stop]
    if head.size > _MOST:
        raise ChunkError(f"claims {head.size} bytes")
    if head.compression == "":
        data = bytes(stored)
    elif head.compression == "zstd":
        data = _zstd(stored, head.size, cut)
    elif head.compression == "lz4":
        data = _lz4(stored, cut)
    else:
        raise ChunkError(f"compression '{head.compression}' is not known")
    if cut:
        return data
    if len(data) != head.size:
        raise ChunkError(f"{len(data)} bytes instead of {head.size}")
    if head.crc and zlib.crc32(data) != head.crc:
        raise ChunkError("its checksum differs")
    return data


def _zstd(stored: memoryview, size: int, cut: bool) -> bytes:
    import zstandard

    if not cut:
        try:
            return zstandard.ZstdDecompressor().decompress(stored, max_output_size=size)
        except zstandard.ZstdError as error:
            raise ChunkError(f"zstd: {error}") from None
    return _as_far_as_it_goes(zstandard.ZstdDecompressor().decompressobj(), stored, zstandard.ZstdError)


def _lz4(stored: memoryview, cut: bool) -> bytes:
    import lz4.frame  # type: ignore[import-untyped]

    if not cut:
        try:
            return bytes(lz4.frame.decompress(stored))
        except RuntimeError as error:
            raise ChunkError(f"lz4: {error}") from None
    return _as_far_as_it_goes(lz4.frame.LZ4FrameDecompressor(), stored, (RuntimeError, EOFError))


def _as_far_as_it_goes(decompressor: Any, stored: memoryview, errors: Any) -> bytes:
    parts, step = [], 16 * 1024
    for at in range(0, len(stored), step):
        try:
            parts.append(decompressor.decompress(bytes(stored[at:at + step])))
        except errors:
            break
    return b"".join(parts)
