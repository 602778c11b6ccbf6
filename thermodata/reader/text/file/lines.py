"""A text file as chunks of whole lines in UTF-8, in constant memory; and samples of it for a first look."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.reader.text.file.encoding import bare, find_encoding, is_wide

CHUNK = 8 * 1024 * 1024
_PIECE = 16 * 1024
_PIECES = 6
WHOLE = 512 * 1024
_LONGEST_LINE = 1024 * 1024  # that chunks of any size keep whole
ODD = "its bytes are not of the file's encoding; read as they look"


@dataclass(frozen=True, slots=True)
class Chunk:
    """Whole lines: `data` in UTF-8, the 0-based number of its first line, its bytes in the file, last: at the end.
    odd: numbers of lines whose bytes are not of the file's encoding and were read otherwise (the first ones)."""

    data: bytes
    line: int
    size: int
    last: bool
    odd: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Sample:
    """The file's first lines, lines from places between, and its last lines. whole: the head is all of it.
    pieces: how many lines of `rest` each place has."""

    head: tuple[str, ...]
    rest: tuple[str, ...]
    encoding: str
    note: str | None
    whole: bool
    ends_with_newline: bool
    pieces: tuple[int, ...] = ()


def sample(path: Path, declared: str | None, whole_up_to: int = WHOLE) -> Sample:
    """What a first look sees: all of a file up to 512 KiB, else a quarter of that and pieces up to its end. A log
    whose items may come late is looked at with a larger `whole_up_to`."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(whole_up_to if size <= whole_up_to else whole_up_to // 4)
        wide = head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\0" in head[:200]
        other = declared is not None and is_wide(declared)
        pieces = []
        if size > len(head) and not (other and not bare(str(declared)).startswith("utf-16")):
            for k in range(1, _PIECES + 1):
                at = max(len(head), (size - _PIECE) * k // _PIECES)
                at = at // 2 * 2 if wide else at  # of two bytes a letter; the last piece ends with the file
                file.seek(at)
                pieces.append(file.read(_PIECE))
    whole = size <= len(head)
    if whole:
        start = head
    elif wide:
        start = head[: len(head) // 2 * 2]
    else:
        start = head[: head.rfind(b"\n") + 1] or head
    inner = [p[p.find(b"\n") + 1 : p.rfind(b"\n") + 1] for p in pieces] if not wide else []
    encoding, note = _mostly_utf8(start + b"".join(inner)) if declared is None else ("", None)
    if not encoding:
        encoding, note = find_encoding(start + b"".join(inner), declared)
    text = start.decode(encoding, "replace")
    rest: list[str] = []
    sizes: list[int] = []
    for piece in pieces:
        plain = "utf-16-be" if head.startswith(codecs.BOM_UTF16_BE) or encoding == "utf-16-be" else "utf-16-le"
        lines = piece.decode(plain if wide else bare(encoding), "replace").split("\n")
        rest += [line.rstrip("\r") for line in lines[1:-1]]
        sizes.append(len(lines[1:-1]))
    tail = pieces[-1] if pieces else head
    ends = tail.rstrip(b"\0").endswith((b"\n", b"\r"))
    return Sample(_lines(text, whole), tuple(rest), encoding, note, whole, ends, tuple(sizes))


def _mostly_utf8(data: bytes) -> tuple[str, str | None]:
    """UTF-8 of which a few lines are not (a text file written to by two programs), with a note; '' for other text."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        text = data.decode("utf-8", "surrogateescape")
        escaped = sum("\udc80" <= c <= "\udcff" for c in text if c > "\x7f")
        if sum(c > "\x7f" for c in text) > 5 * escaped:
            return "utf-8", f"not all UTF-8 (first at byte {error.start}); such lines are read as they look"
    return "", None


def _lines(text: str, whole: bool) -> tuple[str, ...]:
    if "\n" not in text and "\r" in text:
        text = text.replace("\r", "\n")
    lines = [line.rstrip("\r") for line in text.split("\n")]
    return tuple(lines if whole and lines[-1] else lines[:-1])


