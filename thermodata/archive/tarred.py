"""What a TAR archive holds. Its headers are no more trusted than its files: they can be made as large, and as many."""

from __future__ import annotations

import os
import tarfile
from contextlib import closing
from dataclasses import dataclass, replace
from io import BufferedReader
from pathlib import Path
from typing import IO, Any, cast

from thermodata.archive.packed_by import packed_by
from thermodata.archive.packers import OPEN, Unpacking
from thermodata.archive.regular import opened
from thermodata.archive.too_much import MOST_FILES, more_than_logs

_PART = 1 << 18
_ENDS = "it ends before its end mark: what came behind is lost"
_HEADER, _HEADERS = 1 << 20, 128 << 20  # [bytes] of one file, and of all: a long name is some 1.5 kB


@dataclass(frozen=True, slots=True)
class Member:
    """A file as an archive has it. why: it is not read; at: in a TAR archive, unpacked. cut: the archive ends within
    it, and size is what is left."""

    name: str
    size: int
    why: str | None
    at: int = 0
    cut: bool = False


@dataclass(frozen=True, slots=True)
class Tarred:
    """ended: whether the end mark stands behind the files; torn: whether it is known to be cut off, within a file, its
    header or the zeros behind it. One that ends between two files may have no more of them."""

    members: list[Member]
    ended: bool = True
    torn: bool = False


def tarred(archive: Path, most: int) -> Tarred:
    """No further than to where there are too many files, or bytes: FormatError. TarError and what unpacks say where it
    is damaged, EOFError where it is cut off within its first file's header."""
    with opened(archive) as file:
        packer = packed_by(file.read(16))
        file.seek(0)
        with closing(cast(Unpacking, file) if packer is None else OPEN[packer](file)) as stream:
            try:
                return _members(_Forward(stream, archive.name, most))
            except RecursionError:
                raise tarfile.ReadError("one header stands before the other, and no file behind them") from None


def _members(stream: _Forward) -> Tarred:
    found, count, size = list[Member](), 0, 0
    try:
        with tarfile.open(fileobj=cast(IO[bytes], stream), mode="r:") as tar:
            while (m := tar.next()) is not None:
                cast(Any, tar).members.clear()  # each has a copy of what the archive says of all
                stream.begin_header()
                count += 1
                if m.size < 0:
                    raise tarfile.ReadError(f"a file of {m.size} bytes, by the header at byte {m.offset}")
                if not m.isdir():
                    held = 0 if m.issparse() else m.size  # no gap is unpacked
                    found.append(Member(m.name, held, _why_not_read(m), m.offset_data))
                    size += held
                if count > MOST_FILES or size > stream.most:
                    raise more_than_logs(stream.name, stream.most, count, size)
    except EOFError:
        if not found:
            raise
        return _cut(found, stream.end(), torn=not stream.between)
    stream.must_end()
    return Tarred(found)


def _cut(found: list[Member], end: int, torn: bool) -> Tarred:
    """The files of an archive that ends at a byte, without its end mark."""
    last = found[-1]
    if last.at + last.size <= end:
        return Tarred(found, ended=False, torn=torn)
    if (left := end - last.at) > 0:
        return Tarred([*found[:-1], replace(last, size=left, cut=True)], ended=False, torn=True)
    if len(found) == 1:
        raise EOFError(_ENDS)
    return Tarred(found[:-1], ended=False, torn=True)


def _why_not_read(member: tarfile.TarInfo) -> str | None:
    if member.issparse():
        return "it is packed without its gaps, as 'tar --sparse' does"
    return None if member.isreg() else "it is a link, or no plain file"


class _Forward:
    """An archive for `tarfile`: never back, never on beyond what may be unpacked, never short without an error.
    between: it ends where a header may begin, and what it is packed in is whole."""

    def __init__(self, stream: Unpacking, name: str, most: int) -> None:
        self.name, self.most, self.between = name, most, False
        self._whole = True
        self._stream, self._at, self._block = stream, 0, b""
        self._header = self._headers = 0

    def tell(self) -> int:
        return self._at

    def end(self) -> int:
        """Where the archive ends."""
        if isinstance(self._stream, BufferedReader):
            return self._stream.seek(0, os.SEEK_END)
        return self._at

    def begin_header(self) -> None:
        """What is read from here on is of the next file."""
        self._header = 0

    def read(self, size: int) -> bytes:
        """Bytes of a header. EOFError where the archive ends within them."""
        if not 0 <= size <= _HEADER - self._header or size > _HEADERS - self._headers:
            raise tarfile.ReadError(f"the header at byte {self._at} is damaged, or of {size} bytes and more")
        self._header, self._headers = self._header + size, self._headers + size
        self._block = self._read_block(size)
        if len(self._block) < size:
            first = self._header <= 1 + tarfile.BLOCKSIZE  # behind the last byte of what stands before it
            self.between = self._whole and first and size == tarfile.BLOCKSIZE and not self._block
            raise EOFError(_ENDS)
        return self._block

    def seek(self, to: int) -> int:
        """On to the next header. Beyond the end nothing is read."""
        if to < self._at:
            raise tarfile.ReadError(f"the header at byte {self._at} leads back to byte {to}")
        if isinstance(self._stream, BufferedReader):
            self._at = self._stream.seek(to)
            return to
        more = True
        while more and self._at < to:  # unpacked, counted, and let go
            more = bool(self._read_block(min(to - self._at, _PART)))
        return self._at

    def must_end(self) -> None:
        """ReadError where the last header read is no end mark, or more than zeros stands behind it."""
        if any(self._block):
            raise tarfile.ReadError(f"the header at byte {self._at - len(self._block)} is damaged")
        while part := self._read_block(_PART):
            if any(part):
                raise tarfile.ReadError(
                    "more stands behind its end mark: of two archives in one, 'tar -i' unpacks both"
                )

    def _read_block(self, size: int) -> bytes:
        parts, missing = [], size
        while missing and (part := self._next_bytes(missing)):
            parts.append(part)
            missing -= len(part)
            self._at += len(part)
            if self._at > self.most and not isinstance(self._stream, BufferedReader):
                raise more_than_logs(self.name, self.most, 0, self._at)
        return b"".join(parts)

    def _next_bytes(self, size: int) -> bytes:
        """What comes next, at most so many bytes; nothing where a packed one is cut off: what stands before the cut was
        given."""
        try:
            return self._stream.read1(size)
        except EOFError:
            self._whole = False
            return b""
