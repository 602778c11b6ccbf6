"""What the relative clocks of a test count from, and what is said of logs without dates beside ones that have
them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.reader.times.step_back import in_words
from thermodata.reader.times.zone import utc_offset_ns
from thermodata.store.tidy.clock.beside import by_times_of_day
from thermodata.store.tidy.clock.source_clock import Clock, first_ns, is_relative, last_ns, names_no_zone, start_ns
from thermodata.store.tidy.clock.times_of_day import NEAR_NS, began, begun_together, first_of
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan

_NEAR_S = 60.0  # a start that a person wrote down is that exact


def bases(plan: TestPlan) -> tuple[dict[str, int], list[str]]:
    """What each source's relative clock counts from, so that a test's sources share one time line, and notes on it.

    A declared start is of the recording without dates; one whose probes have dates begins when they say.
    """
    known = [s for s in plan.sources.values() if s.raws]
    dated, undated = ([s for s in known if is_relative(s) is relative] for relative in (False, True))
    probes = [s for s in plan.reference if is_relative(s)]
    start = plan.test.start
    base_ns, notes = dict.fromkeys(plan.sources, 0), list[str]()
    if start is not None and dated and not probes:
        began = start_ns(start, plan)
        apart_s = (min(map(_first_declared, plan.reference)) - began) / 1e9
        if abs(apart_s) > _NEAR_S:
            plan.problems.append(
                f"test '{plan.test.id}': start is {start}, but its recordings have dates of their own, "
                f"{apart_s:+.0f} s from it: these count; try: take 'start' away, or set clock: {{offset: ...}}"
            )
    if not dated or (start is not None and probes):
        if start is not None:
            base_ns |= {s.name: start_ns(start, plan, s) for s in undated}
        placed, notes = by_times_of_day(plan, [s for s in undated if not _is_told(s)], base_ns)
        base_ns |= placed
        if start is not None and undated and names_no_zone(start, plan):
            notes.append(
                f"{plan.test.id}: its start names no zone, and no source declares one: taken as UTC; set timezone: of "
                "a source, or write the start with its offset: 2026-03-04 08:15+01:00"
            )
        if start is not None:
            plan.problems += _start_apart_from_dates(plan, base_ns, dated, undated)
    else:
        with_dates = [s for s in plan.reference if s in dated] or dated
        for source in undated:
            base_ns[source.name] = min(map(_first_declared, with_dates))
            moved = "" if source.spec.clock.offset is None else ", moved by its declared offset"
            notes.append(
                f"source '{source.name}' has a relative clock: taken to {_count_from(source)}{moved}; "
                "set clock: {align_to: ...} or {offset: ...} where it does not"
            )
        plan.problems += _in_doubt(plan, with_dates, [s for s in undated if not _is_told(s)])
    return base_ns, notes


def _declared_ns(source: SourcePlan) -> int:
    """By how much the campaign file moves a clock."""
    return round((source.spec.clock.offset or 0.0) * 1e9)


def _first_declared(source: SourcePlan) -> int:
    """The first time of a source on the clock that is declared of it [ns]."""
    return first_ns(source) + _declared_ns(source)


def _start_apart_from_dates(
    plan: TestPlan, base_ns: dict[str, int], dated: list[SourcePlan], undated: list[SourcePlan]
) -> list[str]:
    """A start at which nothing that has dates was recorded."""
    if not dated or not undated:
        return []
    begin = min(base_ns[s.name] + _first_declared(s) for s in undated)
    end = max(base_ns[s.name] + last_ns(s) + _declared_ns(s) for s in undated)
    first, last = min(map(_first_declared, dated)), max(last_ns(s) + _declared_ns(s) for s in dated)
    if begin <= last and first <= end:
        return []
    gap_s = (first - end if first > end else begin - last) / 1e9
    return [
        f"test '{plan.test.id}': from its start, {plan.test.start}, to its end nothing was recorded that has dates: "
        f"{', '.join(s.name for s in dated)} is {gap_s:.0f} s {'later' if first > end else 'earlier'}; try: correct "
        "'start', its time zone (timezone of the source), or the clock of the other: {offset: ...}"
        f"{_from_first(undated)}"
    ]


def _is_told(source: SourcePlan) -> bool:
    """Whether the campaign file says what its clock has to do with the others'."""
    return source.spec.clock.offset is not None or source.spec.clock.align_to is not None


def _in_doubt(plan: TestPlan, dated: list[SourcePlan], undated: list[SourcePlan]) -> list[str]:
    """Logs without a date that last longer than what has dates, or shorter: they did not begin together, or did not end
    together, and nothing says which."""
    told = {s.name: _by_its_clock(plan, dated, s) for s in undated}
    by_clock = [said for said in told.values() if said is not None]
    undated = [s for s in undated if told[s.name] is None]
    begin, end = min(map(first_ns, dated)), max(map(last_ns, dated))
    odd = [s for s in undated if _is_late(s, end - begin) or abs(end - begin - last_ns(s) + first_ns(s)) > NEAR_NS]
    if not odd:
        return by_clock
    names = ", ".join(s.name for s in odd)
    probes = any(s in plan.reference for s in odd)
    say = _start_of(plan, min(dated, key=first_ns)) if probes else "declare the source's clock: {align_to: ...}"
    late = [s for s in odd if abs(first_ns(s)) > NEAR_NS]
    taken = f"is taken to count from there, so that it begins {in_words(first_ns(late[0]))} later" if late else ""
    return [
        *by_clock,
        f"test '{plan.test.id}': nothing says when '{names}' began: it lasts "
        f"{(last_ns(odd[0]) - first_ns(odd[0])) / 3600e9:.3g} h, "
        f"what has dates {(end - begin) / 3600e9:.3g} h, and {taken or 'is taken to begin with that'}; try: {say}"
        f"{_from_first(late) if probes else ''}, or, where they did begin together, "
        f"{begun_together(odd[0].name, {plan.test.id: first_ns((late or odd)[0])})}",
    ]