def chunks(path: Path, encoding: str, size: int = CHUNK) -> Iterator[Chunk]:
    """The file's lines in chunks, without a byte order mark; lines end as in the file (a lone CR becomes LF). The
    last chunk is marked, and ends without a line end where the file does."""
    wide = is_wide(encoding)
    decoder = codecs.getincrementaldecoder(encoding)("replace") if wide else None
    total, line, rest, first = path.stat().st_size, 0, b"", True
    odd: tuple[int, ...] = ()
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
            if mac is None and data:  # a CR at the end may be half of a CR LF
                mac = False if b"\n" in data else b"\r" in rest[-1:] + (data if last else data[:-1]) or None
                rest = rest.replace(b"\r", b"\n") if mac else rest
            if mac:
                data = data.replace(b"\r", b"\n")
            cut = len(data) if last else data.rfind(b"\n") + 1
            if not cut and len(rest) + len(data) > max(4 * size, _LONGEST_LINE):
                cut = len(data)  # no lines: zeros where a file was allocated in advance
            # one copy of what was read, and none held while it is used
            part = b"".join((rest, memoryview(data)[:cut])) if cut or last else b""
            rest = data[cut:] if cut or last else rest + data
            del data
            if part or last:
                part, odd = (part, ()) if wide else _utf8(part, encoding, line)
                yield Chunk(part, line, done, last, odd)
                line += count(part, b"\n")
            if last:
                return


def count(data: bytes, letter: bytes) -> int:
    """How often one byte occurs; bytes.count takes five times as long."""
    return int(np.count_nonzero(np.frombuffer(data, np.uint8) == letter[0]))


def from_line(parts: Iterable[Chunk], first: int) -> Iterator[Chunk]:
    """The chunks from a line on (0-based): a table without its header."""
    for part in parts:
        if part.line >= first:
            yield part
            continue
        at, line = 0, part.line
        while line < first and (end := part.data.find(b"\n", at) + 1):
            at, line = end, line + 1
        data = part.data[at:] if line == first else b""
        if data or part.last:
            yield Chunk(data, first, part.size, part.last, tuple(n for n in part.odd if n >= first))


def split_last_line(data: bytes) -> tuple[bytes, bytes]:
    """(whole lines, what stands behind the last line end)."""
    cut = data.rfind(b"\n") + 1
    return data[:cut], data[cut:]


def _utf8(data: bytes, encoding: str, first: int) -> tuple[bytes, tuple[int, ...]]:
    """(whole lines in UTF-8, the first lines that are not of the encoding). Such a line is read as what it looks like,
    or with replacement characters: it is reported, never dropped."""
    if data.isascii():
        return data, ()
    name = bare(encoding)
    with suppress(UnicodeDecodeError):  # then line by line
        text = data.decode(name)
        return (data if name == "utf-8" else text.encode()), ()
    lines, odd = data.split(b"\n"), []
    for k, line in enumerate(lines):
        try:
            lines[k] = line.decode(name).encode()
        except UnicodeDecodeError:
            odd.append(first + k)
            try:
                lines[k] = line.decode(find_encoding(line)[0]).encode()
            except (UnicodeDecodeError, FormatError):
                lines[k] = line.decode("cp1252", "replace").encode()
    return b"\n".join(lines), tuple(odd[:1000])


def last_line_is_whole(line: str, before: str, delimiter: str) -> bool:
    """Whether a last line without a line end may be taken: as many fields as the line before, and a last field
    that is the same, or a fraction with as many digits after its mark. A cut "12.5" of "12.53", or
    "100" of "1000", would pass for a value; rather one good row is reported as lost than that."""
    if line.count(delimiter) != before.count(delimiter):
        return False
    fields = [text.rstrip().rsplit(delimiter, 1)[-1].strip() for text in (line, before)]
    if fields[0] and fields[0] == fields[1]:
        return True
    digits = [len(re.split(r"[.,]", text)[-1]) if re.match(r"^[+-]?\d*[.,]\d+$", text) else 0 for text in fields]
    return digits[0] >= digits[1] > 0


def without_cut_line(data: bytes, delimiter: str) -> tuple[bytes, bool]:
    """(the lines, whether a last one without a line end was left out of them, for it may be cut). data: UTF-8."""
    if not data or data.endswith(b"\n"):
        return data, False
    *_, before, last = b"\n".join((b"", b"", data)).rsplit(b"\n", 2)
    if before.strip() and last_line_is_whole(last.decode("utf-8", "replace"), before.decode(), delimiter):
        return data, False
    return data[: len(data) - len(last)], True
