"""An LVM file from its first to its last line: headers, headings, and the rows between, in parts of whole lines."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Loss
from thermodata.reader.text.file.encoding import is_wide
from thermodata.reader.text.file.lines import CHUNK, ODD, Chunk, chunks
from thermodata.schema.words.sentences import counted
from thermodata_reader_crio.lvm.header import (
    END_SPECIAL,
    MARK,
    START_SPECIAL,
    Header,
    Packet,
    is_file_header,
    read_header,
    read_packet,
    split_heading,
)

PART_BYTES = CHUNK
_MOST_HEADER_LINES = 500
# what a heading's line starts with; NaN and Inf start a row
_KEY = re.compile(rb"(?!(?i:nan|inf|infinity)[\t,; ])(?:[A-Za-z_]|\*\*\*)")


@dataclass(frozen=True, slots=True)
class RowPart:
    """Lines of rows, in UTF-8. line: number of the first, from 0; ended: False where the last has no line end; more:
    whether a heading follows in what was read; byte: of the file, where these rows are the last that was read: behind
    it stand only some of them and what was not read yet."""

    line: int
    data: bytes
    ended: bool
    more: bool = False
    byte: int = 0


@dataclass(frozen=True, slots=True)
class Note:
    """What is odd about a header, in words."""

    text: str


Item = Header | Packet | RowPart | Loss | Note


def scan(path: Path, encoding: str) -> Iterator[Item]:
    """Header, then each packet and its rows; a Note where a header is odd, a Loss for a heading that can't be read, and
    for lines in another encoding. FormatError where there is no header, or no packet at all."""
    state = _Scan(path)
    for chunk in chunks(path, encoding, PART_BYTES):
        if chunk.odd:
            more = f" ({len(chunk.odd)} such lines)" if len(chunk.odd) > 1 else ""
            yield Loss(f"{path.name} line {chunk.odd[0] + 1}", reason=ODD + more)
        yield from state.part(chunk)
    yield from state.end()


def has_heading_behind(path: Path, encoding: str, rows: RowPart) -> bool:
    """Whether a heading may follow the first rows of a packet: there is none without a star."""
    if rows.more or is_wide(encoding):
        return True
    with path.open("rb") as file:
        file.seek(rows.byte)
        return any(b"*" in block for block in iter(lambda: file.read(1 << 20), b""))


class _Scan:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.header: Header | None = None
        self.packets = 0
        self.lost = False
        self.lines: list[str] = []
        self.state = "heading"  # or: names, rows, special
        self.before_special = ""
        self.rest = b""  # whole lines that may begin a heading
        self.strays: list[int] = []  # lines in a heading that are none of its

    def part(self, chunk: Chunk) -> Iterator[Item]:
        data, line = self.rest + chunk.data if self.rest else chunk.data, chunk.line - self.rest.count(b"\n")
        self.rest, at = b"", 0
        while at < len(data):
            if self.state == "rows":
                end = self._rows_end(data, at, chunk.last)
                more = end < len(data)
                if end > at:
                    if not self.lost:
                        # a header is less than half of what was read, but where it was read in small parts
                        yield RowPart(line, data[at:end], more or data.endswith(b"\n"), more, chunk.size // 2)
                    line += data.count(b"\n", at, end) if more else 0  # the next chunk brings its own number
                    at = end
                if more and self.state == "rows":
                    self.rest = data[at:]
                    return
                continue
            end = data.find(b"\n", at) + 1 or len(data)
            line += 1
            yield from self._heading_line(data[at:end].decode("utf-8", "replace").rstrip("\r\n"), line)
            at = end

    def _rows_end(self, data: bytes, at: int, last: bool) -> int:
        """Where the rows end that start at `at`: before a heading; before lines that may begin one, where more
        follows; or at the end of the data. Changes the state at a heading."""
        mark = at
        # a single byte is found ten times as fast as three
        while (mark := data.find(b"*", mark)) >= 0:
            if not data.startswith(b"***", mark):
                mark += 1
                continue
            begin = data.rfind(b"\n", 0, mark) + 1
            if begin == mark and data.startswith(START_SPECIAL.encode(), mark):
                self.state, self.before_special = "special", "rows"
                return max(begin, at)
            if begin == mark:
                self.state = "heading"
                return self._back(data, max(begin, at), at)
            mark += 3
        return len(data) if last else self._back(data, len(data), at)

    def _back(self, data: bytes, end: int, at: int) -> int:
        """Over the lines of a heading that lie before `end`, but not over more than a heading has."""
        for _ in range(_MOST_HEADER_LINES):
            begin = data.rfind(b"\n", at, end - 1) + 1 if end > at else 0
            begin = max(begin, at)
            if end <= at or not (_KEY.match(data, begin) or not data[begin:end].strip()):
                break
            end = begin
        return end

    def _heading_line(self, text: str, line: int) -> Iterator[Item]:
        """A line that is none of the rows, by what is read just now."""
        if self.state == "special":
            if text.startswith(END_SPECIAL):
                self.state = self.before_special
        elif text.startswith(START_SPECIAL):
            self.state, self.before_special = "special", self.state
        elif self.state == "names":
            if text.strip():
                yield from self._names(text, line)
        elif text.startswith(MARK):
            yield from self._end_of_heading(line)
        else:
            self._in_heading(text, line)

    def _in_heading(self, text: str, line: int) -> None:
        """A line of a heading, or one that is none of any."""
        says_something = bool(text.strip(" \t,;"))
        if "\0" in text or (says_something and self.packets and not _KEY.match(text.encode())):
            self.strays.append(line)
        elif says_something:
            self.lines.append(text)
            if len(self.lines) > _MOST_HEADER_LINES:
                raise FormatError(
                    "LVM header without an end",
                    where=f"{self.path.name} line {line}",
                    expected=MARK,
                    got=f"{_MOST_HEADER_LINES} lines without it",
                    hint="write it anew from LabVIEW with its headers whole, or as TDMS",
                )

    def _end_of_heading(self, line: int) -> Iterator[Item]:
        """At the mark that ends the file's header, or the heading of a packet."""
        if self.strays:
            yield Loss(
                f"{self.path.name} line {self.strays[0]}",
                reason=f"{counted(len(self.strays), 'line')} before a heading's end, of no heading",
            )
            self.strays = []
        if self.header is None or is_file_header(self.lines):
            yield from self._file_header(line)
        elif self.lines or not self.packets:
            self.state = "names"
        else:
            self.state = "rows"
            yield Loss(f"{self.path.name} line {line}", reason="the end of a header that is not there")

    def _file_header(self, line: int) -> Iterator[Item]:
        own, heading = split_heading(self.lines)
        header, odd = read_header(own)
        if odd is not None:
            yield Note(odd)
        if self.header is None or header != self.header:
            yield header
        self.header, self.lines = header, []
        if heading:
            yield Note(f"line {line}: no end of the file's header stands before the first heading")
            self.lines, self.state = heading, "names"

    def _names(self, text: str, line: int) -> Iterator[Item]:
        assert self.header is not None
        lines, self.lines, self.state, self.lost = self.lines, [], "rows", False
        if "\0" in text:
            yield Loss(
                f"{self.path.name} line {line}",
                reason=f"{text.count(chr(0))} NUL bytes in the line of names: what stood there, and rows, are lost",
            )
            text = text.replace("\0", "")
        try:
            packet = read_packet(lines, text, self.header, self.path, line)
        except FormatError as error:
            if not self.packets:
                raise
            self.lost = True
            yield Loss(f"{self.path.name} line {line}", reason=f"{error.what}: the rows below it are left out")
            return
        self.packets += 1
        yield packet

    def end(self) -> Iterator[Item]:
        if self.header is None:
            raise FormatError(
                "LVM file that ends inside its header",
                where=self.path.name,
                expected=MARK,
                hint="copy it anew from where it was recorded",
            )
        if not self.packets:
            raise FormatError(
                "LVM file without a heading of columns",
                where=self.path.name,
                expected="X_Value ...",
                hint="write it anew from LabVIEW with its column headings, or as TDMS",
            )
        if self.state != "rows":
            yield Loss(f"{self.path.name} end", reason="the file ends inside a heading")
