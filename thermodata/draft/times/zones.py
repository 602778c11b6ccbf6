"""The zone of a source that logs local times and names none: what is asked of it, and what is known."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from zoneinfo import ZoneInfo

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.beside.clock_said import zone_said
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.times.in_repeated_hour import which_pass
from thermodata.draft.times.zone_of_names import EXAMPLE, named_zone, zone_in
from thermodata.reader.text.tables.sample.zone_named import OPEN, SAYS
from thermodata.reader.times.step_back import likely_cause
from thermodata.schema.words.sentences import with_count

_HOUR_NS = 3_600_000_000_000
_MOST_HOURS, _NEAR_NS = 14, 60 * 10**9  # that a zone is ahead; by which a log may begin after its test
# so far apart are beginnings of logs that a test starts; at minutes that no timetable knows, and so many different ones
_AT_ONCE_NS, _TIMETABLE_NS, _FEWEST_MINUTES = 10 * 10**9, 900 * 10**9, 2
_FILES, _RUNS = 3, 3  # that a question names
_WORD = re.compile(rf"{SAYS} '([^']*)'")
_ZONES = (  # of whole hours, by which logs are compared
    "UTC",
    "Europe/Prague",
    "Europe/Berlin",
    "Europe/London",
    "Europe/Helsinki",
    "Europe/Moscow",
    "Asia/Shanghai",
    "Asia/Tokyo",
    "America/New_York",
    "America/Chicago",
    "America/Los_Angeles",
    "America/Sao_Paulo",
)


def zone_question(group: Group, groups: Sequence[Group], folder: Path | None = None) -> str | None:
    """What to ask about the zone of a source that logs local times; None where it names its zone or has no dates.
    folder: where heads of its files can be read."""
    if not any(f.local for f in group.files):
        return None
    head = next((n for f in group.files for n in f.recording.notes if OPEN in n or n.startswith(SAYS)), None)
    elsewhere = _said_elsewhere(group)
    said = "" if head is None else f"; {head}{elsewhere}"
    # a zone of one offset is none of logs that name two
    likely = EXAMPLE if elsewhere else named_zone(head, [f.path for f in group.files])
    each = _each_ahead(group, groups)
    if each is None:
        asked = "timezone? it logs local times without a zone; taken as UTC. " + likely + said
        return asked + which_pass(group, groups, likely, folder) + _beside(folder, groups)
    asked = f"timezone? local times, {_shown({e.hours for e in each})} from the other sources' UTC"
    if more := _as_well(each):
        hours = sorted({e.hours + m for e in each for m in (0, *more)})
        longer = (
            f" if each log begins with its test; they are longer, and {hours[0]:+d} to {hours[-1]:+d} h fit as well"
        )
        return f"{asked}{longer}. {likely}{said}"
    return f"{asked}{_changes(each)}{_zones_of([(e.hours, e.begin_ns) for e in each], likely, group)}{said}"


def _beside(folder: Path | None, groups: Sequence[Group]) -> str:
    """What texts beside the logs say of the zone."""
    logs = {f.path for g in groups for f in (*g.files, *g.calibrations)}
    return "" if folder is None or not folder.is_dir() else zone_said(folder, logs)


@dataclass(frozen=True, slots=True)
class _Ahead:
    """A test's local log beside the UTC of another source. hours: by which it is ahead if both begin at once; begin_ns:
    in UTC; starts_ns: the log, in its local times; name: of the log; holds: by how many more hours it could be ahead,
    and hold all of the test."""

    hours: int
    begin_ns: int
    starts_ns: int
    name: str
    holds: frozenset[int]


def _as_well(each: Sequence[_Ahead]) -> frozenset[int]:
    """By how many hours more than where logs begin with their tests all of them could be ahead; none where
    these beginnings tell."""
    return frozenset() if _begin_at_once(each) else frozenset.intersection(*(e.holds for e in each))


def _begin_at_once(each: Sequence[_Ahead]) -> bool:
    """Whether each log begins with its test but for the same time, to seconds, at minutes that differ: a file of a day
    or an hour begins at a whole one."""
    late = [e.starts_ns - e.begin_ns - e.hours * _HOUR_NS for e in each]
    odd = [e.begin_ns % _HOUR_NS // (60 * 10**9) for e in each if _off_timetable(e.starts_ns)]
    return max(late) - min(late) <= _AT_ONCE_NS and len(set(odd)) >= _FEWEST_MINUTES


def _off_timetable(at_ns: int) -> bool:
    return _AT_ONCE_NS < at_ns % _TIMETABLE_NS < _TIMETABLE_NS - _AT_ONCE_NS


def _changes(each: Sequence[_Ahead]) -> str:
    """From which log on local times are another number of hours ahead than in those before; '' where all are alike."""
    runs: list[tuple[int, list[tuple[int, str]]]] = []
    for one in sorted(each, key=lambda e: e.begin_ns):
        if not runs or runs[-1][0] != one.hours:
            runs.append((one.hours, []))
        runs[-1][1].append((one.begin_ns, one.name))
    if len(runs) < 2:
        return ""
    first, *others = (
        f"{hours:+d} h {'' if k == 0 else f'from {_day(logs[0][0])} on '}in {with_count([n for _, n in logs], _FILES)}"
        for k, (hours, logs) in enumerate(runs)
    )
    return f" ({'; '.join((first, *others[:_RUNS]))}{'; ...' if len(others) > _RUNS else ''})"


def _day(at_ns: int) -> str:
    return f"{datetime.fromtimestamp(at_ns / 1e9, UTC):%Y-%m-%d}"


def _said_elsewhere(group: Group) -> str:
    """What the heads of later logs say of their zone, where that is another one than the first says."""
    words: dict[str, RawFile] = {}
    for file in sorted(group.files, key=lambda f: f.start_ns or 0):
        for note in file.recording.notes:
            if (word := _WORD.search(note)) is not None and (OPEN in note or note.startswith(SAYS)):
                words.setdefault(word[1], file)
    if len(words) < 2:
        return ""
    others = (
        f"'{word}' in {file.path.name}{f' from {_day(file.start_ns)} on' if file.start_ns is not None else ''}"
        for word, file in list(words.items())[1:]
    )
    return f"; {with_count(others, _FILES)}"


def _each_ahead(group: Group, groups: Sequence[Group]) -> list[_Ahead] | None:
    """How far the local times of each test are ahead of the UTC of another source; None where no other tells it, or not
    of most tests."""
    of = Counter(f.path for files in group.tests.values() for f in files[:1])
    pairs = [
        (f, f.start_ns, begin, end_of(g.tests[test]))
        for g in groups
        if g is not group and not any(f.local for f in g.files)
        for test, files in group.tests.items()
        if test in g.tests
        for f in files[:1]
        if of[f.path] == 1  # that of several tests begins with none of them
        if f.start_ns is not None and (begin := begin_of(g.tests[test])) is not None
    ]
    whole = [
        _Ahead(round(h), begin, start, file.path.name, _held(file, start, begin, end) - {round(h)})
        for file, start, begin, end in pairs
        if abs((h := (start - begin) / _HOUR_NS) - round(h)) < 0.25
    ]
    if not pairs or len(whole) < 0.6 * len(pairs) or max(abs(e.hours) for e in whole) > _MOST_HOURS:
        return None
    return [replace(e, holds=frozenset(h - e.hours for h in e.holds)) for e in whole]


def _held(file: RawFile, start_ns: int, begin_ns: int, end_ns: int | None) -> frozenset[int]:
    """The numbers of hours ahead by which a local log holds all of a test."""
    last = file.sample.last_ns
    if last is None or end_ns is None:
        return frozenset()
    return frozenset(
        h
        for h in range(-_MOST_HOURS, _MOST_HOURS + 1)
        if start_ns - _NEAR_NS <= begin_ns + h * _HOUR_NS and end_ns + h * _HOUR_NS <= last + _NEAR_NS
    )


def zone_as_before(group: Group, groups: Sequence[Group], zone: str | None) -> str | None:
    """The zone that the campaign file before declared, for a source that logs local times and that nothing contradicts,
    or without dates, of whose starts it is; else None."""
    if zone is None or all(f.recording.is_undated for f in group.files):
        return zone
    if not any(f.local for f in group.files):
        return None
    each = _each_ahead(group, groups) or ()
    more = _as_well(each) if each else frozenset()
    ahead = [(_offset_h(zone, e.begin_ns), e.hours) for e in each]
    return zone if all(own is not None and (own == h or own - h in more) for own, h in ahead) else None


def _shown(hours: Collection[float]) -> str:
    return "/".join(f"{h:+g} h" for h in sorted(hours))


def _is_set_otherwise(file: RawFile) -> bool:
    """Whether a file's clock is set back by more than summer time that ends."""
    back = file.sample.set_back
    return back is not None and not back.in_no_order and likely_cause(back.from_ns, back.to_ns, file.local) is None


