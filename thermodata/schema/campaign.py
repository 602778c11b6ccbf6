"""The campaign file: what was measured, where, by what, and how it is calibrated. Contract `campaign/1`."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from thermodata.errors import ThermodataError
from thermodata.schema.quantity import QUANTITIES, Quantity, value_in

NAME = re.compile(r"^[A-Za-z][A-Za-z0-9_]*$")
RESERVED_NAMES = frozenset({"campaign", "test", "source", "t", "t_s"})
TestKind = Literal["spindle", "spectrum", "linear_axis", "rotary_axis", "etve", "cutting", "mixed", "other"]
Role = Literal["calibration", "verification", "locked", "none"]
Value = str | float | int
Direction = Literal["+X", "-X", "+Y", "-Y", "+Z", "-Z", "+A", "-A", "+B", "-B", "+C", "-C"]


STORED = {"stored": True}  # validation context of what model_dump_json wrote: plain numbers in canonical units


def _in(unit: str) -> BeforeValidator:
    def convert(text: Any, info: ValidationInfo) -> float:
        if info.context == STORED and isinstance(text, int | float):
            return float(text)
        try:
            return value_in(text, unit)
        except ThermodataError as error:
            raise ValueError("; ".join(str(error).splitlines())) from None

    return BeforeValidator(convert, json_schema_input_type=str | float)


def _in_nanoseconds(seconds: float) -> float:
    """A time that clocks can count: of at most 292 years."""
    if not abs(seconds) < 2**63 / 1e9:
        raise ValueError("a time of centuries: clocks count 292 years at most")
    return seconds


Seconds = Annotated[float, _in("s"), AfterValidator(_in_nanoseconds)]
Um = Annotated[float, _in("um")]
# YAML makes a date of what looks like one
Moment = Annotated[Value, BeforeValidator(lambda x: x.isoformat(" ") if isinstance(x, datetime) else x)]


def _moment(value: Any) -> Any:
    """A date with a time of day, as text; YAML makes a datetime of some."""
    if value is None or isinstance(value, datetime):
        return None if value is None else value.isoformat(" ")
    try:
        datetime.fromisoformat(str(value))
    except ValueError:
        raise ValueError(f"'{value}' is no date and time such as 2026-03-02 08:00") from None
    if not re.search(r"\d[ T]\d", str(value)):
        raise ValueError(f"'{value}' has no time of day; expected one such as 2026-03-02 08:00")
    return str(value)


class Strict(BaseModel):
    """Base of all that users write. Unknown keys are refused; the loader names the nearest right one."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, coerce_numbers_to_str=True)


class Axis(Strict):
    """`machine.axes.X`: a linear or rotary axis. Free attributes (`preload: 2.1 kN`) are conditions too.

    feedback: what closes the position loop; behind a scale the growth of the screw does not reach the tool
    """

    model_config = ConfigDict(extra="allow", frozen=True)
    feedback: Literal["scale", "screw", "motor"] | None = None


class Machine(Strict):
    """`machine`: the machine that was tested. Free attributes are conditions too: gains can depend on them.

    id: its number or name in the lab
    description: free text
    axes: its axes by letter
    """

    model_config = ConfigDict(extra="allow", frozen=True)
    id: str
    description: str = ""
    axes: dict[str, Axis] = {}


