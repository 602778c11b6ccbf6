"""The campaign file: what was measured, where, by what, and how it is calibrated. Contract `campaign/1`.

Its parts stand in modules of their own: `campaign_sources`, `campaign_channels`, `campaign_tests`, all made of what
`declared` gives; who needs them takes them from here.
"""

from __future__ import annotations

import re
from typing import Literal, get_args

from pydantic import Field, field_validator

from thermodata.schema.files.campaign_channels import (
    Calibration,
    Channel,
    JumpCalibration,
    LinearCalibration,
    PlatinumCalibration,
    ScaleCalibration,
    Sensor,
)
from thermodata.schema.files.campaign_sources import AlignBy, Clock, ClockEvent, SourceSpec, TableLayout, TimeColumn
from thermodata.schema.files.campaign_tests import (
    ChannelOverride,
    Measuring,
    Overrule,
    Role,
    Test,
    TestKind,
    TestsFrom,
    TestsTable,
    Tool,
    Zero,
)
from thermodata.schema.strict.declared import (
    STORED,
    Attributed,
    Direction,
    Moment,
    Seconds,
    Strict,
    Um,
    Value,
    WrongKeyError,
    WrongValueError,
)
from thermodata.schema.units.quantity import QUANTITIES

NAME = re.compile(r"^[A-Za-z][A-Za-z0-9_]*$")
RESERVED_NAMES = frozenset({"campaign", "test", "source", "t", "t_s"})


Feedback = Literal["scale", "screw", "motor"]
FEEDBACKS: tuple[str, ...] = get_args(Feedback)


class Axis(Attributed):
    """`machine.axes.X`: a linear or rotary axis. Free attributes (`preload: 2.1 kN`) are conditions too.

    feedback: what closes the position loop; behind a scale the growth of the screw does not reach the tool
    """

    feedback: Feedback | None = None


class Machine(Attributed):
    """`machine`: the machine that was tested. Free attributes are conditions too: gains can depend on them.

    id: its number or name in the lab
    description: free text
    axes: its axes by letter
    """

    id: str
    description: str = ""
    axes: dict[str, Axis] = {}


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

    @property
    def begun_by(self) -> frozenset[str]:
        """Sources at whose beginning a test begins, beside those whose displacements are channels: none that a file
        could name."""
        return frozenset()

    @field_validator("id")
    @classmethod
    def _safe_id(cls, value: str) -> str:
        if not re.match(r"^[A-Za-z0-9][A-Za-z0-9._-]{0,119}$", value):
            raise WrongValueError(
                "no id of a campaign", expected="letters, digits, '.', '_' and '-', at most 120 of them"
            )
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
                raise WrongKeyError(
                    name,
                    f"no name for a channel: '{name}'",
                    expected="letters, digits and single '_', starting with a letter, and none of "
                    + f"{', '.join(sorted(RESERVED_NAMES))}, in capital letters or small",
                    hint=f"for example {_allowed(name)}: the channel's 'signal' stays as the file has it",
                )
            if name.lower() in seen:
                raise WrongKeyError(
                    name,
                    f"channels '{seen[name.lower()]}' and '{name}' differ only in case",
                    expected="names that are unique ignoring case, as columns of a table are",
                    hint=f"for example {name}_2, or what tells the two apart",
                )
            seen[name.lower()] = name
        return value


def _allowed(name: str) -> str:
    """A name that is like a refused one."""
    word = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9]", "_", name)).strip("_")
    word = word if word[:1].isalpha() else f"ch_{word}".rstrip("_")
    return f"{word}_1" if word.lower() in RESERVED_NAMES else word


__all__ = [
    "NAME",
    "QUANTITIES",
    "RESERVED_NAMES",
    "STORED",
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
    "Moment",
    "Overrule",
    "PlatinumCalibration",
    "Role",
    "ScaleCalibration",
    "Seconds",
    "Sensor",
    "SourceSpec",
    "Strict",
    "TableLayout",
    "Test",
    "TestKind",
    "TestsFrom",
    "TestsTable",
    "TimeColumn",
    "Tool",
    "Um",
    "Value",
    "Zero",
]
