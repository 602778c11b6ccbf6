"""One file of a folder, or a part of it: what its reader says of it, what it leaves open, and a sample of values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

from thermodata.draft.files.file_question import START, FileQuestion
from thermodata.draft.files.letters_of_files import common
from thermodata.draft.files.sample import Sample
from thermodata.plugin import Recording, Signal, Source
from thermodata.reader.times.zone import NO_ZONE


@dataclass(frozen=True, slots=True)
class RowsOfTest:
    """Rows of a table that are one of the tests in it. window: from and to, since the first row of the table [s];
    said: by what, where no column of it names the test."""

    test: str
    window: tuple[float, float]
    said: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class RawFile:
    """A file that one reader claims, or a part of it. path: relative to the folder. like: the file of the same kind
    whose header was taken for this one's, where there was no time to read it; asked: what it does not say; table: the
    answers by which it was looked at meanwhile; sheet: of a workbook whose sheets are tests; block: of a table whose
    rows name their tests; besides: why others of its sheets are none; letters: the encoding of a text that is no ASCII;
    delivered: what its reader gives, where columns of it are left out of `recording`; sensor: the one that it is of
    among the files of a test."""

    path: PurePosixPath
    reader: str
    recording: Recording
    size: int = 0
    sample: Sample = field(default_factory=Sample)
    like: str | None = None
    asked: tuple[FileQuestion, ...] = ()
    table: Mapping[str, Any] | None = None
    sheet: str | None = None
    block: RowsOfTest | None = None
    besides: tuple[str, ...] = ()
    letters: str | None = None
    delivered: Recording | None = None
    sensor: str | None = None

    @property
    def source(self) -> Source:
        """What the reader is told, so that it reads the file at all."""
        return Source(encoding=common((self.letters,)), table=self.table)

    @property
    def part(self) -> str | None:
        """The sheet or block that it is of its file; None where it is all of it."""
        return self.sheet or (self.block.test if self.block is not None else None)

    @property
    def signals(self) -> tuple[Signal, ...]:
        return self.recording.signals

    @property
    def start_ns(self) -> int | None:
        """Where its absolute clock starts; None on a relative clock."""
        if self.recording.clock != "absolute":
            return None
        return self.sample.first_ns if self.sample.first_ns is not None else self.recording.start_ns

    @property
    def may_be_dated(self) -> bool:
        """Whether it has dates, or will have when it is answered which start its head says."""
        return not self.recording.is_undated or any(a.declare == START for a in self.asked)

    @property
    def counts_from_ns(self) -> int | None:
        """The first time of a file without dates, by the column that a question proposes where one does."""
        if not self.recording.is_undated or self.block is not None:
            return None
        asked = next((a.begins_s for a in self.asked if a.begins_s is not None), None)
        return self.sample.first_ns if asked is None else round(asked * 1e9)

    @property
    def local(self) -> bool:
        """Whether it logs local times of a zone that it does not name."""
        return self.recording.clock == "absolute" and any(NO_ZONE in n for n in self.recording.notes)