class TimeColumn(Strict):
    """`sources.*.table.time`: the column that holds the time. Found where it is not declared.

    column: counted from 1, or the header's text; a list joins date and time of day
    signals: where a table has several times: the columns that belong to this one; by default those behind it
    unit: of relative times: s, min, h; taken from the header where it stands there; unknown: nothing is read until it
        is written
    format: as strptime writes it, where day and month cannot be told apart; or unknown
    period: of rows without a time column: 60 s from row to row; or unknown
    """

    column: int | str | list[int | str] | None = None
    signals: list[int | str] | None = None
    unit: str | None = None
    format: str | None = None
    # left out where it is not declared: raw data is kept by what its source declares
    period: Seconds | Literal["unknown"] | None = Field(default=None, exclude_if=lambda period: period is None)

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

    sheet: of a workbook: counted from 1, or its name; with {test} in it each test is a sheet
    header_rows: rows with names, above the data
    units_row: the row that holds the units, counted from 1
    skip_rows: rows above the header
    time: its time column, or a list where columns have times of their own
    delimiter: between cells: itself, or tab, semicolon, comma, blanks
    decimal: mark of decimals: '.' or ','; unknown: nothing is read until it is written
    """

    sheet: int | str | None = None
    header_rows: int | None = None
    units_row: int | None = None
    skip_rows: int = 0
    time: TimeColumn | list[TimeColumn] | None = None
    delimiter: str | None = None
    decimal: Literal[".", ",", "unknown"] | None = None


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

    offset: added to the source's times [s], with a unit: -3.2 s
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
    timezone: IANA name of the zone of local times: Europe/Prague
    encoding: of text; by default UTF-8, then cp1250 or cp1252 with a note
    table: layout of a table
    topics: of a recording: those to read; by default all
    clock: offset, or what to align it by
    options: further keys for one reader, such as time: header.stamp for mcap
    """

    reader: str
    files: str | list[str] | None = None
    timezone: str | None = None
    encoding: str | None = None
    table: TableLayout | None = None
    topics: list[str] = []
    clock: Clock = Clock()
    options: dict[str, Any] = {}

    @property
    def sheet_a_test(self) -> bool:
        """Whether each test is a sheet of one workbook."""
        return self.table is not None and "{test}" in str(self.table.sheet)

    def of_test(self, test: str) -> SourceSpec:
        """The source as one test has it: the sheet with the test's name."""
        if self.table is None or not self.sheet_a_test:
            return self
        sheet = str(self.table.sheet).replace("{test}", test)
        return self.model_copy(update={"table": self.table.model_copy(update={"sheet": sheet})})


class Sensor(Strict):
    """`channels.*.sensor`: the sensor behind a channel. Free attributes are kept.

    serial: its number
    range: lowest and highest reading, in the unit of the raw signal or with units; outside of it a sample is
        flagged
    resolution: its smallest step; shows as ripple in a prediction
    """

    model_config = ConfigDict(extra="allow", frozen=True)
    serial: str | None = None
    range: tuple[Value, Value] | None = None
    resolution: Value | None = None


class Channel(Strict):
    """`channels.*`: one measured quantity: where it comes from, and what it is. Exactly one of signal (with
    source), derive and schedule.

    source: key of `sources`
    signal: its name in the file; a unit in brackets behind the name may be left out
    derive: an expression over other channels: (dY_high - dY_low) / 100 mm
    schedule: [[time, value], ...] for what nobody logged but everybody knows; held between
    quantity: what it is; its canonical unit follows
    unit: of the raw values, where the file does not say it
    instead_of: the unit that the file states, where that is wrong and `unit` is right
    axis: of a displacement: the machine's axis
    at: dotted place on the machine: spindle.bearing.front
    relative_to: place that a displacement is measured against
    calibration: key of `calibrations`, or a list applied in order
    sensor: what measured it
    notes: free text
    """

    source: str | None = None
    signal: str | None = None
    derive: str | None = None
    schedule: list[tuple[Value, Value]] | None = None
    quantity: Quantity
    unit: str | None = None
    instead_of: str | None = None
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: str | None = None
    relative_to: str | None = None
    calibration: str | list[str] | None = None
    sensor: Sensor | None = None
    notes: str = ""

    @model_validator(mode="after")
    def _one_origin(self) -> Channel:
        origins = [k for k in ("signal", "derive", "schedule") if getattr(self, k) is not None]
        if len(origins) != 1:
            raise ValueError(f"a channel has exactly one of 'signal', 'derive' and 'schedule'; got {origins or 'none'}")
        if self.signal is not None and self.source is None:
            raise ValueError("a channel with 'signal' needs 'source'")
        if self.instead_of is not None and self.unit is None:
            raise ValueError("'instead_of' names the file's unit that 'unit' replaces: write both")
        return self


