"""Logs that tell times of day without a date, beside logs that have dates: whether they begin when these do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta

from thermodata.reader.times.zone import utc_offset_ns
from thermodata.schema.words.sentences import with_dots

DAY_NS, _HOUR_NS = 86_400 * 10**9, 3_600 * 10**9
_SHOWN = 3
NEAR_NS = 120 * 10**9  # by how much logs that begin or end together differ


def began(of_day_ns: int, first_ns: int, timezone: str | None) -> str | None:
    """When a log whose first row tells a time of day began, on the clock of one that begins at `first_ns` (UTC), where
    that is another time: '2026-03-02 22:45:00'. None where they begin together, or by whole hours apart on clocks of
    which nobody says the zone."""
    local_ns = first_ns + (utc_offset_ns(timezone, first_ns // 10**9) if timezone is not None else 0)
    apart = apart_ns(of_day_ns, local_ns)
    if abs(apart) <= NEAR_NS or (timezone is None and hours_apart(apart)):
        return None
    moment = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=(local_ns + apart) // 1000)
    return f"{moment:%Y-%m-%d %H:%M:%S}"


def apart_ns(of_day_ns: int, there_ns: int) -> int:
    """By how much a time of day is after another, on the day on which they are nearest [ns]."""
    return (of_day_ns - there_ns + DAY_NS // 2) % DAY_NS - DAY_NS // 2


def hours_apart(ns: int) -> bool:
    """Whether what lies between two clocks [ns] is whole hours, as between those of two zones."""
    return abs(ns) > NEAR_NS and abs((ns + _HOUR_NS // 2) % _HOUR_NS - _HOUR_NS // 2) <= NEAR_NS


def first_of(of_days: Sequence[int | None]) -> int | None:
    """The time of day of the first row of a log's first part; None where a part tells none."""
    return of_days[0] if of_days and all(x is not None for x in of_days) else None


def begun_together(source: str, first_ns: Mapping[str, int]) -> str:
    """What says of a log without dates that it began with one that has them. first_ns: test -> its first time."""
    by = {test: f"{-ns / 1e9 if abs(ns) > NEAR_NS else 0:.15g} s" for test, ns in first_ns.items()}
    if len(set(by.values())) == 1:
        return f"clock: {{offset: {next(iter(by.values()))}}}"
    return with_dots([f"clocks: {{{source}: {offset}}} in {test}" for test, offset in by.items()], _SHOWN)
