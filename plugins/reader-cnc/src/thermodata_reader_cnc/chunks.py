"""A text file as chunks of whole lines in UTF-8, in constant memory; and samples of it for a first look."""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.reader.text import find_encoding

CHUNK = 8 * 1024 * 1024
_PIECE = 16 * 1024
_PIECES = 6
WHOLE = 512 * 1024


@dataclass(frozen=True, slots=True)
class Chunk:
    """Whole lines: `data` in UTF-8, the 0-based number of its first line, its bytes in the file, last: at the end."""

    data: bytes
    line: int
    size: int
    last: bool


@dataclass(frozen=True, slots=True)
class Sample:
    """The file's first lines, lines from places between, and its last lines. whole: the head is all of it."""

    head: tuple[str, ...]
    rest: tuple[str, ...]
    encoding: str
    note: str | None
    whole: bool
    ends_with_newline: bool


def sample(path: Path, declared: str | None, whole_up_to: int = WHOLE) -> Sample:
    """What a first look sees: all of a file up to 512 KiB, else a quarter of that and pieces up to its end. A log
    whose items may come late is looked at with a larger `whole_up_to`."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(whole_up_to if size <= whole_up_to else whole_up_to // 4)
        wide = head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\0" in head[:200]
        pieces = []
        if size > len(head):
            for k in range(1, _PIECES + 1):
                at = max(len(head), (size - _PIECE) * k // _PIECES) // 2 * 2
                file.seek(at)
                pieces.append(file.read(_PIECE))
    whole = size <= len(head)
    if whole:
        start = head
    elif wide:
        start = head[: len(head) // 2 * 2]
    else:
        start = head[: head.rfind(b"\n") + 1] or head
    inner = [p[p.find(b"\n") + 1:p.rfind(b"\n") + 1] for p in pieces] if not wide else []
    encoding, note = find_encoding(start + b"".join(inner), declared)
    text = start.decode(encoding, "replace")
    rest: list[str] = []
    for piece in pieces:
        plain = "utf-16-be" if head.startswith(codecs.BOM_UTF16_BE) or encoding == "utf-16-be" else "utf-16-le"
        lines = piece.decode(plain if wide else _bare(encoding), "replace").split("\n")
        rest += [line.rstrip("\r") for line in lines[1:-1]]
    tail = pieces[-1] if pieces else head
    ends = tail.rstrip(b"\0").endswith((b"\n", b"\r"))
    return Sample(_lines(text, whole), tuple(rest), encoding, note, whole, ends)


def _bare(encoding: str) -> str:
    return "utf-8" if encoding.replace("_", "-") == "utf-8-sig" else encoding


def _lines(text: str, whole: bool) -> tuple[str, ...]:
    if "\n" not in text and "\r" in text:
        text = text.replace("\r", "\n")
    lines = [line.rstrip("\r") for line in text.split("\n")]
    return tuple(lines if whole and lines[-1] else lines[:-1])


def chunks(path: Path, encoding: str, size: int = CHUNK) -> Iterator[Chunk]:
    """The file's lines in chunks, without a byte order mark; lines end as in the file (a lone CR becomes LF). The
    last chunk is marked, and ends without a line end where the file does."""
    wide = encoding.startswith("utf-16")
    decoder = codecs.getincrementaldecoder(encoding)("replace") if wide else None
    total, line, rest, first = path.stat().st_size, 0, b"", True
    mac: bool | None = None
    with path.open("rb") as file:
        done = 0
        while True:
            data = file.read(size)
            done += len(data)
            last = not data or done >= total
            if decoder is not None:
                data = decoder.decode(data, final=last).encode()
            if first:
                data, first = data.removeprefix(codecs.BOM_UTF8), False
            if mac is None and data:
                mac = b"\n" not in data and b"\r" in data
            if mac:
                data = data.replace(b"\r", b"\n")
            data = rest + data
            cut = len(data) if last else data.rfind(b"\n") + 1
            if not cut and len(data) > 4 * size:
                cut = len(data)                          # no lines: zeros where a file was allocated in advance
            part, rest = data[:cut], data[cut:]
            if part or last:
                part = part if wide else _utf8(part, encoding)
                yield Chunk(part, line, done, last)
                line += part.count(b"\n")
            if last:
                return


def _utf8(data: bytes, encoding: str) -> bytes:
    """Whole lines in UTF-8. A first look may have seen ASCII only, so bytes that do not decode are looked at anew."""
    if data.isascii():
        return data
    for name in (_bare(encoding), None):
        try:
            text = data.decode(name or find_encoding(data)[0])
        except (UnicodeDecodeError, FormatError):
            continue
        return data if name == "utf-8" else text.encode()
    return data.decode("cp1252", "replace").encode()