class JumpCalibration(Strict):
    """`calibrations.*` of kind jump: the axis moves a probe by known steps, which gives a signed sensitivity.
    Refused where `facing` contradicts its sign.

    kind: jump
    axis: the axis that moved
    source: key of `sources`
    file: path of the log of the jump test, below this file
    signal: the probe's name in it
    moves: commanded moves [um], in machine coordinates and with units: [100 um, -100 um]; unknown: nothing is
        calibrated until they are written
    dwell: time at each position [s]
    move_uncertainty: of one commanded move [um]; goes into the sensitivity's uncertainty
    facing: the way the probe looks, for a check of the sign
    increases_with: what makes the reading grow: gap (eddy current) or approach (many contact probes)
    gain: of the data sheet, for a check: 250 um/V
    """

    kind: Literal["jump"]
    axis: Literal["X", "Y", "Z", "A", "B", "C"]
    source: str
    file: str
    signal: str
    moves: list[Um] | Literal["unknown"]
    dwell: Seconds = 10.0
    move_uncertainty: Um = 1.0
    facing: Direction | None = None
    increases_with: Literal["gap", "approach"] | None = None
    gain: Value | None = None


class ScaleCalibration(Strict):
    """`calibrations.*` of kind scale: a data sheet's gain and the way the probe looks, where there is no jump
    test.

    kind: scale
    axis: the axis that it measures
    gain: with a unit: 250 um/V
    offset: added after the gain, in the unit of the result
    facing: the way the probe looks; gives the sign
    increases_with: what makes the reading grow: gap or approach
    uncertainty: of the gain: 2 %
    """

    kind: Literal["scale"]
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    gain: Value
    offset: Value = 0
    facing: Direction | None = None
    increases_with: Literal["gap", "approach"] = "gap"
    uncertainty: Value | None = None


class LinearCalibration(Strict):
    """`calibrations.*` of kind linear: value = gain * raw + offset, with units.

    kind: linear
    gain: factor, with a unit where it changes the unit
    offset: added after the gain: -0.12 K
    """

    kind: Literal["linear"]
    gain: Value = 1
    offset: Value = 0


Calibration = Annotated[JumpCalibration | ScaleCalibration | LinearCalibration, Field(discriminator="kind")]


class Tool(Strict):
    """`tests[].tool`: what was in the spindle. Free attributes are conditions too.

    id: its name or number
    length: with a unit
    diameter: with a unit
    material: of the tool
    """

    model_config = ConfigDict(extra="allow", frozen=True)
    id: str | None = None
    length: Value | None = None
    diameter: Value | None = None
    material: str | None = None


class Measuring(Strict):
    """`tests[].measuring`, long form: when the displacement counts. Masked first, then averaged.

    when: comparisons with and, or, not, abs over channels: feed_Z == 0 and abs(pos_Z - 210) < 0.05
    in_range: a channel within its sensor's range, or {channel: [low, high]}
    settle: left out at the beginning of each stretch [s]
    for: shortest stretch that counts [s]
    """

    when: str | None = None
    in_range: str | dict[str, tuple[Value, Value]] | None = None
    settle: Seconds = 0.0
    for_: Annotated[float, _in("s")] | None = Field(default=None, alias="for")


class Zero(Strict):
    """`tests[].zero`: where displacements are zero: the mean of the first valid samples, never a fit.

    over: how long those samples last [s]
    """

    over: Seconds = 600.0