def _zones_of(ahead: Sequence[tuple[int, int]], likely: str, group: Group) -> str:
    """What local times tell of their zone: whether it is the one that the file names, and else which ones are so far
    ahead, for no offset tells one of them. ahead: (hours, the beginning in UTC [ns]) of each test."""
    if any(_is_set_otherwise(f) for f in group.files):
        return " where the file begins, and its clock is set back later, so that they tell no zone"
    if (named := zone_in(likely)) is not None:
        own = [_offset_h(named, begin) for _, begin in ahead]
        if own == [h for h, _ in ahead]:
            return f", as those of {named} are: {likely}"
        hours = _shown({h for h in own if h is not None})
        return f"; those of {named} were {hours} ahead then: was the clock set otherwise? {likely}"
    fitting = [z for z in _ZONES if all(_offset_h(z, begin) == h for h, begin in ahead)]
    if not fitting:
        return ": of what zone, or is the clock wrong by whole hours?"
    return f": so are {', '.join(fitting[:3])} and others, and a clock that was set otherwise"


def begin_of(files: Sequence[RawFile]) -> int | None:
    return min((f.start_ns for f in files if f.start_ns is not None), default=None)


def end_of(files: Sequence[RawFile]) -> int | None:
    return max((f.sample.last_ns for f in files if f.sample.last_ns is not None), default=None)


def _offset_h(name: str, at_ns: int) -> float | None:
    """How far a zone is ahead of UTC at a time [h]: no whole hours everywhere, as in India."""
    shift = datetime.fromtimestamp(at_ns / 1e9, UTC).astimezone(ZoneInfo(name)).utcoffset()
    return None if shift is None else shift.total_seconds() / 3600
