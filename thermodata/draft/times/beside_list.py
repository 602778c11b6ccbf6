"""What a list of the tests says of when they ran, beside their logs: a log that was recorded at another time, the start
of one that has no dates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.beside.listed_times import ListedTime, to_the_minute

_NEAR_NS = 300 * 10**9  # by which whoever wrote the list looked at another clock
_LATE_NS = 12 * 3600 * 10**9  # by which a log begins behind a test of which no end is said
_HOUR_NS = 3_600_000_000_000


def not_as_listed(recordings: Mapping[str, Sequence[RawFile]], times: Mapping[str, ListedTime]) -> dict[str, list[str]]:
    """Test -> what is told of its logs whose rows lie outside of what a list says. Logs in UTC, beside a list in local
    times of which nobody knows the zone, may lie the same hours away in all tests, or one more in summer."""
    spans = {
        test: [(f, f.start_ns, f.sample.last_ns) for f in files if f.block is None and f.start_ns is not None]
        for test, files in recordings.items()
        if test in times
    }
    found: dict[str, list[str]] = {}
    for in_utc in (False, True):
        own = {
            test: [(f, a, b) for f, a, b in logs if (not f.local and not times[test].zoned) is in_utc]
            for test, logs in spans.items()
        }
        shifts = range(-14, 15) if in_utc else (0,)
        told = [_outside(own, times, hours) for hours in sorted(shifts, key=abs)]
        for test, said in min(told, key=len).items():
            found.setdefault(test, []).extend(said)
    return found


def _outside(
    logs: Mapping[str, Sequence[tuple[RawFile, int | None, int | None]]],
    times: Mapping[str, ListedTime],
    hours: int,
) -> dict[str, list[str]]:
    """Test -> what is told of its logs where times of the list are so many hours ahead of theirs, or one more."""
    found: dict[str, list[str]] = {}
    for test, own in logs.items():
        for file, first, last in own:
            more = (hours, hours + 1) if hours else (0,)
            if first is None or any(_fits(first + h * _HOUR_NS, last, h, times[test]) for h in more):
                continue
            until = "" if last is None else f" to {to_the_minute(last)}"
            found.setdefault(test, []).append(
                f"{file.path.name} runs from {to_the_minute(first)}{until}, and {times[test].said()}: a clock that is "
                "off, a wrong name, or rows of no test (window: [from, to])"
            )
    return found


def _fits(first: int, last: int | None, hours: int, listed: ListedTime) -> bool:
    if first < listed.begin_ns - _NEAR_NS:
        return False
    if listed.end_ns is None:
        return first <= listed.begin_ns + _LATE_NS
    return first <= listed.end_ns and (last is None or last + hours * _HOUR_NS <= listed.end_ns + _NEAR_NS)


def start_listed(files: Sequence[RawFile], listed: ListedTime | None) -> tuple[str | None, str]:
    """(the start of a test by a list, where no log of it has dates; what is asked of it, or of those that have none
    beside others)."""
    undated = [f for f in files if f.counts_from_ns is not None and f.block is None]
    if listed is None or not undated:
        return None, ""
    at = f"{to_the_minute(listed.begin_ns)}{'Z' if listed.zoned else ''}"
    if len(undated) == len(files):
        return at, f"start: as {listed.file} says? it is that of the first row, in the timezone of its source"
    return None, f"start: {at}, as {listed.file} says, if {undated[0].path.name} has no dates and began then"
