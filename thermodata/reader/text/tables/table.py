"""A table in delimited text, as the first look at the file finds it: where things stand and what its columns hold.

How it is found: find_table.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from thermodata.reader.signals.row_units import UnitColumn
from thermodata.reader.signals.series import Series
from thermodata.reader.text.cells.cell import is_number
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.lines.schedules import Schedules
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.lines import Sample, last_line_is_whole
from thermodata.reader.text.names.header import told_alike
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.page.timed.group import Group
from thermodata.reader.text.preamble.begin import Begin
from thermodata.reader.text.preamble.scales_said import SCALES_BELOW, is_row_of_scales
from thermodata.reader.text.rows.fixed_columns import FixedColumns
from thermodata.reader.text.rows.grid import Grid
from thermodata.reader.text.rows.qualities import Qualities
from thermodata.reader.text.times.several_cells.date_parts import PART
from thermodata.reader.times.time_units import SECONDS

Told = tuple[tuple[str, str], ...]  # name and unit of each cell of a header


@dataclass(frozen=True, slots=True)
class TimedGroup:
    """Columns with one time, and how that is written. formats: one a time column, none for numbers; stated: the zone
    that their headers, or a line above the rows, say, None where they say none; once: the date stands in some rows
    only, for those behind it; above: that line; later_ns: by how much times of day begin after the earliest group's;
    begin: what they count from, of a block that says so beside others."""

    stream: str
    group: Group
    formats: tuple[TimeFormat, ...]
    stated: str | None = None
    once: bool = False
    above: str = ""
    later_ns: int = 0
    begin: Begin | None = None

    @property
    def of_day(self) -> bool:
        """Whether its times are times of day without a date."""
        return bool(self.formats) and self.formats[0].role == "time"

    @property
    def absolute(self) -> bool:
        return self.group.epoch is not None or (bool(self.formats) and not self.of_day)

    @property
    def zoned(self) -> bool:
        """Whether its times say where they stand from UTC."""
        return any(form.zoned for form in self.formats)

    def said(self) -> str:
        """How its times are written, for messages."""
        if self.group.counted:
            return f"counted, {self.group.seconds:g} s from row to row"
        if self.formats:
            return " and ".join(form.text for form in self.formats if form.role != PART.role)
        unit = next((u for u, seconds in SECONDS.items() if seconds == self.group.seconds), "")
        return f"as a number [{self.group.epoch or unit}]"


def bare_line(line: str) -> str:
    """A line without blanks around it, and without the byte order mark that it has where files were joined."""
    return line.strip().strip("\ufeff").strip()


def header_lines(head: Sequence[str], first: int, cells: Callable[[str], Sequence[str]]) -> frozenset[str]:
    """The lines above the data, and rows of scales below the names, by `bare_line`. first: the first row; cells: of a
    line."""
    below = (x for x in head[first : first + SCALES_BELOW] if is_row_of_scales([clean(c) for c in cells(x)]))
    return frozenset(bare for line in (*head[:first], *below) if (bare := bare_line(line)))


@dataclass(frozen=True)
class Table:
    """What the first look at a file found. header: the lines above the data, by `bare_line`; kinds: the dtype of each
    column, None of one without values; qualities: what columns say of others; blanks: whether any number of them parts
    its cells: lines are looked at, and read, with tabs in their place; columns: where these stand, if at fixed places,
    so that a cell may be blank; schedules: of a dataTaker, whose lines are read with a time before each; named: names
    that stand before each value of a line, which become columns so; stamped: what parts the cells of lines behind the
    clock of a terminal, '' of others; begin: what its times count from, where its head says so; zone: what a line above
    the rows says of it, and that line; series: how rows of several sensors or hosts are taken apart; unit: the column
    that holds the one of its numbers; paired: those that each hold the one of another column, as their names say;
    units_told: the note on a column of units, of rows that are of no series; stands: columns whose empty cells say that
    the value before them still stands."""

    name: str
    sample: Sample
    delimiter: str
    quoted: bool
    layout: Layout
    groups: tuple[TimedGroup, ...]
    kinds: tuple[str | None, ...]
    decimal: str | None
    decimal_declared: bool
    header: frozenset[str]
    qualities: Qualities
    notes: tuple[str, ...]
    blanks: bool = False
    columns: FixedColumns | None = None
    schedules: Schedules | None = None
    named: tuple[str, ...] = ()
    stamped: str = ""
    begin: Begin | None = None
    zone: tuple[str, str] | None = None
    series: Series | None = None
    unit: UnitColumn | None = None
    paired: tuple[UnitColumn, ...] = ()
    units_told: str | None = None
    stands: frozenset[int] = frozenset()

    @property
    def absolute(self) -> bool:
        return self.begin is not None or self.groups[0].absolute

    @property
    def cut(self) -> bool:
        """Whether the last line has no end, and does not prove itself whole."""
        first = self.sample
        lines = first.head if first.whole else first.rest
        if first.ends_with_newline or len(lines) < 2:
            return False
        return not last_line_is_whole(lines[-1], lines[-2], self.delimiter)

    def repeats_header(self, line: str) -> bool:
        """Whether a line stands above the data too, if with another spelling of a unit: files that were joined repeat
        their headers."""
        bare = bare_line(line)
        return bare in self.header or (bool(told := self._names_and_units(bare)) and told in self._header_told)

    @cached_property
    def _header_told(self) -> frozenset[Told]:
        """The lines of the header in one spelling of their units."""
        return frozenset(told for line in self.header if (told := self._names_and_units(line)))

    def _names_and_units(self, line: str) -> Told:
        """() of a line that holds a number, or one cell."""
        cells = [clean(c) for c in fields(line, self.delimiter, self.quoted)]
        return told_alike(cells) if len(cells) > 1 and not any(map(is_number, cells)) else ()

    def grid(self, decimal: str) -> Grid:
        """How its rows lie. A row may end with the columns of a group, for groups have lengths of their own; one with a
        delimiter too much is none, for that may have shifted its cells."""
        edges = [min((*g.group.time, *g.group.columns)) for g in self.groups[1:]]
        least = min(edges) if edges else None
        return Grid(
            self.delimiter,
            decimal,
            self.kinds,
            quoted=self.quoted,
            least=least,
            exact=True,
            blank_rows=any(g.group.counted for g in self.groups),
            decimal_declared=self.decimal_declared,
        )