def _start_of(plan: TestPlan, there: SourcePlan) -> str:
    """What gives a test of probes without dates its start; with a window, which counts from there then, where that
    begins on the clock of what has dates."""
    if plan.test.window is None:
        return "give the test its start: 2026-03-04 08:15"
    a, b = plan.test.window
    at_ns = first_ns(there) + round(a * 1e9)
    zone = there.spec.timezone
    local_ns = at_ns + (utc_offset_ns(zone, at_ns // 10**9) if zone is not None else 0)
    moment = np.datetime64(local_ns // 10**9, "s")
    return (
        f"give the test its start: {str(moment).replace('T', ' ')} where its window begins in '{there.name}', and with "
        f"it window: [0 s, {b - a:.15g} s], which counts from there then"
    )


def _is_late(source: SourcePlan, lasts_ns: int) -> bool:
    """Whether a log whose times do not begin at 0 would go on beyond the end of what has dates."""
    return first_ns(source) > NEAR_NS and last_ns(source) > lasts_ns + NEAR_NS


def _count_from(source: SourcePlan) -> str:
    if abs(first_ns(source)) <= NEAR_NS or source.spec.clock.offset is not None:
        return "start with the test"
    return f"count from the start of the test, so that its first row stands {in_words(first_ns(source))} after it"


def _from_first(undated: list[SourcePlan]) -> str:
    """What puts the first row of logs whose times do not begin at 0 where they are said to begin."""
    late = [s for s in undated if abs(first_ns(s)) > NEAR_NS and s.spec.clock.offset is None]
    return "".join(
        f", and clock: {{offset: {-first_ns(s) / 1e9:.6g} s}} for '{s.name}' counts from elsewhere" for s in late[:1]
    )


def _by_its_clock(plan: TestPlan, dated: list[SourcePlan], source: SourcePlan) -> str | None:
    """A log without a date whose times of day say that it began at another time than what has dates."""
    of_day_ns = first_of([r.of_day_ns for r in source.raws])
    there = min(dated, key=first_ns)
    zone = source.spec.timezone or there.spec.timezone
    at = None if of_day_ns is None else began(of_day_ns, first_ns(there), zone)
    if at is None:
        return None
    way = f"give the test its start: {at}" if source in plan.reference else "declare its clock: {offset: ...}"
    return (
        f"test '{plan.test.id}': '{source.name}' tells times of day without a date, and is taken to begin with "
        f"'{there.name}'; by its first row it began {at}; try: {way}, or, where they did begin together, "
        "clock: {offset: 0 s}"
    )


def tell_apart(plan: TestPlan, clocks: Mapping[str, Clock]) -> None:
    """A problem of the plan for each log without dates that by its declared clock ran while nothing with dates did, and
    a note on each with dates that ran while none of the probes did."""
    spans = {s.name: _span(s, clocks[s.name]) for s in plan.sources.values() if s.raws}
    dated = [n for n in spans if not is_relative(plan.sources[n])]
    for name, own in spans.items():
        source = plan.sources[name]
        others = [
            spans[n]
            for n in (dated if is_relative(source) else [s.name for s in plan.reference if s.name in dated])
            if n != name
        ]
        gap_ns = min((max(other[0] - own[1], own[0] - other[1]) for other in others), default=0)
        if gap_ns <= NEAR_NS or source.shared or (is_relative(source) and not _is_told(source)):
            continue
        later = own[0] > max(other[1] for other in others)
        said = f"test '{plan.test.id}': '{name}' runs {in_words(gap_ns)} {'later' if later else 'earlier'} than"
        if not is_relative(source):
            line = _line_that_moves(name, clocks[name].offset_ns + min(o[0] for o in others) - own[0])
            plan.notes.append(
                f"{said} the test, and has no sample in it: is it a file of this test, and its clock right? "
                f"{line} if they began together"
            )
            continue
        away_ns = round((source.spec.clock.offset or 0.0) * 1e9) - own[0] + min(spans[n][0] for n in dated)
        plan.problems.append(
            f"{said} all that has dates, by the clock that is declared; try: "
            f"{begun_together(name, {plan.test.id: -away_ns})} where they begin together"
        )


def _line_that_moves(source: str, by_ns: int) -> str:
    """The line that moves a log with dates. by_ns: from begin to begin, with what is declared."""
    by = f"{'-' if by_ns < 0 else ''}{in_words(by_ns)}"
    return f"clock: {{offset: {by}}} at the source '{source}', or clocks: {{{source}: {by}}} in this test alone,"


def _span(source: SourcePlan, clock: Clock) -> tuple[int, int]:
    first = first_ns(source)
    begin, end = clock.correct(np.array([first, last_ns(source)]), first)
    return int(begin), max(int(begin), int(end))
