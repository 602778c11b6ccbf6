"""An LVM file from its first to its last byte: headers, headings, and the rows between, in parts of whole lines."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Loss
from thermodata_reader_crio.lvm_header import (
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
from thermodata_reader_crio.textparts import Part, decode, parts

_MOST_HEADER_LINES = 500
# what a heading's line starts with; NaN and Inf start a row
_KEY = re.compile(rb"(?!(?i:nan|inf|infinity)[\t,; ])(?:[A-Za-z_]|\*\*\*)")


@dataclass(frozen=True, slots=True)
class RowPart:
    """Lines of rows. line: number of the first; ended: False where the last has no line end; byte: where in a file
    of one byte a letter they begin, or a few bytes before."""

    line: int
    data: bytes
    ended: bool
    byte: int = 0


Item = Header | Packet | RowPart | Loss


def scan(path: Path, encoding: str, notes: list[str]) -> Iterator[Item]:
    """Header, then each packet and its rows; a Loss for a heading that can't be read. FormatError where there is
    no header, or no packet at all."""
    state = _Scan(path, encoding, notes)
    rest, line = b"", 1
    done = 0
    for part in parts(path, encoding):
        state.byte, done = done - len(rest), done + len(part.data)
        line = line if rest else part.line
        data = rest + part.data if rest else part.data
        yield from state.part(Part(line, data, part.ended) if rest else part)
        rest, line = state.rest, state.line
    if rest:
        state.byte = done - len(rest)
        yield from state.part(Part(line, rest, True), last=True)
    yield from state.end()


def has_heading_behind(path: Path, encoding: str, rows: RowPart) -> bool:
    """Whether a heading may follow the first rows of a packet: there is none without a star."""
    if encoding.lower().replace("_", "-").startswith("utf-16"):
        return True
    with path.open("rb") as file:
        file.seek(rows.byte)
        return any(b"*" in block for block in iter(lambda: file.read(1 << 20), b""))


class _Scan:
    def __init__(self, path: Path, encoding: str, notes: list[str]) -> None:
        self.path, self.encoding, self.notes = path, encoding, notes
        self.header: Header | None = None
        self.packets = 0
        self.lost = False
        self.lines: list[str] = []
        self.state = "heading"  # or: names, rows, special
        self.before_special = ""
        self.rest, self.line, self.byte = b"", 1, 0
        self.strays: list[int] = []  # lines in a heading that are none of its

    def part(self, part: Part, last: bool = False) -> Iterator[Item]:
        data, at, line = part.data, 0, part.line
        self.rest = b""
        while at < len(data):
            if self.state == "rows":
                end = self._rows_end(data, at, last or not part.ended)
                if end > at:
                    if not self.lost:
                        yield RowPart(line, data[at:end], part.ended or end < len(data), self.byte + at)
                    # at the end of the part the next one brings its own number
                    line += data.count(b"\n", at, end) if end < len(data) else 0
                    at = end
                if at < len(data) and self.state == "rows":
                    self.rest, self.line = data[at:], line
                    return
                continue
            end = data.find(b"\n", at) + 1 or len(data)
            text = decode(data[at:end], self.encoding).rstrip("\r\n")
            yield from self._heading_line(text, line)
            at, line = end, line + 1

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
        if text.startswith(START_SPECIAL) and self.state != "special":
            self.state, self.before_special = "special", self.state
        elif self.state == "special":
            if text.startswith(END_SPECIAL):
                self.state = self.before_special
        elif self.state == "names":
            if text.strip():
                yield from self._names(text, line)
        elif text.startswith(MARK):
            if self.strays:
                yield Loss(
                    f"{self.path.name} line {self.strays[0]}",
                    reason=f"{len(self.strays)} lines before a heading's end that belong to no heading",
                )
                self.strays = []
            if self.header is None or is_file_header(self.lines):
                own, heading = split_heading(self.lines)
                header = read_header(own, self.notes)
                if self.header is None or header != self.header:
                    yield header
                self.header, self.lines = header, []
                if heading:
                    self.notes.append(f"line {line}: no end of the file's header stands before the first heading")
                    self.lines, self.state = heading, "names"
            elif self.lines or not self.packets:
                self.state = "names"
            else:
                self.state = "rows"
                yield Loss(f"{self.path.name} line {line}", reason="the end of a header that is not there")
        elif "\0" in text or (text.strip(" \t,;") and self.packets and not _KEY.match(text.encode())):
            self.strays.append(line)
        elif text.strip(" \t,;"):
            self.lines.append(text)
            if len(self.lines) > _MOST_HEADER_LINES:
                raise FormatError(
                    "LVM header without an end",
                    where=f"{self.path.name} line {line}",
                    expected=MARK,
                    got=f"{_MOST_HEADER_LINES} lines without it",
                )

    def _names(self, text: str, line: int) -> Iterator[Item]:
        assert self.header is not None
        lines, self.lines, self.state, self.lost = self.lines, [], "rows", False
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
            raise FormatError("LVM file that ends inside its header", where=self.path.name, expected=MARK)
        if not self.packets:
            raise FormatError("LVM file without a heading of columns", where=self.path.name, expected="X_Value ...")
        if self.state != "rows":
            yield Loss(f"{self.path.name} end", reason="the file ends inside a heading")
