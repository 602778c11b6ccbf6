"""How a file that is packed alone is unpacked, part by part."""

from __future__ import annotations

import bz2
import gzip
import lzma
from collections.abc import Callable
from io import BufferedReader
from typing import Protocol

SUFFIXES = (".gz", ".bz2", ".xz")
_PART = 1 << 18
_MOST_MEMORY = 256 << 20  # [bytes]: 'xz -9' takes 65 MiB, and a file may ask for 4 GiB


class Unpacking(Protocol):
    """Bytes as they were before they were packed; EOFError where those that are packed end too early."""

    def read(self, size: int, /) -> bytes: ...
    def read1(self, size: int, /) -> bytes: ...
    def close(self) -> None: ...


class _Xz:
    """The streams of an xz file, one behind the other. LZMAError where one is damaged, or asks for too much memory."""

    def __init__(self, file: BufferedReader) -> None:
        self._file, self._stream = file, _stream()

    def read1(self, size: int, /) -> bytes:
        while True:
            if self._stream.eof:
                data = self._stream.unused_data.lstrip(b"\0") or self._file.read(_PART)
                while data and not (data := data.lstrip(b"\0")):  # what fills up between streams
                    data = self._file.read(_PART)
                if not data:
                    return b""
                self._stream = _stream()
            else:
                data = self._file.read(_PART) if self._stream.needs_input else b""
                if self._stream.needs_input and not data:
                    raise EOFError("Compressed file ended before the end-of-stream marker was reached")
            if part := self._stream.decompress(data, size):
                return part

    read = read1

    def close(self) -> None:
        """Nothing but the file is open."""


def _stream() -> lzma.LZMADecompressor:
    return lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=_MOST_MEMORY)


OPEN: dict[str, Callable[[BufferedReader], Unpacking]] = {
    "gzip": lambda file: gzip.GzipFile(fileobj=file),
    "bzip2": bz2.BZ2File,
    "xz": _Xz,
}
"""By what `packed_by` calls it."""
