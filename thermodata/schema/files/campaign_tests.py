"""`tests`, `tests_from` and `overrule` of a campaign file: what the machine did, and which flags are wrong."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, field_validator

from thermodata.schema.files.campaign_channels import Sensor
from thermodata.schema.strict.declared import (
    NOT_NEGATIVE,
    POSITIVE,
    At,
    Attributed,
    Length,
    Paths,
    Position,
    Seconds,
    Strict,
    Value,
    WrongValueError,
    date_and_time,
    in_unit,
)

TestKind = Literal["spindle", "spectrum", "linear_axis", "rotary_axis", "etve", "cutting", "mixed", "other"]
Role = Literal["calibration", "verification", "locked", "none"]


class Tool(Attributed):
    """`tests[].tool`: what was in the spindle. Free attributes are conditions too.

    id: its name or number
    length: with a unit
    diameter: with a unit
    material: of the tool
    """

    id: str | None = None
    length: Length | None = None
    diameter: Length | None = None
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
    settle: Annotated[Seconds, NOT_NEGATIVE] = 0.0
    for_: Annotated[float, in_unit("s"), NOT_NEGATIVE] | None = Field(default=None, alias="for")


class Zero(Strict):
    """`tests[].zero`: where displacements are zero: the mean of the first valid samples, never a fit.

    over: how long those samples last [s]
    """

    over: Annotated[Seconds, POSITIVE] = 600.0


class ChannelOverride(Strict):
    """`tests[].channels.*`: a channel as it was in one test only (a sensor moved, another signal).

    source: key of `sources`
    signal: its name in the file
    unit: of the raw values
    instead_of: the unit that the file states, where that is wrong
    scaled: true: the values have the factor and the offset that the file states beside them
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
    scaled: bool | None = Field(default=None, exclude_if=lambda scaled: scaled is None)
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: At | None = None
    relative_to: At | None = None
    calibration: str | list[str] | None = None
    sensor: Sensor | None = None
    schedule: list[tuple[Value, Value]] | None = None
    absent: bool = False


class Test(Strict):
    """`tests[]`: one test. Times count from the start of the recording, with units.

    id: short name, unique in the campaign, without / \\ { } * ? [ ]
    kind: what was done
    role: calibration: fitted; verification: scored, and part of the choice; locked: opened to confirm a cause only,
        every look counted; none: kept
    conditions: any, with units or as text: speed: 9000 rpm
    pose: positions of the axes, with units
    tool: what was in the spindle
    machine: attributes of `machine` that differ in this test
    channels: channels that differ in this test
    files: files of a source, where its pattern does not give them
    clocks: of a source whose clock was off in this test, what is added to its times there [s], in place of the offset
        or alignment that the source has: cn: -2400 s
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
    pose: dict[str, Position] = {}
    tool: Tool | None = None
    machine: dict[str, Any] = {}
    channels: dict[str, ChannelOverride] = {}
    files: dict[str, Paths] = {}
    clocks: dict[str, Seconds] = Field(default={}, exclude_if=lambda clocks: not clocks)
    start: Annotated[str | None, BeforeValidator(date_and_time)] = Field(
        default=None, exclude_if=lambda start: start is None
    )
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
            raise WrongValueError(
                "no id of a test", expected="a short name without / \\ { } * ? [ ], of at most 120 letters"
            )
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
    source: key of `sources`; by default the only one, or of several the one whose own `files` names these files
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