class ChannelOverride(Strict):
    """`tests[].channels.*`: a channel as it was in one test only (a sensor moved, another signal).

    source: key of `sources`
    signal: its name in the file
    unit: of the raw values
    instead_of: the unit that the file states, where that is wrong
    axis: of a displacement
    at: dotted place
    relative_to: place it is measured against
    calibration: key of `calibrations`, or a list
    sensor: what measured it
    schedule: [[time, value], ...]
    absent: true: this test has no such channel
    """

    source: str | None = None
    signal: str | None = None
    unit: str | None = None
    instead_of: str | None = None
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: str | None = None
    relative_to: str | None = None
    calibration: str | list[str] | None = None
    sensor: Sensor | None = None
    schedule: list[tuple[Value, Value]] | None = None
    absent: bool = False


class Test(Strict):
    """`tests[]`: one test. Times count from the start of the recording, with units.

    id: short name, unique in the campaign, without / \\ { } * ? [ ]
    kind: what was done
    role: calibration: fitted; verification: scored, and part of the choice; locked: opened to confirm a claim only,
        every look counted; none: kept
    conditions: any, with units or as text: speed: 9000 rpm
    pose: positions of the axes, with units
    tool: what was in the spindle
    machine: attributes of `machine` that differ in this test
    channels: channels that differ in this test
    files: files of a source, where its pattern does not give them
    start: date and time at which a recording without dates began, local to its source's timezone: 2026-03-02 08:00
    window: [from, to]: the test is this part of a longer recording
    history: recording: lags run from the recording's start; test: from the window's
    phases: named stretches: idle: [0 h, 26 h]
    measuring: an expression, in_range, or the long form
    zero: where displacements are zero
    start_state: balance: the machine was at rest; warm: it was not
    repeat_of: id of the test that this one repeats
    notes: free text
    """

    __test__ = False
    id: str
    kind: TestKind = "other"
    role: Role = "none"
    conditions: dict[str, Value | bool] = {}
    pose: dict[str, Value] = {}
    tool: Tool | None = None
    machine: dict[str, Any] = {}
    channels: dict[str, ChannelOverride] = {}
    files: dict[str, str | list[str]] = {}
    start: Annotated[str | None, BeforeValidator(_moment)] = Field(default=None, exclude_if=lambda start: start is None)
    window: tuple[Seconds, Seconds] | None = None
    history: Literal["test", "recording"] = "test"
    phases: dict[str, tuple[Seconds, Seconds]] = {}
    measuring: str | Measuring | None = None
    zero: Zero = Zero()
    start_state: Literal["balance", "warm"] = "balance"
    repeat_of: str | None = None
    notes: str = ""

    @field_validator("id")
    @classmethod
    def _safe_id(cls, value: str) -> str:
        if not value or value in (".", "..") or re.search(r"[\x00-\x1f/\\{}*?\[\]]", value) or len(value) > 120:
            raise ValueError("a test id is a short name without / \\ { } * ? [ ]")
        return value


class TestsTable(Strict):
    """`tests_from.table`: conditions that stand in a table beside the files.

    file: CSV or XLSX below this file
    key: the column that holds the field of the same name
    columns: condition -> column of the table
    sheet: of a workbook: counted from 1, or its name
    """

    __test__ = False
    file: str
    key: str
    columns: dict[str, str] = {}
    sheet: int | str | None = None


class TestsFrom(Strict):
    """`tests_from`: many tests whose conditions stand in file names, or in a table beside them.

    files: pattern with fields: raw/S{speed}_F{feed}_{nr}.csv
    source: key of `sources`; by default the only one
    id: of each test, from the fields; by default the file's name without its ending
    table: a table with more conditions
    units: of fields: speed: rpm
    disagree: what counts where name and table differ
    set: keys that all these tests share: {kind: spindle, role: calibration}
    """

    __test__ = False
    files: str
    source: str | None = None
    id: str | None = None
    table: TestsTable | None = None
    units: dict[str, str] = {}
    disagree: Literal["error", "table", "name"] = "error"
    set: dict[str, Any] = {}


