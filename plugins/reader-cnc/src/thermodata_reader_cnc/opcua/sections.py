"""Tables of other columns below each other in one file, as InfluxDB exports a query: each by its own header."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import chunks
from thermodata_reader_cnc.opcua.find_layout import find_layout
from thermodata_reader_cnc.opcua.long_layout import Layout, clean_line

_HEADS = (b",_time,", b'"_time"', b",_time\r", b",_time\n")  # one of which the header of each such table holds
_PART = 1 << 20
_FIRST_LINES, _EVERY = 2000, 50  # of a table, by which its series are known
_FEWEST = 2  # tables


@dataclass(frozen=True, slots=True)
class Section:
    """line: of its header, 0-based in the file; where several tables have one header, they have one layout."""

    line: int
    layout: Layout


@dataclass(frozen=True, slots=True)
class Sections:
    """all: in the order of the file, the first of them first; seen: some lines of each layout's tables, by its header.
    Empty where the file is one table."""

    all: tuple[Section, ...] = ()
    seen: Mapping[str, Sequence[str]] = field(default_factory=dict)

    def parts(self, data: bytes, line: int, first: Layout) -> Iterator[tuple[Layout, bytes, int]]:
        """Whole lines, each part with its layout and the number of its first line. line: of the first of all; first:
        the layout where the file is one table."""
        layout = next((s.layout for s in reversed(self.all) if s.line <= line), first)
        cuts = [s for s in self.all if line < s.line < line + data.count(b"\n")]
        if cuts:
            ends = np.flatnonzero(np.frombuffer(data, np.uint8) == ord("\n")) + 1
        at, number = 0, line
        for section in cuts:
            end = int(ends[section.line - line - 1])
            yield layout, data[at:end], number
            layout, at, number = section.layout, end, section.line
        if at < len(data):
            yield layout, data[at:], number


def find_sections(path: Path, encoding: str, first: Layout, declared: str | None) -> Sections:
    """The tables of an export of InfluxDB whose first one is known. declared: the format of the times. A table that
    does not read, or tells its times otherwise, ends the list."""
    if not first.annotated:
        return Sections()
    heads = _headers(path, encoding, first)
    if len({header for _, header in heads}) < _FEWEST:
        return Sections()
    seen = _lines_of(path, encoding, heads)
    layouts: dict[str, Layout] = {}
    for header in dict.fromkeys(header for _, header in heads):
        found = find_layout([header, *seen[header]], path.name, declared)
        if found is None or found.form != first.form or found.delimiter != first.delimiter:
            break
        layouts[header] = replace(found, row=first.row)
    if len(layouts) < _FEWEST:
        return Sections()
    layouts = _told_apart(layouts)
    known: list[Section] = []
    for line, header in heads:
        if header not in layouts:
            break
        known.append(Section(line, layouts[header]))
    return Sections(tuple(known), {h: seen[h] for h in layouts})


def _headers(path: Path, encoding: str, first: Layout) -> list[tuple[int, str]]:
    """(line, text) of the headers of all tables: those that repeat the one above them are left out."""
    found = [(first.row, first.header)]
    for chunk in chunks(path, encoding, _PART):
        if not any(mark in chunk.data for mark in _HEADS):
            continue
        for number, line in enumerate(chunk.data.split(b"\n"), chunk.line):
            if number <= first.row or b"_time" not in line:
                continue
            text = clean_line(line.decode("utf-8", "replace"))
            if {"_time", "_value"} <= {clean(c) for c in fields(text, first.delimiter)} and text != found[-1][1]:
                found.append((number, text))
    return found


def _lines_of(path: Path, encoding: str, heads: Sequence[tuple[int, str]]) -> dict[str, list[str]]:
    """Lines of the tables of each header: the first ones, and some of the others."""
    seen: dict[str, list[str]] = {header: [] for _, header in heads}
    at = -1
    for chunk in chunks(path, encoding, _PART):
        for number, line in enumerate(chunk.data.split(b"\n"), chunk.line):
            while at + 1 < len(heads) and heads[at + 1][0] <= number:
                at += 1
            if at < 0 or number == heads[at][0] or not line.strip() or line.startswith(b"#"):
                continue
            if number - heads[at][0] <= _FIRST_LINES or number % _EVERY == 0:
                seen[heads[at][1]].append(line.decode("utf-8", "replace").rstrip("\r"))
    return seen


def _told_apart(layouts: Mapping[str, Layout]) -> dict[str, Layout]:
    """The layouts; a name that two of them give is made longer, by all that tells the series."""
    names = Counter(name for layout in layouts.values() for name in set(layout.known.values()))
    return {
        header: replace(
            layout,
            known={key: "/".join(filter(None, key)) if names[name] > 1 else name for key, name in layout.known.items()},
        )
        for header, layout in layouts.items()
    }
