"""Local times of files over a night in which summer time begins or ends, as if clocks had not changed."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime

from thermodata.draft.files.raw_file import RawFile
from thermodata.reader.times.step_back import likely_cause

_HOUR_NS, _ROW_NS = 3_600 * 10**9, 600 * 10**9


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