class Overrule(Strict):
    """`overrule[]`: a flag that is wrong, and why. The samples count again; the event stays, with the reason.

    flag: its name, as `thermodata quality` shows it
    channel: key of `channels`; by default every one that has the flag
    because: why the reading is sound; kept and shown wherever the flag was
    tests: ids of the tests in which it is wrong; by default all
    window: [from, to] in the test, as `thermodata quality --events` shows it; by default throughout
    """

    flag: Literal["held", "stuck", "saturated", "spike", "out_of_range", "offset", "foreign"]
    channel: str | None = None
    because: str
    tests: list[str] = []
    window: tuple[Seconds, Seconds] | None = None

    @field_validator("because")
    @classmethod
    def _a_reason(cls, value: str) -> str:
        if not value.strip():
            raise ValueError("say why the reading is sound: the reason stands beside the flag from then on")
        return " ".join(value.split())


class Campaign(Strict):
    """A campaign file: what was measured, where, by what, and how it is calibrated. `tests_from` is expanded by
    the loader into `tests`.

    schema: thermodata/campaign/1
    id: name of the campaign in the store
    machine: the machine that was tested
    sources: loggers, one clock each
    channels: canonical name -> where it comes from and what it is
    calibrations: how raw values become calibrated ones
    tests: the tests
    tests_from: many tests, from file names or a table
    versions: file -> SHA-256 (6 digits or more) of an earlier version of it that counts
    overrule: flags that are wrong, each with its reason
    notes: free text
    """

    schema_: Literal["thermodata/campaign/1"] = Field(alias="schema")
    id: str
    machine: Machine = Machine(id="unknown")
    sources: dict[str, SourceSpec] = {}
    channels: dict[str, Channel] = {}
    calibrations: dict[str, Calibration] = {}
    tests: list[Test] = []
    tests_from: TestsFrom | list[TestsFrom] | None = None
    versions: dict[str, str] = {}
    overrule: list[Overrule] = Field(default=[], exclude_if=lambda rules: not rules)
    notes: str = ""

    @field_validator("id")
    @classmethod
    def _safe_id(cls, value: str) -> str:
        if not re.match(r"^[A-Za-z0-9][A-Za-z0-9._-]{0,119}$", value):
            raise ValueError("a campaign id is letters, digits, '.', '_' and '-', at most 120 of them")
        return value

    @field_validator("versions")
    @classmethod
    def _hashes(cls, value: dict[str, str]) -> dict[str, str]:
        for file, version in value.items():
            if not re.fullmatch("[0-9a-fA-F]{6,64}", version):
                raise ValueError(f"the version of '{file}' is 6 or more digits of its SHA-256, in quotes")
        return value

    @field_validator("channels")
    @classmethod
    def _names(cls, value: dict[str, Channel]) -> dict[str, Channel]:
        seen: dict[str, str] = {}
        for name in value:
            if not NAME.match(name) or "__" in name or name.lower() in RESERVED_NAMES:
                raise ValueError(
                    f"channel name '{name}': letters, digits and single '_', starting with a letter, "
                    f"and none of {', '.join(sorted(RESERVED_NAMES))}"
                )
            if name.lower() in seen:
                raise ValueError(f"channels '{seen[name.lower()]}' and '{name}' differ only in case")
            seen[name.lower()] = name
        return value


__all__ = [
    "QUANTITIES",
    "AlignBy",
    "Axis",
    "Calibration",
    "Campaign",
    "Channel",
    "ChannelOverride",
    "Clock",
    "ClockEvent",
    "Direction",
    "JumpCalibration",
    "LinearCalibration",
    "Machine",
    "Measuring",
    "Overrule",
    "Role",
    "ScaleCalibration",
    "Sensor",
    "SourceSpec",
    "TableLayout",
    "Test",
    "TestKind",
    "TestsFrom",
    "TestsTable",
    "TimeColumn",
    "Tool",
    "Zero",
]
