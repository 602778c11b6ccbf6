"""Files with local times of a night in which summer time begins or ends: what follows what, and what to ask of those
that lie in the hour that a zone repeats."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import UTC, datetime

from thermodata.draft.files.raw_file import RawFile
from thermodata.reader.times.repeated_hour import repeated_hour
from thermodata.reader.times.step_back import likely_cause
from thermodata.reader.times.zone import utc_offset_ns

_HOUR_NS, _ROW_NS = 3_600 * 10**9, 600 * 10**9


def which_pass(files: Sequence[RawFile], proposed: str) -> str:
    """How the question of a zone goes on where one of the files lies in the hour that the proposed zone repeats."""
    named = re.search(r"timezone: ([\w/+-]+)", proposed)
    for file in files if named is not None else ():
        first, last = file.sample.first_ns, file.sample.last_ns
        if named is None or not file.local or first is None or last is None:
            continue
        # read as UTC meanwhile
        ahead = utc_offset_ns(named[1], first // 10**9 - 24 * 3600)
        hour = repeated_hour(named[1], first - ahead)
        if hour is not None and hour.in_first(last - ahead):
            told = [hour.written(first - ahead, second=x) for x in (False, True)]
            return (
                f"; all times of {file.path.name} lie in the hour that this zone repeats: with it give the test its "
                f"start: {told[0]} for the first pass, {told[1]} for the second"
            )
    return ""


def on_one_clock(files: Sequence[RawFile]) -> list[tuple[int, int, bool]]:
    """(first, last time [ns], whether that is its end) of each file; of local times, in the order of their names, as if
    clocks had not changed where summer time ends in one of them or begins or ends from one to the next."""
    found: list[tuple[int, int, bool]] = []
    added = 0
    for file in files:
        first = file.start_ns or 0
        last = file.sample.last_ns or first
        if not added and file.local and found:
            end = found[-1][1]
            added = _HOUR_NS if _ends(end, first) else -_HOUR_NS if _begins(end, first) else 0
        within = file.sample.set_back
        turns = not added and file.local and within is not None and _ends(within.from_ns, within.to_ns)
        found.append((first + added, last + (_HOUR_NS if turns else added), file.sample.whole))
        added = _HOUR_NS if turns else added
    return found


def _ends(before_ns: int, at_ns: int) -> bool:
    """Whether summer time ends between two times that a local clock tells one after the other."""
    return 0 < before_ns - at_ns <= _HOUR_NS and likely_cause(before_ns, at_ns, local=True) is not None


def _begins(before_ns: int, at_ns: int) -> bool:
    """Whether summer time begins between them: on a Sunday night an hour is left out."""
    day_ns = 24 * _HOUR_NS
    at = datetime.fromtimestamp(at_ns // 10**9, UTC)
    night = at.weekday() == 6 and at.month in (3, 4, 9, 10, 11) and at_ns % day_ns < 4 * _HOUR_NS
    return night and _HOUR_NS < at_ns - before_ns <= _HOUR_NS + _ROW_NS and at_ns % _HOUR_NS < _ROW_NS
