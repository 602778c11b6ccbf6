"""Logs of one test that tell times of day without a date: each begins at its own, as ones with dates do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.reader.times.step_back import in_words
from thermodata.reader.times.zone import utc_offset_ns
from thermodata.store.tidy.clock.source_clock import first_ns, last_ns
from thermodata.store.tidy.clock.times_of_day import DAY_NS, NEAR_NS, apart_ns, first_of, hours_apart
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan

_MINUTE_NS = 60 * 10**9
_WINTER_AND_SUMMER_S = (1_767_225_600, 1_782_864_000)  # 2026-01-01 and 2026-07-01, where nothing says the date


@dataclass(frozen=True, slots=True)
class _Log:
    """A log by the time of day of its first row [ns]. first_ns: that row on its own clock; base_ns: what that clock
    counts from; zone: None where nobody says one."""

    name: str
    of_day_ns: int
    first_ns: int
    lasts_ns: int
    base_ns: int
    zone: str | None

    @property
    def near_zero(self) -> bool:
        return self.of_day_ns < _MINUTE_NS

    @property
    def called(self) -> str:
        return f"'{self.name}'" if self.name else "the start of the test"


def by_times_of_day(
    plan: TestPlan, logs: list[SourcePlan], base_ns: Mapping[str, int]
) -> tuple[dict[str, int], list[str]]:
    """What the clocks of logs count from that tell times of day, source -> [ns], and notes; what leaves one open is a
    problem of the plan.

    They are put beside the first of the probes' logs that tells times of day, else the declared start of the test,
    else the first of them. base_ns: what the clock of each source counts from by itself.
    """
    zone = next((s.spec.timezone for s in [*plan.reference, *plan.sources.values()] if s.spec.timezone), None)
    told = {s.name: log for s in logs if (log := _log(s, base_ns[s.name], zone)) is not None}
    there = next((told[s.name] for s in plan.reference if s.name in told), None) or _start(plan, base_ns, zone)
    if there is None and told:
        there = next(iter(told.values()))
    moved, notes = dict[str, int](), list[str]()
    for here in told.values():
        if there is None or here.name == there.name:
            continue
        if here.near_zero != there.near_zero:
            plan.problems += [_durations(plan, here, there)] if there.name else []
            continue
        by_ns, doubt = _begins_after_ns(here, there)
        moved[here.name] = there.base_ns + there.first_ns + by_ns - here.first_ns
        side = "after" if by_ns >= 0 else "before"
        said = f"'{here.name}' begins {in_words(by_ns)} {side} {there.called} by its times of day, which have no date"
        together = f"set clock: {{offset: 0 s}} of '{here.name}' where they began together"
        if doubt is not None:
            plan.problems.append(f"test '{plan.test.id}': {said}, {doubt}, or {together}")
        elif abs(by_ns) > NEAR_NS:
            notes.append(f"source {said}; {together}")
    return moved, notes


def _durations(plan: TestPlan, here: _Log, there: _Log) -> str:
    """What to ask where one log begins at midnight, as durations do that are written like times of day."""
    by_s = (here.of_day_ns - there.of_day_ns) / 1e9
    return (
        f"test '{plan.test.id}': '{(here if here.near_zero else there).name}' begins at 0:00, which is midnight or the "
        f"start of its recording, and is taken to begin with '{(there if here.near_zero else here).name}'; try: clock: "
        f"{{offset: 0 s}} of '{here.name}' where it does, or {{offset: {by_s:.15g} s}} where both tell times of day"
    )


def _log(source: SourcePlan, base_ns: int, zone: str | None) -> _Log | None:
    # of the row at 0, which in a file newest first is the last
    of_day_ns = first_of([r.of_day_ns for r in source.raws])
    if of_day_ns is None:
        return None
    first = first_ns(source)
    own = source.spec.timezone or zone
    return _Log(source.name, of_day_ns + first, first, last_ns(source) - first, base_ns, own)


def _start(plan: TestPlan, base_ns: Mapping[str, int], zone: str | None) -> _Log | None:
    """The declared start of a test, as a log that begins there and lasts as long as its probes."""
    if plan.test.start is None or not plan.reference:
        return None
    probes = plan.reference[0]
    base, own = base_ns[probes.name], probes.spec.timezone or zone
    first = first_ns(probes)
    return _Log("", (base + _ahead_ns(own, base // 10**9)) % DAY_NS, 0, last_ns(probes) - first, base, own)


def _begins_after_ns(here: _Log, there: _Log) -> tuple[int, str | None]:
    """By how much a log begins after another [ns], on the day on which they run together longest, and what leaves that
    open."""
    moments = [there.base_ns // 10**9] if there.base_ns else _WINTER_AND_SUMMER_S
    zones = {_ahead_ns(here.zone, s) - _ahead_ns(there.zone, s) for s in moments}
    near_ns = apart_ns(here.of_day_ns - min(zones), there.of_day_ns)
    days = sorted((near_ns + k * DAY_NS for k in (-1, 0, 1)), key=abs)
    longest = max(_together_ns(here, there, by) for by in days)
    fits = [by for by in days if _together_ns(here, there, by) >= longest - NEAR_NS]
    if len(zones) > 1:
        doubt = f"and its zone, {here.zone}, is not always as far from {there.zone}; try: give the test its start"
    elif longest > 0 and len(fits) > 1:
        doubt = "and runs with it on another day as well; try: clock: {offset: ...} of it"
    elif here.zone is None and hours_apart(fits[0]):
        doubt = "which may be the zones of two clocks; try: timezone: Europe/Prague at both where they show one time"
    else:
        doubt = None
    return fits[0], doubt


def _together_ns(here: _Log, there: _Log, by_ns: int) -> int:
    """How long both run, where one begins that much after the other [ns]."""
    return max(0, min(by_ns + here.lasts_ns, there.lasts_ns) - max(by_ns, 0))


def _ahead_ns(zone: str | None, at_s: int) -> int:
    return utc_offset_ns(zone, at_s) if zone is not None else 0
