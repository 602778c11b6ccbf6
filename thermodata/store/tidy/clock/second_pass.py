"""In which pass of the hour that repeats in autumn a file was written whose local times all lie in it: what else was
recorded in the test says it, or its declared start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from thermodata.reader.text.preamble.pass_words import pass_said
from thermodata.reader.times.repeated_hour import ALL, ENDS, RepeatedHour, repeated_hour, said_by_head
from thermodata.reader.times.zone import NO_ZONE
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import first_ns, recorded, start_ns
from thermodata.store.tidy.clock.times_of_day import NEAR_NS
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan

_JOINED_NS = 600 * 10**9  # the pause between two parts of a recording


def choose_passes(plan: TestPlan) -> None:
    """Moves files that were written in a second pass into it; a problem of the plan where nothing tells the pass."""
    for source in plan.sources.values():
        zone, clock = source.spec.timezone, source.spec.clock
        if zone is None or not source.raws or clock.offset is not None or clock.align_to is not None:
            continue
        first = [r for r in source.raws if _has_note(r, ALL)]
        hour = repeated_hour(zone, min(recorded(r)[0] for r in first)) if first else None
        if hour is not None:
            told = _by_parts(source, first, hour)
            for raw, later in told:
                _take_pass(plan, source, [raw], hour, later, "the order of its files says")
            left = [r for r in first if all(r is not raw for raw, _ in told)]
            if left:
                _choose(plan, source, left, hour)
        elif not first:
            _compare_ends(plan, source, zone)


def _choose(plan: TestPlan, source: SourcePlan, raws: Sequence[RawStream], hour: RepeatedHour) -> None:
    begin, end = min(recorded(r)[0] for r in raws), max(recorded(r)[1] for r in raws)
    later, by = _later(plan, source, raws, (begin, end), hour)
    if later is None:
        starts = _starts(plan, source, raws, hour)
        first, second = (hour.written(begin if starts is None else starts, second=x) for x in (False, True))
        own, or_else = ("in the test", "") if starts is not None else ("in a test of their own", _by_offset(hour))
        plan.problems.append(
            f"test '{plan.test.id}': all local times of '{source.name}' ({raws[0].source_path}) lie in the hour that "
            f"{source.spec.timezone} repeats, and nothing says in which pass: they are taken as of the first; try: "
            f"start: {second} {own} where they are of the second, or start: {first}{or_else}"
        )
        return
    _take_pass(plan, source, raws, hour, later, by)


def _by_offset(hour: RepeatedHour) -> str:
    shift = f"{hour.shift_ns / 1e9:.15g} s"
    return f"; or, of a source that has no other files, clock: {{offset: {shift}}}, or {{offset: 0 s}}"


def _starts(plan: TestPlan, source: SourcePlan, raws: Sequence[RawStream], hour: RepeatedHour) -> int | None:
    """When a test begins, taken as of the first pass [ns], whose start tells the pass of these files; None where it
    begins with what lies in neither, for then its start is of that."""
    begin = min(recorded(r)[0] for r in raws)
    if begin > first_ns(source):
        return None
    dated = [s for s in plan.reference if s.is_dated]
    if len(dated) < len(plan.reference):
        return begin  # what has no date begins there
    begins = [(is_known(s), min(recorded(r)[0] - r.moved_ns for r in s.raws)) for s in dated]
    either = [t for known, t in begins if not known and hour.in_first(t)]
    others = [t for known, t in begins if known or not hour.in_first(t)]
    return min(either) if either and all(t >= min(either) + hour.shift_ns for t in others) else None


def _take_pass(
    plan: TestPlan, source: SourcePlan, raws: Sequence[RawStream], hour: RepeatedHour, later: bool, by: str
) -> None:
    if later:
        mine = {id(r) for r in raws}
        source.raws = [replace(r, moved_ns=hour.shift_ns) if id(r) in mine else r for r in source.raws]
    # no time of the file's own: of several files, what differs is which
    plan.notes.append(
        f"test '{plan.test.id}': all local times of '{source.name}' ({raws[0].source_path}) lie in the hour that "
        f"{source.spec.timezone} repeats: taken as of its {'second' if later else 'first'} pass, at "
        f"{hour.offset(second=later)}, as {by}"
    )


def _by_parts(source: SourcePlan, raws: Sequence[RawStream], hour: RepeatedHour) -> list[tuple[RawStream, bool]]:
    """Those of several files of a recording of which their order tells whether they are of the second pass: what comes
    before by its name ended before, and what comes behind began later."""
    if len(source.raws) < 2 or len(source.streams) > 1:
        return []
    spans = [recorded(r) for r in source.raws]
    still = [i for i, r in enumerate(source.raws) if any(r is x for x in raws)]
    known = {i: span for i, span in enumerate(spans) if i not in still}
    if not _in_order(known):
        return []
    told: dict[int, bool] = {}
    while (more := _next_told(spans, known, [i for i in still if i not in told], hour)) is not None:
        i, told[i] = more
        known[i] = _in_pass(spans[i], hour, told[i])
    left = [i for i in still if i not in told]
    if (turn := _first_of_second_pass([spans[i] for i in left], hour)) is not None:
        rest = {i: k >= turn for k, i in enumerate(left)}
        if _in_order(known | {i: _in_pass(spans[i], hour, later) for i, later in rest.items()}):
            told |= rest
    return [(source.raws[i], later) for i, later in told.items()]


def _next_told(
    spans: Sequence[tuple[int, int]], known: Mapping[int, tuple[int, int]], still: Sequence[int], hour: RepeatedHour
) -> tuple[int, bool] | None:
    """The first file for which one pass alone lies between those before and behind it."""
    for i in still:
        before = max((span[1] for k, span in known.items() if k < i), default=None)
        behind = min((span[0] for k, span in known.items() if k > i), default=None)
        passes = {later: _in_pass(spans[i], hour, later) for later in (False, True)}
        fits = [
            later
            for later, (begin, end) in passes.items()
            if (before is None or before <= begin) and (behind is None or end <= behind)
        ]
        if len(fits) == 1:
            return i, fits[0]
    return None


def _in_order(spans: Mapping[int, tuple[int, int]]) -> bool:
    """Whether each file, by its place, ended before the next began."""
    return all(a[1] <= b[0] for a, b in pairwise(spans[i] for i in sorted(spans)))


def _first_of_second_pass(spans: Sequence[tuple[int, int]], hour: RepeatedHour) -> int | None:
    """The place of the first file of the second pass, where all are of either: there alone a file begins before the end
    of the one before, and in the second pass right behind it."""
    back = [k for k, (a, b) in enumerate(pairwise(spans), 1) if b[0] < a[1]]
    if len(back) != 1 or not _joins(_in_pass(spans[back[0]], hour, True), spans[back[0] - 1]):
        return None
    return back[0]


def _in_pass(span: tuple[int, int], hour: RepeatedHour, later: bool) -> tuple[int, int]:
    moved = hour.shift_ns if later else 0
    return span[0] + moved, span[1] + moved


def _later(
    plan: TestPlan, source: SourcePlan, raws: Sequence[RawStream], span: tuple[int, int], hour: RepeatedHour
) -> tuple[bool | None, str]:
    """Whether files are of the second pass, None where nothing says it; and what does."""
    begin, end = span
    passes = {False: (begin, end), True: (begin + hour.shift_ns, end + hour.shift_ns)}
    if plan.test.start is not None and _has_offset(plan.test.start) and _starts(plan, source, raws, hour) is not None:
        declared = start_ns(plan.test.start, plan, source)
        return abs(passes[True][0] - declared) < abs(passes[False][0] - declared), "the test's start says"
    siblings = [recorded(r) for r in source.raws if r not in raws]
    joined = [k for k, (a, b) in passes.items() if any(_joins((a, b), other) for other in siblings)]
    if len(joined) == 1:
        return joined[0], "its other files join it"
    others = {s.name: [recorded(r) for r in s.raws] for s in plan.sources.values() if s is not source and is_known(s)}
    for tells in (_overlap, go_together):
        fits = [k for k, own in passes.items() if any(tells(own, x) for spans in others.values() for x in spans)]
        if len(fits) == 1:
            by = next(n for n, spans in others.items() if any(tells(passes[fits[0]], x) for x in spans))
            return fits[0], f"'{by}' says"
    words = {_by_words(r, hour, source.spec.timezone or "") for r in raws}
    return (words.pop() if len(words) == 1 else None) or (None, "")


def _by_words(raw: RawStream, hour: RepeatedHour, zone: str) -> tuple[bool, str] | None:
    """(whether a file says by its name or above its rows that it is of the second pass, how it says so); None where it
    says neither, or both."""
    by_name = pass_said([raw.source_path], hour, zone)
    by_head = next((said for note in raw.notes if (said := said_by_head(note)) is not None), None)
    found = [(said, where) for said, where in ((by_name, "name"), (by_head, "head")) if said is not None]
    if len({second for (second, _), _ in found}) != 1:
        return None
    (second, word), where = found[0]
    return second, f"'{word}' in its {where} says"


def _compare_ends(plan: TestPlan, source: SourcePlan, zone: str) -> None:
    """A log that begins with another and ends in the first pass just as much earlier as the hour lasts: its last rows
    may be of the second pass."""
    if not any(_has_note(r, ENDS) for r in source.raws):
        return
    begin, end = (f(recorded(r)[i] for r in source.raws) for i, f in enumerate((min, max)))
    hour = repeated_hour(zone, end)
    for other in plan.sources.values() if hour is not None else ():
        if other is source or hour is None or not is_known(other):
            continue
        there = (min(recorded(r)[0] for r in other.raws), max(recorded(r)[1] for r in other.raws))
        if abs(there[0] - begin) <= NEAR_NS and abs(there[1] - end - hour.shift_ns) <= NEAR_NS:
            plan.problems.append(
                f"test '{plan.test.id}': '{source.name}' begins with '{other.name}' and ends in the hour that {zone} "
                f"repeats, by as much earlier: its last rows, {hour.written(end, second=False)}, may be of the second "
                "pass; try: end the file before them, a file and a test of its own for what follows; or, where they "
                "are right, clock: {offset: 0 s} of the source"
            )


def _has_note(raw: RawStream, what: str) -> bool:
    return any(note.startswith(what) for note in raw.notes)


def is_known(source: SourcePlan) -> bool:
    """Whether its times hang on no pass, and on no zone that nobody says."""
    doubtful = any(_has_note(r, ALL) or any(NO_ZONE in n for n in r.notes) for r in source.raws)
    return bool(source.raws) and source.is_dated and not doubtful


def _has_offset(start: str) -> bool:
    from datetime import datetime

    return datetime.fromisoformat(start).tzinfo is not None


def _overlap(own: tuple[int, int], other: tuple[int, int]) -> bool:
    return own[0] <= other[1] and other[0] <= own[1]


def go_together(own: tuple[int, int], other: tuple[int, int], *, both: bool = False) -> bool:
    """Whether two logs, each (first, last), begin or end together; both: whether they do both."""
    near = [abs(a - b) <= NEAR_NS for a, b in zip(own, other, strict=True)]
    return all(near) if both else any(near)


def _joins(own: tuple[int, int], sibling: tuple[int, int]) -> bool:
    return 0 <= own[0] - sibling[1] <= _JOINED_NS or 0 <= sibling[0] - own[1] <= _JOINED_NS
