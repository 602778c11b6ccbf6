"""What a draft of a campaign is made of: plain data that `init --json` prints and `writing` writes as YAML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from thermodata.draft.campaign.two_campaigns import Campaigns
from thermodata.draft.courses.kinds import Kind
from thermodata.draft.courses.measuring import Measuring
from thermodata.draft.folder.beside.table import TestTable
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.times.clocks import Alignment


@dataclass(frozen=True, slots=True)
class DraftSource:
    """sources.<name>. files: a glob with {test}, a shared one, or None where each test names its files; table: what has
    to be declared of its layout, with 'unknown' where a question asks for it; encoding: of its texts, where it has
    to be seen; timezone: where the file before declared it; told: of what of that by which it is known."""

    name: str
    reader: str
    files: str | None
    questions: tuple[str, ...] = ()
    table: Mapping[str, Any] = field(default_factory=dict)
    align: Alignment | None = None
    encoding: str | None = None
    told: tuple[str, ...] = ()
    timezone: str | None = None


@dataclass(frozen=True, slots=True)
class DraftChannel:
    """channels.<name>, or a signal that no quantity fits (said.quantity None). signal: as it stands in the file; stream
    where the file has several; only_in: the tests that have it, where not all of the source's do, and missing_in those
    that lack it. as_exported: its calibration says that it counts along its axis as it stands there."""

    name: str
    source: str
    signal: str
    stream: str | None
    said: Guess
    calibration: str | None = None
    only_in: tuple[str, ...] = ()
    missing_in: tuple[str, ...] = ()
    note: str | None = None
    as_exported: bool = False


@dataclass(frozen=True, slots=True)
class DerivedChannel:
    """channels.<name> of what no file has, and another channel tells. why: it is proposed."""

    name: str
    derive: str
    quantity: str
    unit: str
    at: str
    why: str


@dataclass(frozen=True, slots=True)
class DraftJump:
    """calibrations.<name>: a jump test whose moves nobody but the lab knows. seen: its steps as they were logged;
    sheet: of a workbook whose sheets are tests."""

    name: str
    source: str
    file: str
    signal: str | None
    axis: str | None
    dwell_s: float
    seen: tuple[float, ...]
    unit: str | None
    question: str
    sheet: str | None = None


@dataclass(frozen=True, slots=True)
class OwnChannel:
    """tests[].channels.<name>: what a channel is in one test only. asked: of it."""

    keys: Mapping[str, object]
    asked: str


@dataclass(frozen=True, slots=True)
class DraftTest:
    """tests[]: files: source -> path or paths, where the source's pattern does not find them; window: of a table that
    holds several, since its first row [s]; length_s: None where its files were not read to their ends; channels: that
    differ in it."""

    id: str
    kind: Kind
    conditions: dict[str, str]
    files: dict[str, str | list[str]]
    doubts: tuple[str, ...] = ()
    measuring: Measuring | None = None
    window: tuple[float, float] | None = None
    length_s: float | None = None
    channels: Mapping[str, OwnChannel] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Draft:
    """A campaign file to be. not_used: (path, reason); unused: the files among them of which nothing is read; failed:
    (path, reader) of those among them that a reader claims and could not read; damaged: (path, what); table: of tests,
    where one is there; machines: what the files say of whose they are."""

    campaign: str
    sources: tuple[DraftSource, ...]
    channels: tuple[DraftChannel, ...]
    jumps: tuple[DraftJump, ...]
    tests: tuple[DraftTest, ...]
    table: TestTable | None = None
    not_used: tuple[tuple[str, str], ...] = ()
    damaged: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = field(default_factory=tuple)
    failed: tuple[tuple[str, str], ...] = ()
    unused: tuple[str, ...] = ()
    derived: tuple[DerivedChannel, ...] = ()
    machines: Campaigns = field(default_factory=Campaigns)
