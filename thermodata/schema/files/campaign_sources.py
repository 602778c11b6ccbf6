"""`sources` of a campaign file: loggers, one clock each."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from thermodata.schema.strict.declared import Moment, Paths, Seconds, Strict
from thermodata.schema.words.zone_names import zone_of_offset


class TimeColumn(Strict):
    """`sources.*.table.time`: the column that holds the time. Found where it is not declared.

    column: counted from 1, or the header's text; a list joins date and time of day
    signals: where a table has several times: the columns that belong to this one; by default those behind it
    unit: of relative times: s, min, h; taken from the header where it stands there; unknown: nothing is read until it
        is written
    format: as strptime writes it, where day and month cannot be told apart; swapped or shown: of dates in a workbook
        that seem to have them exchanged; or unknown
    period: of rows without a time column: 60 s from row to row; or unknown
    start: of rows without a date, from the lines above them ('Start time: 04/07/2026 08:07'): dmy, mdy or ymd, where
        day and month cannot be told apart; head: they begin then, though no word says so; none: they do not; or unknown
    """

    column: int | str | list[int | str] | None = None
    signals: list[int | str] | None = None
    unit: str | None = None
    format: str | None = None
    # left out where it is not declared: raw data is kept by what its source declares
    period: Seconds | Literal["unknown"] | None = Field(default=None, exclude_if=lambda period: period is None)
    start: Literal["dmy", "mdy", "ymd", "head", "none", "unknown"] | None = Field(
        default=None, exclude_if=lambda start: start is None
    )

    @field_validator("period")
    @classmethod
    def _runs_on(cls, value: float | str | None) -> float | str | None:
        if isinstance(value, float) and value <= 0:
            raise ValueError("a period is longer than 0 s")
        return value

    @model_validator(mode="after")
    def _one_clock(self) -> TimeColumn:
        if self.period is not None and (self.column is not None or self.unit is not None or self.format is not None):
            raise ValueError("rows have a time column, or a period: not both")
        return self


class TableLayout(Strict):
    """`sources.*.table`: how a table lies on its page. What is not said is found in its first rows.

    sheet: of a workbook, or the group of a TDMS or MDF file: counted from 1, or its name; of a MAT file a variable;
        with {test} in it each test is a sheet; refused where the files have none
    header_rows: rows with names, above the data
    units_row: the row that holds the units, counted from 1
    skip_rows: rows above the header
    names: of all columns, the time among them, for files without a header: [time, T_bed, "dZ [um]"]; a file with a
        header has its own
    time: its time column, or a list where columns have times of their own
    delimiter: between cells: itself, or tab, semicolon, comma, blanks
    decimal: mark of decimals: '.' or ','; unknown: nothing is read until it is written
    series: columns whose words name the sensor or host that a row is of: [host, sensor]; none: all rows are of one
    quality_zero: what the code 0 of its quality columns says of their values: good or bad; told by other codes where
        the file has them; or unknown
    stands: columns whose empty cells say that the value before them still stands, as where a log writes what changed:
        [n, mode], all or none; told by the cells of a text where they prove it
    """

    sheet: int | str | None = None
    header_rows: int | None = None
    units_row: int | None = None
    skip_rows: int = 0
    time: TimeColumn | list[TimeColumn] | None = None
    delimiter: str | None = None
    decimal: Literal[".", ",", "unknown"] | None = None
    # left out where they are not declared: raw data is kept by what its source declares
    names: Annotated[list[str], Field(min_length=1)] | None = Field(
        default=None, exclude_if=lambda names: names is None
    )
    series: Literal["none"] | Annotated[list[str], Field(min_length=1)] | None = Field(
        default=None, exclude_if=lambda series: series is None
    )
    quality_zero: Literal["good", "bad", "unknown"] | None = Field(
        default=None, exclude_if=lambda quality_zero: quality_zero is None
    )
    stands: Literal["all", "none"] | Annotated[list[str], Field(min_length=1)] | None = Field(
        default=None, exclude_if=lambda stands: stands is None
    )


class AlignBy(Strict):
    """`sources.*.clock.by[]`: one quantity that two sources logged, by their channels.

    here: the channel of this source
    there: the channel of the source it is aligned to
    """

    here: str
    there: str


class ClockEvent(Strict):
    """`sources.*.clock.events[]`: one event as two sources saw it.

    here: in this source: local date and time, or time since its first sample (12.5 min)
    there: the same event in the source it is aligned to
    """

    here: Moment
    there: Moment


class Clock(Strict):
    """`sources.*.clock`: how this source's clock relates to the others'. Refused where the evidence is thin.

    offset: added to the source's times [s], with a unit: -3.2 s of a clock that runs 3.2 s ahead of the others
    drift_ppm: how much faster the clock runs [1e-6]
    align_to: the source whose clock is right; offset and drift are estimated
    by: quantities that both logged
    events: events that a person saw in both
    resets: after a long step back, refuse: what follows is lost, and said; allow: the clock was set, and is joined
    """

    offset: Seconds | None = None
    drift_ppm: float | None = None
    align_to: str | None = None
    by: list[AlignBy] = []
    events: list[ClockEvent] = []
    resets: Literal["refuse", "allow"] = "refuse"


class SourceSpec(Strict):
    """`sources.*`: files of one logger, with one clock. A file that its reader does not claim is a loss, not an
    end.

    reader: name of an installed reader: crio, cnc, mcap, table or another
    files: path below this file, a pattern with {test}, or a list
    timezone: IANA name of the zone of local times: Europe/Prague; of a clock on winter time all year its offset,
        "+01:00" or UTC+1, which is kept by its IANA name, Etc/GMT-1
    encoding: of text; by default UTF-8, then what its words tell (cp932, euc-jp, gb18030, big5, cp949),
        cp1250 or cp1252, with a note
    table: layout of a table
    topics: of a recording: those to read; by default all
    clock: offset, or what to align it by
    options: further keys for one reader, such as time: header.stamp for mcap
    """

    reader: str
    files: Paths | None = None
    timezone: str | None = None
    encoding: str | None = None
    table: TableLayout | None = None
    topics: list[str] = []
    clock: Clock = Clock()
    options: dict[str, Any] = {}

    @field_validator("timezone")
    @classmethod
    def _by_its_name(cls, value: str | None) -> str | None:
        return None if value is None else zone_of_offset(value)

    @property
    def sheet_a_test(self) -> bool:
        """Whether each test is a sheet of one workbook."""
        return self.table is not None and "{test}" in str(self.table.sheet)

    def with_clock(self, offset_s: float | None) -> SourceSpec:
        """The source as a test has it in which its clock was off by itself; None: in which it was as ever."""
        if offset_s is None:
            return self
        clock = self.clock.model_copy(update={"offset": offset_s, "align_to": None, "by": [], "events": []})
        return self.model_copy(update={"clock": clock})

    def of_test(self, test: str) -> SourceSpec:
        """The source as one test has it: the sheet with the test's name."""
        if self.table is None or not self.sheet_a_test:
            return self
        sheet = str(self.table.sheet).replace("{test}", test)
        return self.model_copy(update={"table": self.table.model_copy(update={"sheet": sheet})})
