"""The hour that a zone repeats in autumn: when it is, and how its two passes are written."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta, timezone, tzinfo

from thermodata.reader.times.zone import utc_offset_ns

_HOUR_S = 3600
# begins the note on a file that tells local times and ends within a first pass, which nothing but their order proves
ENDS = "its last local time lies in the hour that repeats"
ALL = "all its local times lie in the hour that repeats"
_HEAD_SAYS = re.compile(r"; '(?P<word>.+)' in its head says the (?P<which>first|second)$")


def head_says(word: str, second: bool) -> str:
    """How the note on a file goes on whose head has a word for one pass."""
    return f"; '{word}' in its head says the {'second' if second else 'first'}"


def said_by_head(note: str) -> tuple[bool, str] | None:
    """(whether it is the second pass, the word) of such a note; None of others."""
    match = _HEAD_SAYS.search(note)
    return None if match is None else (match["which"] == "second", match["word"])


@dataclass(frozen=True, slots=True)
class RepeatedHour:
    """at_ns: when the second pass begins [ns UTC]; shift_ns: how much later than the first it is; summer_ns: how far
    local times are ahead of UTC in the first [ns]."""

    at_ns: int
    shift_ns: int
    summer_ns: int

    def in_first(self, utc_ns: int) -> bool:
        return self.at_ns - self.shift_ns <= utc_ns < self.at_ns

    def written(self, first_pass_ns: int, second: bool) -> str:
        """A time of the first pass, or the one that is written alike in the second, in ISO 8601 with its offset."""
        moment = datetime.fromtimestamp((first_pass_ns + (self.shift_ns if second else 0)) // 10**9, UTC)
        return moment.astimezone(self.offset(second)).isoformat(timespec="seconds")

    def offset(self, second: bool) -> timezone:
        """By how much local times are ahead of UTC in a pass; as a text 'UTC+02:00'."""
        return timezone(timedelta(seconds=(self.summer_ns - (self.shift_ns if second else 0)) / 1e9))

    def abbreviation(self, zone: tzinfo, second: bool) -> str | None:
        """What a zone calls its time in a pass: 'CEST', 'CET'."""
        at = self.at_ns // 10**9 - (0 if second else 1)
        return datetime.fromtimestamp(at, zone).tzname()


def repeated_hour(zone: str, utc_ns: int) -> RepeatedHour | None:
    """The hour that a zone repeats where an instant lies in its first pass; None where it lies in none."""
    s = utc_ns // 10**9
    before, later = utc_offset_ns(zone, s), utc_offset_ns(zone, s + 2 * _HOUR_S)
    if later >= before:
        return None
    low, high = s, s + 2 * _HOUR_S
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if utc_offset_ns(zone, middle) == before else (low, middle)
    found = RepeatedHour(high * 10**9, before - later, before)
    return found if found.in_first(utc_ns) else None
