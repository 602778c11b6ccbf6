"""One file of a folder: who reads it, what its reader says of it, what it leaves open, and a sample of its values.
A workbook whose sheets are tests is as many files."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Any

from thermodata.archive.members import size_of
from thermodata.archive.unpacked import held
from thermodata.draft.files.ini_beside import offered_by_ini
from thermodata.draft.files.letters_of_files import common, letters_of
from thermodata.draft.files.sample import Sample, sample_of
from thermodata.draft.files.sheets import sheet_like, sheets_of
from thermodata.draft.signals.named_by_units import with_names_as_units
from thermodata.errors import QuestionError
from thermodata.plugin import Reader, Recording, Signal, Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.explain import kind_of, why_no_table
from thermodata.reader.finding.registry import claims, reader
from thermodata.reader.text.preamble.begin import BY_HALF, EITHER, NOT_TAKEN, UNREAD
from thermodata.reader.text.rows.changed_cells import DOUBT
from thermodata.reader.text.times.one_cell.unpadded import UNPADDED
from thermodata.reader.times.open_questions import ASK, UNKNOWN, YEAR
from thermodata.reader.times.zone import NO_ZONE

_MOST_QUESTIONS = 4
_ASSUMED = (
    f"counted as 1 s each|taken as seconds from a start|changes its distance from them|{UNPADDED}|is that its unit|"
    f"{re.escape(ASK)}|{re.escape(YEAR)}|has dates, which the log times have not|the file looks converted"
)
_UNIT: Mapping[str, Any] = {"time": {"unit": UNKNOWN}}
_START: Mapping[str, Any] = {"time": {"start": UNKNOWN}}
_FORMAT: Mapping[str, Any] = {"time": {"format": UNKNOWN}}
_BY_HALF = "with AM or PM most loggers write the month first, British and Australian ones the day"
_NO_START = "none if it is no start"


@dataclass(frozen=True, slots=True)
class FileQuestion:
    """A question that a file leaves. declare: as in `sources.*.table`, 'unknown' where the answer goes; times: columns
    that are the time once it is answered; told: whether it is answered already, and `ask` says by what; begins_s: where
    the times of the column begin that it proposes."""

    ask: str
    declare: Mapping[str, Any]
    times: tuple[str, ...] = ()
    told: bool = False
    begins_s: float | None = None


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
        return not self.recording.is_undated or any(a.declare == _START for a in self.asked)

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


def sampled_file(folder: Path, path: PurePosixPath) -> RawFile | None:
    """One file of a folder with a sample of its values; None where no reader, or more than one, claims it.

    ThermodataError where it cannot be read at all.
    """
    who, _ = claimant(folder / path)
    if who is None:
        return None
    file = described_files(who, folder / path, path)[0]
    return replace(file, sample=sample_of_file(folder / path, file))


def described_file(
    who: Reader,
    full: Path,
    path: PurePosixPath,
    encoding: str | None,
    table: Mapping[str, Any] | None = None,
) -> RawFile:
    """A file as its reader describes it, with what it leaves open. encoding: what somebody declared for texts that are
    no UTF-8; table: answers to what it leaves open.

    ThermodataError where it cannot be read at all.
    """
    with held(full) as real:
        size, letters = real.stat().st_size, letters_of(real, encoding)
        return _asking(
            who, full, RawFile(path, who.name, Recording((), "relative"), size, table=table, letters=letters)
        )


def described_files(
    who: Reader,
    full: Path,
    path: PurePosixPath,
    table: Mapping[str, Any] | None = None,
) -> list[RawFile]:
    """The same; a workbook whose sheets are alike sheet by sheet."""
    return sheet_by_sheet(who, full, described_file(who, full, path, None, table))


def sheet_by_sheet(who: Reader, full: Path, whole: RawFile) -> list[RawFile]:
    """A workbook whose sheets, or a recording whose groups, are alike, as that many files; any other as it is."""
    names, besides = sheets_of(whole.recording)
    return _by_sheets(who, full, whole, names, besides) if names else [whole]


def of_one_sheet(full: Path, whole: RawFile, others: Sequence[RawFile]) -> RawFile:
    """A recording of one group, or a workbook of one sheet, as that, where it is of the kind of others whose sheets are
    tests; any other as it is."""
    alike = [o for o in others if (o.reader, o.path.suffix.lower()) == (whole.reader, whole.path.suffix.lower())]
    home = sheet_like(whole.recording, [o.recording for o in alike])
    if home is None:
        return whole
    return _by_sheets(reader(whole.reader), full, replace(whole, sample=Sample()), [home], [])[0]


def _by_sheets(who: Reader, full: Path, whole: RawFile, names: Sequence[str], besides: Sequence[str]) -> list[RawFile]:
    found = []
    left = [f"its sheet '{n}' is not like the {len(names)} others: a list of tests, or notes?" for n in besides]
    left += [f"its {note}" for note in whole.recording.notes if re.match(r"sheet '.*' is not read", note)]
    asked = tuple(a for a in whole.asked if a.declare)  # what one sheet leaves open, all are declared by
    for name in names:
        table = {**(whole.table or {}), "sheet": name}
        one = replace(whole, sheet=name, besides=tuple(left), table=table, asked=asked)
        found.append(_asking(who, full, one))
    return found


def _asking(who: Reader, full: Path, file: RawFile) -> RawFile:
    """The file described, each of its questions answered for the time being."""
    asked = list(file.asked)
    table: dict[str, Any] = dict(file.table or {})
    while True:
        try:
            recording = described(who, full, replace(file, table=table or None).source)
            open_order = next((o for n in recording.notes if (o := _open_order(n)) is not None), None)
            # a note may quote a file that says so itself: asked once
            if open_order is None or any(one.declare == open_order.declare for one in asked):
                break
            asked.append(open_order)
            table = merged(table, {"time": dict.fromkeys(open_order.declare["time"], "dmy")})
        except QuestionError as question:
            if len(asked) == _MOST_QUESTIONS:
                raise
            told = offered_by_ini(full) if question.ask.startswith("period") else ""
            asked.append(
                FileQuestion(question.ask + told, question.declare, question.times, begins_s=question.begins_s)
            )
            table = merged(table, question.meanwhile)
    if not any("time" in a.declare for a in asked):  # what a reader takes by custom, MATLAB's seconds, is asked here
        asked += [
            FileQuestion("unit of the time: s, min or h?", _UNIT) for n in recording.notes if "taken as seconds;" in n
        ]
        asked += [FileQuestion(f"time: {n}", {}) for n in recording.notes if re.search(_ASSUMED, n)]
        asked += [FileQuestion(_asked_unread(n), _START) for n in recording.notes if UNREAD in n]
        asked += [
            FileQuestion(_asked_start(n), _START) for n in recording.notes if NOT_TAKEN in n and "{start: head}" in n
        ]
    asked += [FileQuestion(f"stands: {n}", {}) for n in recording.notes if DOUBT in n]
    left = _without_times(recording, {name for a in asked for name in a.times})
    signals, as_units = with_names_as_units(left.signals)
    if as_units is not None:
        left, asked = replace(left, signals=signals), [*asked, FileQuestion(as_units, {})]
    return replace(file, recording=left, delivered=recording, asked=tuple(asked), table=table or None)


def _without_times(recording: Recording, times: Set[str]) -> Recording:
    """The recording without the columns that are its time once a question is answered: no channels are drafted of
    them."""
    left = tuple(s for s in recording.signals if s.name not in times and s.name.partition("/")[2] not in times)
    return replace(recording, signals=left) if left else recording


def _open_order(note: str) -> FileQuestion | None:
    """The question of a note on a start or on dates whose day and month may be either way round; None of others."""
    if BY_HALF in note and note.startswith("dates read as"):
        return FileQuestion(f"format of the dates: dmy or mdy? {_BY_HALF}", _FORMAT)
    if EITHER in note:
        return FileQuestion(
            f"start: dmy or mdy? {note.split(EITHER)[0].rstrip(', ')}, which may be either; {_NO_START}", _START
        )
    if BY_HALF in note:
        said = re.sub("^.* above the rows: ", "the head says ", note.split(", read " + BY_HALF)[0])
        return FileQuestion(f"start: dmy or mdy? {said}, which may be either: {_BY_HALF}; {_NO_START}", _START)
    return None


def _asked_start(note: str) -> str:
    """The question of a note on a date above rows that may have begun then."""
    return f"start: head or none? {note.split(NOT_TAKEN)[0].rstrip(', ')}: did its rows begin then?"


def _asked_unread(note: str) -> str:
    """The question of a note on a start that can't be read."""
    said = note.split(UNREAD)[0].rstrip(", ")
    return (
        f"when did it begin? {said}, which can't be read: write it there as 2026-03-02 08:00:00; or start: none, and "
        "clock: {offset: 0 s} if it begins with its test, or the start of each test"
    )


def merged(one: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Both declarations; of what is in both, the parts of both."""
    out = dict(one)
    for key, value in other.items():
        out[key] = (
            merged(out[key], value) if isinstance(out.get(key), Mapping) and isinstance(value, Mapping) else value
        )
    return out


def claimant(path: Path) -> tuple[Reader | None, str]:
    """The one reader that claims a file, or None and why there is none."""
    found = claims(path)
    if len(found) == 1:
        return reader(next(iter(found))), ""
    if not size_of(path):
        return None, "an empty file"
    if not found:
        why = why_no_table(path)
        return None, f"no reader claims it ({kind_of(path)}): {why or 'thermodata sniff says why'}"
    said = " and ".join(f"{name} ({why})" for name, why in found.items())
    return (
        None,
        f"two readers claim it: {said}; declare one as the reader of a source, such as reader: {next(iter(found))}",
    )


def sample_of_file(path: Path, file: RawFile) -> Sample:
    """A sample of a file's values, as it was described."""
    return sample_of(path, reader(file.reader), file.source, file.delivered or file.recording, file.size)
