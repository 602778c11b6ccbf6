"""What a file leaves open, as a question of the draft; and the questions that the notes of its reader hold."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.reader.text.preamble.begin import BY_HALF, EITHER, NOT_TAKEN, UNREAD
from thermodata.reader.text.rows.changed_cells import DOUBT
from thermodata.reader.text.times.one_cell.unpadded import UNPADDED
from thermodata.reader.times.open_questions import ASK, UNKNOWN, YEAR

_ASSUMED = (
    f"counted as 1 s each|taken as seconds from a start|changes its distance from them|{UNPADDED}|is that its unit|"
    f"{re.escape(ASK)}|{re.escape(YEAR)}|has dates, which the log times have not|the file looks converted"
)
_UNIT: Mapping[str, Any] = {"time": {"unit": UNKNOWN}}
START: Mapping[str, Any] = {"time": {"start": UNKNOWN}}
_FORMAT: Mapping[str, Any] = {"time": {"format": UNKNOWN}}
_BY_HALF = "with AM or PM most loggers write the month first, British and Australian ones the day"
STANDS = "stands: "  # begins the question whether a value stands over the empty cells behind it
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


def of_notes(notes: Sequence[str], *, timed: bool) -> list[FileQuestion]:
    """What the notes of a reader leave open. timed: a question of the time is asked already, and what was taken of it
    meanwhile is no question of its own."""
    asked: list[FileQuestion] = []
    if not timed:  # what a reader takes by custom, MATLAB's seconds, is asked here
        asked += [FileQuestion("unit of the time: s, min or h?", _UNIT) for n in notes if "taken as seconds;" in n]
        asked += [FileQuestion(f"time: {n}", {}) for n in notes if re.search(_ASSUMED, n)]
        asked += [FileQuestion(_asked_unread(n), START) for n in notes if UNREAD in n]
        asked += [FileQuestion(_asked_start(n), START) for n in notes if NOT_TAKEN in n and "{start: head}" in n]
    return [*asked, *(FileQuestion(f"{STANDS}{n}", {}) for n in notes if DOUBT in n)]


def open_order(note: str) -> FileQuestion | None:
    """The question of a note on a start or on dates whose day and month may be either way round; None of others."""
    if BY_HALF in note and note.startswith("dates read as"):
        return FileQuestion(f"format of the dates: dmy or mdy? {_BY_HALF}", _FORMAT)
    if EITHER in note:
        return FileQuestion(
            f"start: dmy or mdy? {note.split(EITHER)[0].rstrip(', ')}, which may be either; {_NO_START}", START
        )
    if BY_HALF in note:
        said = re.sub("^.* above the rows: ", "the head says ", note.split(", read " + BY_HALF)[0])
        return FileQuestion(f"start: dmy or mdy? {said}, which may be either: {_BY_HALF}; {_NO_START}", START)
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
