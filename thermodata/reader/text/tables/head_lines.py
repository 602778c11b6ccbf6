"""The first lines of a text, in which the layout of its table shows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from thermodata.errors import FormatError
from thermodata.reader.text.cells.lines import delimiter as delimiters
from thermodata.reader.text.cells.lines.named_values import in_columns, named_values
from thermodata.reader.text.cells.lines.schedules import Schedules, schedules_of
from thermodata.reader.text.cells.lines.stamped_lines import stamped_by, with_stamp
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import Sample
from thermodata.reader.text.rows.fixed_columns import FixedColumns, fixed_columns
from thermodata.reader.text.rows.fixed_width import by_width, fixed_width

_HEAD_LINES = 500  # in which the layout shows
_HEADER_LINES, _CELL_LINES = 60, 16  # in which cells over several lines are headers, and of how many lines


def records(lines: Sequence[str]) -> list[str]:
    """The lines, those of a header whose cells go over several joined: at the last of them, the others blank, so that
    lines keep their numbers."""
    joined: list[str] = []
    at = 0
    while at < len(lines):
        end = at
        if at < _HEADER_LINES and lines[at].count('"') % 2:
            more = range(at + 1, min(len(lines), at + _CELL_LINES))
            end = next((k for k in more if lines[k].count('"') % 2), at)
        joined += [*[""] * (end - at), " ".join(lines[at : end + 1])]
        at = end + 1
    return joined


def top_of(head: Sequence[str]) -> Sequence[str]:
    """The lines up to the 500th that is not empty."""
    full = [k for k, line in enumerate(head) if line and not line.isspace()][:_HEAD_LINES]
    return head[: full[-1] + 1] if full else head


@dataclass(frozen=True, slots=True)
class HeadLines:
    """The first lines, and what parts their cells. top: those in which the layout shows; sample: all that was
    sampled of the file. blanks: whether runs of blanks part cells: there are tabs in their place. quoted: whether cells
    may stand in quotes. named: the names that stand before each value, which are in columns here. stamped: what parts
    cells of lines before which a terminal wrote its clock, which is the first cell here; '' where none did. columns:
    where cells stand that blanks part, if these are fixed places. schedules: of a dataTaker, each with its own time
    here, and with rows at the end of the top where it begins far below."""

    head: Sequence[str]
    top: Sequence[str]
    sample: Sample
    delimiter: str
    blanks: bool
    quoted: bool
    named: tuple[str, ...] = ()
    stamped: str = ""
    columns: FixedColumns | None = None
    schedules: Schedules | None = None

    def cells(self, line: str) -> list[str]:
        """The cells of a line, without blanks and quotes around them."""
        found = delimiters.fields(line, self.delimiter, self.quoted)
        if line.isascii():  # as `clean` begins, which nearly all cells are left alone by
            return [c if c and c[0] > '"' < c[-1] else clean(c) for c in found]
        return [clean(c) for c in found]

    def rows(self) -> list[list[str]]:
        """The cells of the top, a header of several lines in the last of them. A line that names the delimiter of a
        worksheet is empty."""
        rows = [self.cells(line) for line in (records(self.top) if self.quoted else self.top)]
        if self.head[0].lower().startswith("sep=") and len(rows[0]) <= 2:
            rows[0] = [""]
        return rows

    def below(self, first: int) -> Iterator[list[str]]:
        """The cells of all sampled lines from one on."""
        return map(self.cells, (*self.head[first:], *self.sample.rest))

    def up_to(self, end: int) -> HeadLines:
        """The lines before one, and nothing of what was sampled behind it."""
        return replace(self, head=self.head[:end], top=self.top[:end], sample=replace(self.sample, rest=()))


def head_lines(
    head: Sequence[str], first: Sample, said: Mapping[str, Any], where: str, *, cut_names: bool = False
) -> HeadLines:
    """The first lines with what parts their cells, declared or found. first: all that was sampled of the file; said:
    what is declared of the table; cut_names: where cells stand at fixed places, names that hold blanks are known by
    these. FormatError where nothing parts cells."""
    top = top_of(head)
    if not said.get("delimiter") and (named := named_values((*top, *first.rest))):
        each = partial(in_columns, names=named)
        first = replace(first, head=tuple(map(each, first.head)), rest=tuple(map(each, first.rest)))
        head = list(map(each, head))
        return HeadLines(head, top_of(head), first, "\t", False, False, named)
    if not said.get("delimiter") and (schedules := schedules_of((*head, *first.rest))) is not None:
        first = replace(
            first, head=tuple(map(schedules.parted, first.head)), rest=tuple(map(schedules.parted, first.rest))
        )
        head = list(map(schedules.parted, head))
        top = schedules.with_each(top_of(head), (*head[len(top_of(head)) :], *first.rest))
        return HeadLines(head, top, first, ",", False, True, schedules=schedules)
    stamped = "" if said.get("delimiter") else stamped_by((*top, *first.rest))
    if stamped:
        with_time = partial(with_stamp, delimiter=stamped)
        first = replace(first, head=tuple(map(with_time, first.head)), rest=tuple(map(with_time, first.rest)))
        head = list(map(with_time, head))
        quoted = any('"' in line for line in (*head, *first.rest))
        return HeadLines(head, top_of(head), first, stamped, False, quoted, stamped=stamped)
    delimiter = delimiters.declared(said["delimiter"]) if said.get("delimiter") else None
    delimiter = delimiter or delimiters.find_delimiter(top)
    columns = fixed_columns((*top, *first.rest)) if delimiter == delimiters.BLANKS else None
    if delimiter is None:
        raise FormatError(
            "no columns found",
            where=where,
            expected="lines with as many cells between ';', tabs, commas, '|' or blanks",
            got=repr(head[0][:60]),
            hint=by_width(where) if fixed_width(head) else "declare table: {delimiter: ...}",
        )
    blanks = delimiter == delimiters.BLANKS
    if blanks:
        columns = columns.with_heads() if columns is not None and cut_names else columns
        parted = delimiters.parted if columns is None else columns.parted
        delimiter, head = "\t", list(map(parted, head))
        first = replace(first, head=tuple(map(parted, first.head)), rest=tuple(map(parted, first.rest)))
        top = top_of(head)
    quoted = any('"' in line for line in (*head, *first.rest))
    return HeadLines(head, top, first, delimiter, blanks, quoted, columns=columns)
