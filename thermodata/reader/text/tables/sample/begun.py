"""When the rows of a table began, as lines above it say: of all of it, or of each block that stands beside others."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from thermodata.reader.text.page.timed.group import heads_of_blocks
from thermodata.reader.text.preamble.begin import (
    NOT_TAKEN,
    Begin,
    FirstTimes,
    declared_start,
    find_begin,
    first_times,
    unused_start,
)
from thermodata.reader.text.preamble.titles import dated_titles
from thermodata.reader.text.preamble.together import begin_later_ns
from thermodata.reader.text.tables.sample.sampled import Sampled, still_going
from thermodata.reader.text.tables.table import TimedGroup


def begins_of_blocks(table: Sampled, above: Sequence[Sequence[str]]) -> tuple[tuple[Begin, ...], str | None]:
    """(when the rows of each block began, as what stands above its own columns says; a note where the order of day and
    month in their titles is open). None where that does not date every one of several, or what counts is declared."""
    groups, declared = table.groups, declared_start(table.said)
    if len(groups) < 2 or any(g.absolute for g in groups):
        return (), None
    heads = heads_of_blocks([g.group for g in groups], above)
    titles = dated_titles(heads, declared) if all(g.of_day for g in groups) else None
    found: list[tuple[Begin | None, str | None]] = []
    tried: list[Sequence[Sequence[Sequence[str]]]] = [heads] if declared is None else []
    for each in [*tried, *([titles] if titles is not None else [])]:
        beside = zip(groups, each, strict=True)
        found = [find_begin(head, _first_times(g, table), declared, table.where) for g, head in beside]
        begins = tuple(b for b, _ in found if b is not None)
        if found and len(begins) == len(groups) and len({b.of_day for b in begins}) == 1:
            return begins, None
    return (), next((doubt for _, doubt in found if doubt), None) if titles is not None else None


def _first_times(timed: TimedGroup, table: Sampled) -> FirstTimes:
    return first_times(
        timed.group.time, timed.group.seconds, timed.formats, still_going(table.body, timed.group, table.layout)
    )


def begin_above(table: Sampled, above: Iterable[list[str]]) -> tuple[Begin | None, str | None]:
    """(when the rows began, as a line above them says; a note where one is not taken)."""
    groups, said = table.groups, declared_start(table.said)
    if any(g.absolute for g in groups):
        return None, unused_start(said)
    timed = groups[0]
    first_rows = first_times(timed.group.time, timed.group.seconds, timed.formats, table.body)
    begin, doubt = find_begin(list(above), first_rows, said, table.where)
    if begin is None or len({g.of_day for g in groups}) == 1:
        return begin, doubt
    stands = f"'{begin.text[:60]}' stands above the rows, {NOT_TAKEN}"
    return None, f"{stands}: some columns count from a start, others tell times of day"


def on_one_clock(table: Sampled) -> tuple[TimedGroup, ...]:
    """Groups that tell times of day without a date, on the clock of the earliest."""
    groups = table.groups
    if len(groups) < 2 or not all(g.of_day for g in groups):
        return groups
    rows = [still_going(table.body, g.group, table.layout) for g in groups]
    firsts = [first_times(g.group.time, None, g.formats, own) for g, own in zip(groups, rows, strict=True)]
    return tuple(replace(g, later_ns=ns) for g, ns in zip(groups, begin_later_ns(firsts), strict=True))
