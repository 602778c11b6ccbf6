"""The campaign file: what was measured, where, by what, and how it is calibrated. Contract `campaign/1`."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationInfo, field_validator, model_validator

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


Seconds = Annotated[float, _in("s")]
Um = Annotated[float, _in("um")]
# YAML makes a date of what looks like one
Moment = Annotated[Value, BeforeValidator(lambda x: x.isoformat(" ") if isinstance(x, datetime) else x)]


class Strict(BaseModel):
    """Unknown keys are refused; the loader names the nearest right one."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, coerce_numbers_to_str=True)


class Axis(Strict):
    model_config = ConfigDict(extra="allow", frozen=True)
    feedback: Literal["scale", "screw", "motor"] | None = None


class Machine(Strict):
    """Free attributes are conditions too."""

    model_config = ConfigDict(extra="allow", frozen=True)
    id: str
    description: str = ""
    axes: dict[str, Axis] = {}


class TimeColumn(Strict):
    column: int | str | list[int | str] | None = None  # 1-based, or the header's text; a list joins date and time
    signals: list[int | str] | None = None  # of several times: its columns; None: those behind it
    unit: str | None = None  # relative times: s, min, h; None: found
    format: str | None = None  # strptime, where the text is ambiguous


class TableLayout(Strict):
    sheet: int | str | None = None  # 1-based, or its name
    header_rows: int | None = None
    units_row: int | None = None  # 1-based row that holds the units
    skip_rows: int = 0
    time: TimeColumn | list[TimeColumn] | None = None  # a list where columns have times of their own
    delimiter: str | None = None
    decimal: Literal[".", ","] | None = None


class AlignBy(Strict):
    here: str
    there: str


class ClockEvent(Strict):
    """One event as two sources saw it: local date and time, or time since the source's first sample ("12.5 min")."""

    here: Moment
    there: Moment


class Clock(Strict):
    """offset is added to the source's times; align_to estimates it from quantities that both logged, or from declared
    events."""

    offset: Seconds | None = None
    drift_ppm: float | None = None
    align_to: str | None = None
    by: list[AlignBy] = []
    events: list[ClockEvent] = []
    resets: Literal["refuse", "allow"] = "refuse"


class SourceSpec(Strict):
    reader: str
    files: str | list[str] | None = None
    timezone: str | None = None
    encoding: str | None = None
    table: TableLayout | None = None
    topics: list[str] = []
    clock: Clock = Clock()
    options: dict[str, Any] = {}


class Sensor(Strict):
    model_config = ConfigDict(extra="allow", frozen=True)
    serial: str | None = None
    range: tuple[Value, Value] | None = None  # in the unit of the raw signal, or with units
    resolution: Value | None = None


class Channel(Strict):
    """Exactly one of: source + signal, derive, schedule."""

    source: str | None = None
    signal: str | None = None
    derive: str | None = None
    schedule: list[tuple[Value, Value]] | None = None  # [[time, value], ...], held between
    quantity: Quantity
    unit: str | None = None
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
        return self


class JumpCalibration(Strict):
    kind: Literal["jump"]
    axis: Literal["X", "Y", "Z", "A", "B", "C"]
    source: str
    file: str
    signal: str
    moves: list[Um] | Literal["unknown"]  # unknown: nothing is calibrated until they are written
    dwell: Seconds = 10.0
    move_uncertainty: Um = 1.0
    facing: Direction | None = None
    increases_with: Literal["gap", "approach"] | None = None
    gain: Value | None = None  # data sheet, cross-checked


class ScaleCalibration(Strict):
    kind: Literal["scale"]
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    gain: Value
    offset: Value = 0
    facing: Direction | None = None
    increases_with: Literal["gap", "approach"] = "gap"
    uncertainty: Value | None = None  # of the gain, e.g. "2 %"


class LinearCalibration(Strict):
    kind: Literal["linear"]
    gain: Value = 1
    offset: Value = 0


Calibration = Annotated[JumpCalibration | ScaleCalibration | LinearCalibration, Field(discriminator="kind")]


class Tool(Strict):
    model_config = ConfigDict(extra="allow", frozen=True)
    id: str | None = None
    length: Value | None = None
    diameter: Value | None = None
    material: str | None = None


class Measuring(Strict):
    """The long form of `measuring`: an expression or a range, plus how long it must hold."""

    when: str | None = None
    in_range: str | dict[str, tuple[Value, Value]] | None = None
    settle: Seconds = 0.0
    for_: Annotated[float, _in("s")] | None = Field(default=None, alias="for")


class Zero(Strict):
    over: Seconds = 600.0


class ChannelOverride(Strict):
    """A channel as it was in one test only (a sensor moved, another signal)."""

    source: str | None = None
    signal: str | None = None
    unit: str | None = None
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: str | None = None
    relative_to: str | None = None
    calibration: str | list[str] | None = None
    sensor: Sensor | None = None
    schedule: list[tuple[Value, Value]] | None = None
    absent: bool = False


class Test(Strict):
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
    window: tuple[Seconds, Seconds] | None = None  # from the start of the recording
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
    __test__ = False
    file: str
    key: str
    columns: dict[str, str] = {}  # condition -> column of the table
    sheet: int | str | None = None


class TestsFrom(Strict):
    """Many tests whose conditions stand in file names, or in a table beside them."""

    __test__ = False
    files: str  # "raw/S{speed}_F{feed}_{nr}.csv"
    source: str | None = None  # default: the campaign's only source
    id: str | None = None  # default: the file's stem; may use the fields
    table: TestsTable | None = None
    units: dict[str, str] = {}
    disagree: Literal["error", "table", "name"] = "error"
    set: dict[str, Any] = {}


class Campaign(Strict):
    """One campaign. `tests_from` is expanded by the loader into `tests`."""

    schema_: Literal["thermodata/campaign/1"] = Field(alias="schema")
    id: str
    machine: Machine = Machine(id="unknown")
    sources: dict[str, SourceSpec] = {}
    channels: dict[str, Channel] = {}
    calibrations: dict[str, Calibration] = {}
    tests: list[Test] = []
    tests_from: TestsFrom | list[TestsFrom] | None = None
    versions: dict[str, str] = {}  # file -> the SHA-256 (or its beginning) of an earlier version
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
