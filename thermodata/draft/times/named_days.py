"""Logs with a file a day: 'Thermo_20260407.txt'. Where they tell times of day only the name says when they began; and
whatever they tell, which go on without a gap in the file of the next day."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta

from thermodata.draft.files.day_in_name import began_ns, day_of_name, span_ns
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.words.said_by_names import said_by
from thermodata.schema.words.sentences import counted

_DAY_NS = 86_400 * 10**9
_PAUSE_ROWS, _PAUSE_NS = 3, 60 * 10**9
_SHOWN = 3


def named_start(files: Sequence[RawFile]) -> str | None:
    """The moment at which undated files began, '2026-04-07 20:00:00': the day that the name of the first says, and the
    time of day of its first row. None where one of them has a date, or says none."""
    known = [began_ns(f) for f in files]
    starts = [ns for ns in known if ns is not None]
    if not starts or len(starts) < len(known):
        return None
    return f"{datetime(1970, 1, 1, tzinfo=UTC) + timedelta(seconds=min(starts) // 10**9):%Y-%m-%d %H:%M:%S}"


def over_midnight(groups: Sequence[Group]) -> tuple[list[Group], list[str]]:
    """The groups, tests that are one recording joined; and a note on each. Where several sources have a test, all of
    them go on in the next."""
    begun: dict[str, int] = {}
    named: dict[str, str] = {}  # what its first file is called, but for the day
    for group in groups:
        for test, files in group.tests.items():
            began = (span_ns(files[0]) or (0, 0))[0]
            begun[test] = min(begun.get(test, began), began)
            named.setdefault(test, repr(_but_day(files[0])))
    home_of: dict[str, str] = {}
    last: dict[str, str] = {}
    for test in sorted(begun, key=lambda t: begun[t]):
        before = last.get(named[test])
        on = before and all(_goes_on(g.tests.get(before), g.tests[test]) for g in groups if test in g.tests)
        home_of[test] = home_of[before] if before and on else test
        last[named[test]] = test
    later: dict[str, list[str]] = {}
    for test, home in home_of.items():
        if test != home:
            paths = [str(f.path) for g in groups for f in g.tests.get(test, ())]
            later.setdefault(home, []).extend(paths)
    made = [g if all(home_of[t] == t for t in g.tests) else _joined(g, home_of) for g in groups]
    return made, [_note(home, paths) for home, paths in later.items()]


def _joined(group: Group, home_of: Mapping[str, str]) -> Group:
    tests: dict[str, tuple[RawFile, ...]] = {test: () for test in group.tests if home_of[test] == test}
    for test in sorted(group.tests, key=lambda t: (span_ns(group.tests[t][0]) or (0, 0))[0]):
        tests[home_of[test]] = (*tests[home_of[test]], *group.tests[test])
    return replace(group, tests=tests, template=None)


def _note(home: str, paths: Sequence[str]) -> str:
    shown = ", ".join(paths[:_SHOWN]) + (f" and {counted(len(paths) - _SHOWN, 'more file')}" if paths[_SHOWN:] else "")
    return f"{home} goes on without a gap in {shown}, by the dates in their names: one test; a window cuts out a part"


def _but_day(file: RawFile) -> tuple[object, ...]:
    """What a name says beside its day: 'S4000_20260407' and 'S8000_20260408' are two tests, whenever they ran."""
    said = said_by([file.path.stem])
    return re.sub(r"[\d\W_]+", "", file.path.stem), said.speeds, {**said.conditions, "date": ""}


def _goes_on(before: Sequence[RawFile] | None, after: Sequence[RawFile]) -> bool:
    """Whether files end where others of their name begin, a day later by both names."""
    if not before or _but_day(before[-1]) != _but_day(after[0]):
        return False
    ended, begins = span_ns(before[-1]), span_ns(after[0])
    days = day_of_name(before[-1]), day_of_name(after[0])
    if ended is None or begins is None or days[0] is None or days[1] is None or days[1] - days[0] != _DAY_NS:
        return False
    pause = max(_PAUSE_NS, _PAUSE_ROWS * (ended[1] - ended[0]) // max(before[-1].sample.rows - 1, 1))
    return 0 <= begins[0] - ended[1] <= pause
