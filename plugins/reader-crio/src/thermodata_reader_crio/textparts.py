"""Text files in large parts of whole lines, in bounded memory: the bytes as they are, for a fast parser."""

from __future__ import annotations

import codecs
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Int1D, Loss, Source
from thermodata.reader.text import find_encoding

PART_BYTES = 8 * 1024 * 1024
_HEAD_BYTES = 256 * 1024
_LONGEST_LINE = 32 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class Part:
    """Whole lines. line: number of the first; ended: False where the last of them has no line end, so may be cut."""

    line: int
    data: bytes
    ended: bool


@dataclass(frozen=True, slots=True)
class LineBlock(Block):
    """A block whose rows know their lines in the file, counted from 1, shape (n,)."""

    lines: Int1D | None = None

    def part(self, first: int, last: int) -> LineBlock:
        """Rows [first, last)."""
        cut = slice(first, last)
        return LineBlock(
            self.stream,
            self.t_ns[cut],
            {k: v[cut] for k, v in self.values.items()},
            None if self.flags is None else {k: v[cut] for k, v in self.flags.items()},
            None if self.lines is None else self.lines[cut],
        )


def place(
    blocks: Callable[[Path, Source], Iterator[Block | Loss]], path: Path, source: Source, stream: str, row: int
) -> str | None:
    """The line of a row (counted from 0) of a stream, as an editor counts; None where there is no such row."""
    done = 0
    for block in blocks(path, source):
        if isinstance(block, LineBlock) and block.stream == stream and block.lines is not None:
            if row < done + block.t_ns.size:
                return f"line {block.lines[row - done]}"
            done += block.t_ns.size
    return None


def encoding_of(path: Path, declared: str | None) -> tuple[str, str | None]:
    """(encoding, note or None) by the first lines; what stands further on is decoded cell by cell."""
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    if len(head) == _HEAD_BYTES:
        head = head[: max(head.rfind(b"\n"), head.rfind(b"\r"), _HEAD_BYTES // 2) + 1]
        if head[1:2] == b"\0" or head[:2] in (codecs.BOM_UTF16_BE, codecs.BOM_UTF16_LE):
            head = head[: len(head) // 2 * 2]
    if declared is not None:
        try:
            codecs.lookup(declared)
        except LookupError:
            raise FormatError(
                f"no encoding '{declared}'", expected="utf-8, cp1250, cp1252, utf-16, ...", got=declared
            ) from None
        return declared, None
    return find_encoding(head)


def parts(path: Path, encoding: str, size: int | None = None) -> Iterator[Part]:
    """The file's parts; UTF-16 comes as UTF-8, CR line ends as LF, and without a byte order mark."""
    wide = encoding.lower().replace("_", "-").startswith("utf-16")
    decoder = codecs.getincrementaldecoder(encoding)("replace") if wide else None
    carry, line, first = b"", 1, True
    with path.open("rb") as file:
        while block := file.read(size or PART_BYTES):
            if decoder is not None:
                block = decoder.decode(block).encode("utf-8", "replace")
            if first:
                block, first = block.removeprefix(codecs.BOM_UTF8), False
                cr_only = b"\r" in block and b"\n" not in block
            if cr_only:
                block = block.replace(b"\r", b"\n")
            end = block.rfind(b"\n") + 1
            if end == 0:
                carry += block
                if len(carry) > _LONGEST_LINE:
                    raise FormatError(
                        "a line without an end",
                        where=f"{path.name} line {line}",
                        expected=f"lines of less than {_LONGEST_LINE} bytes",
                        got=f"{len(carry)} bytes",
                    )
                continue
            data = carry + block[:end] if carry else block[:end]
            carry = block[end:]
            yield Part(line, data, True)
            line += count_lines(data)
    if carry:
        yield Part(line, carry, False)


def count_lines(data: bytes) -> int:
    """Line ends; bytes.count takes five times as long."""
    return int(np.count_nonzero(np.frombuffer(data, np.uint8) == 10))


def decode(raw: bytes, encoding: str) -> str:
    """A cell's or a line's text; what its encoding does not have is read as cp1252, so that nothing is dropped."""
    wide = encoding.lower().replace("_", "-").startswith("utf-16")
    try:
        return raw.decode("utf-8" if wide or encoding == "utf-8-sig" else encoding)
    except UnicodeDecodeError:
        return raw.decode("cp1252", "backslashreplace")
