"""The records inside a chunk: decompressed and checked, or as much as a cut one still gives.

What a header claims is never believed before the bytes are there: memory follows what really unpacks, in steps,
and stops at the claimed size.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import Any

from thermodata_reader_mcap.container.records import Bytes, ChunkHead

_MOST = 1 << 30  # a chunk of more is damaged, not large
_RATIO, _FREE = 2000, 64 << 20  # above so many bytes, no log packs better than this
_STEP = 64 * 1024
_LZ4_FRAME = b"\x04\x22\x4d\x18"


class ChunkError(Exception):
    """A chunk that cannot be trusted; the message says why."""


def records(view: memoryview, head: ChunkHead, cut: bool) -> Bytes:
    """The chunk's records. cut: the file ends inside the chunk; what is there is decompressed as far as it goes.

    ChunkError: unknown compression, damaged data, a size that cannot be, or a checksum that differs.
    """
    stored = view[head.start : head.stop]
    if head.compression == "":
        data: Bytes = bytes(stored) if cut or len(stored) <= _FREE else stored
    elif head.compression in ("zstd", "lz4"):
        if head.size > _MOST or head.size > max(_FREE, _RATIO * len(stored)):
            raise ChunkError(f"claims {head.size} bytes out of {len(stored)}")
        data = (_zstd if head.compression == "zstd" else _lz4)(stored, head.size, cut)
    else:
        raise ChunkError(f"compression '{head.compression}' is not known")
    if cut:
        return data[: head.size]
    if len(data) != head.size:
        more = "more than " if len(data) > head.size else ""
        raise ChunkError(f"{more}{min(len(data), head.size)} bytes instead of {head.size}")
    if head.crc and zlib.crc32(data) != head.crc:
        raise ChunkError("its checksum differs")
    return data


def _zstd(stored: memoryview, size: int, cut: bool) -> bytes:
    import zstandard

    try:
        claimed = zstandard.frame_content_size(stored)
    except zstandard.ZstdError:
        claimed = -1
    if not cut and claimed == size:  # one frame that says the same: in one go
        try:
            return zstandard.ZstdDecompressor().decompress(stored, max_output_size=size)
        except zstandard.ZstdError as error:
            raise ChunkError(f"zstd: {error}") from None
    return _in_steps(
        lambda: zstandard.ZstdDecompressor().decompressobj(), stored, size, cut, "zstd", (zstandard.ZstdError, EOFError)
    )


def _lz4(stored: memoryview, size: int, cut: bool) -> bytes:
    import lz4.block  # type: ignore[import-untyped]
    import lz4.frame  # type: ignore[import-untyped]

    if stored[:4] != _LZ4_FRAME and not cut:  # some writers store a bare block
        try:
            return bytes(lz4.block.decompress(bytes(stored), uncompressed_size=size))
        except (lz4.block.LZ4BlockError, ValueError, MemoryError) as error:
            raise ChunkError(f"lz4: {error}") from None
    return _in_steps(lz4.frame.LZ4FrameDecompressor, stored, size, cut, "lz4", (RuntimeError, EOFError))


def _in_steps(make: Any, stored: memoryview, size: int, cut: bool, name: str, errors: Any) -> bytes:
    """Frame after frame (writers that use several threads store several), until more than `size` bytes are out."""
    parts: list[bytes] = []
    total = 0
    try:
        for part in _pieces(make, stored):
            parts.append(part)
            total += len(part)
            if total > size:
                break
    except errors as error:
        if not cut:
            raise ChunkError(f"{name}: {error}") from None
    return b"".join(parts)


def _pieces(make: Any, stored: memoryview) -> Iterator[bytes]:
    decompressor, waiting, at = make(), b"", 0
    while at < len(stored) or waiting:
        if not waiting:
            waiting, at = bytes(stored[at : at + _STEP]), at + _STEP
        if decompressor.eof:
            decompressor = make()
        part = decompressor.decompress(waiting)
        waiting = decompressor.unused_data or b"" if decompressor.eof else b""
        yield part
    if not decompressor.eof:
        raise EOFError("the compressed data end before their end")
