"""Logs that tell times of day, and their date in the file's name only: 'Thermo_20260407.txt'. The name says when they
began, and which go on behind midnight in the file of the next day."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.sources import Group
from thermodata.draft.words.said_by_names import said_by

_DAY_NS = 86_400 * 10**9
_PAUSE_ROWS, _PAUSE_NS = 3, 60 * 10**9


def named_start(files: Sequence[RawFile]) -> str | None:
    """The moment at which undated files began, '2026-04-07 20:00:00': the day that the name of the first says, and the
    time of day of its first row. None where one of them has a date, or says none."""
    known = [_began_ns(f) for f in files]
    starts = [ns for ns in known if ns is not None]
    if not starts or len(starts) < len(known):
        return None
    return f"{datetime(1970, 1, 1, tzinfo=UTC) + timedelta(seconds=min(starts) // 10**9):%Y-%m-%d %H:%M:%S}"


def over_midnight(groups: Sequence[Group]) -> tuple[list[Group], list[str]]:
    """The groups, tests of one source that are one recording joined; and a note on each."""
    if sum(bool(g.tests) for g in groups) != 1:
        return list(groups), []
    made, notes = [], []
    for group in groups:
        joined: dict[str, tuple[RawFile, ...]] = {}
        order = sorted(group.tests, key=lambda t: _began_ns(group.tests[t][0]) or 0)
        home = None
        for test in order:
            files = group.tests[test]
            if home is not None and _goes_on(joined[home][-1], files[0]):
                joined[home] = (*joined[home], *files)
                notes.append(f"{home} goes on in {files[0].path}, by the dates in their names: one test")
            else:
                joined[test], home = files, test
        whole = {t: joined[t] for t in group.tests if t in joined}
        made.append(group if len(whole) == len(group.tests) else replace(group, tests=whole, template=None))
    return made, notes


def _began_ns(file: RawFile) -> int | None:
    said = file.recording
    if said.clock != "relative" or said.start_ns is not None or said.of_day_ns is None:
        return None
    date = said_by([file.path.stem]).conditions.get("date")
    try:
        day = None if date is None else datetime.strptime(date, "%Y-%m-%d").replace(tzinfo=UTC)
    except ValueError:  # 31 April
        return None
    return None if day is None else round(day.timestamp()) * 10**9 + said.of_day_ns


def _but_day(file: RawFile) -> tuple[object, ...]:
    """What a name says beside its day: 'S4000_20260407' and 'S8000_20260408' are two tests, whenever they ran."""
    said = said_by([file.path.stem])
    return re.sub(r"[\d\W_]+", "", file.path.stem), said.speeds, {**said.conditions, "date": ""}


def _goes_on(before: RawFile, after: RawFile) -> bool:
    """Whether a file ends at midnight, and another of its name begins there a day later."""
    began, then, seen = _began_ns(before), _began_ns(after), before.sample
    if _but_day(before) != _but_day(after):
        return False
    if began is None or then is None or not seen.whole or seen.first_ns is None or seen.last_ns is None:
        return False
    midnight = (began // _DAY_NS + 1) * _DAY_NS
    end = began + seen.last_ns - seen.first_ns
    pause = max(_PAUSE_NS, _PAUSE_ROWS * (seen.last_ns - seen.first_ns) // max(seen.rows - 1, 1))
    return end <= then and midnight - end <= pause and midnight <= then <= midnight + pause
