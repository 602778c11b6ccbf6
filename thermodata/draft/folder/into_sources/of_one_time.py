"""Sheets and groups of a file that are no tests: they ran at once, or stand in every file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from thermodata.draft.files.file_question import FileQuestion
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sheets import recordings_in
from thermodata.draft.folder.into_sources.one_or_many import told_apart
from thermodata.schema.words.sentences import with_dots

_NAMED = 4


def of_one_time(whole: RawFile, found: Sequence[RawFile]) -> RawFile | None:
    """The whole file where its sheets or groups ran at once, and are no tests; with a question where they did so more
    than once, and where no date but only their equal ends say so. None where they are tests."""
    if not all(f.sheet for f in found):
        return None
    recordings = recordings_in([f.start_ns for f in found], [f.sample for f in found])
    if not recordings:
        return None
    if any(f.start_ns is None for f in found):
        return None if told_apart(found) else _asked(whole, found, "begin and end at one time, and have no dates")
    if recordings < 2:
        return whole
    asked = (
        f"it holds {recordings} recordings of several loggers or rates: a test each? then write each with its window"
    )
    return replace(whole, asked=(*whole.asked, FileQuestion(asked, {})))


def in_every_file(apart: Mapping[str, tuple[RawFile, Sequence[RawFile]]]) -> dict[str, RawFile]:
    """Path -> the whole file, of those whose sheets or groups stand in every file, without dates and with names that
    tell no tests apart. apart: path -> (the whole, its parts)."""
    names = {tuple(sorted(f.sheet or "" for f in found)) for _, found in apart.values()}
    if len(apart) < 2 or len(names) != 1:
        return {}
    return {
        path: _asked(whole, found, "are in every file, and have no dates")
        for path, (whole, found) in apart.items()
        if all(f.sheet and f.start_ns is None for f in found) and not told_apart(found)
    }


def _asked(whole: RawFile, found: Sequence[RawFile], why: str) -> RawFile:
    named = with_dots([f"'{f.sheet}'" for f in found], _NAMED)
    asked = f"{named} {why}: loggers or rates of one test, or a test each? then table: {{sheet: '{{test}}'}}"
    return replace(whole, asked=(*whole.asked, FileQuestion(asked, {})))
