"""The sources as a draft has them: files, clock, zone and encoding of each, and what is asked of it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from thermodata.draft.campaign.parts import DraftSource
from thermodata.draft.files.letters_of_files import common
from thermodata.draft.folder.beside.table import TestTable
from thermodata.draft.folder.into_sources.one_or_many import one_or_many
from thermodata.draft.folder.into_sources.packed_pieces import packed_pieces
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.folder.into_sources.two_formats import two_formats
from thermodata.draft.times.clocks import Alignment, repeats_question, set_back_question, start_question
from thermodata.draft.times.hints import hinted
from thermodata.draft.times.zone_of_start import zone_of_start_question
from thermodata.draft.times.zones import zone_as_before, zone_question
from thermodata.draft.times.zones_before import ZonesBefore


@dataclass(frozen=True, slots=True)
class BesideSource:
    """What stands beside a source. groups: all of the folder, its own among them. aligned: source -> its clock against
    another's. ignored: (path, reason) of files that are left out. before: the zones of local times that the campaign
    file before declared."""

    folder: Path
    groups: Sequence[Group]
    aligned: Mapping[str, Alignment]
    table: TestTable | None
    ignored: Sequence[tuple[str, str]]
    before: ZonesBefore
    started: Collection[str] = ()


def drafted_sources(beside: BesideSource) -> tuple[DraftSource, ...]:
    """One a group."""
    return tuple(_source(group, beside) for group in beside.groups)


def _source(group: Group, beside: BesideSource) -> DraftSource:
    zone = zone_as_before(group, beside.groups, beside.before.of(group))
    return DraftSource(
        group.source,
        group.reader,
        group.template,
        tuple(filter(None, _questions(group, beside, zone_known=bool(zone)))),
        beside.before.answered(group),
        beside.aligned.get(group.source),
        common(f.letters for f in (*group.files, *group.calibrations)),
        (*group.told, *(["timezone as in the campaign file before"] if zone else [])),
        zone,
    )


def _questions(group: Group, beside: BesideSource, *, zone_known: bool) -> Iterator[str | None]:
    yield from (hinted(a, group, beside.groups) for a in group.asks)
    if not zone_known and (asked := zone_question(group, beside.groups, beside.folder)):
        yield asked + beside.before.said()
    if not zone_known:
        yield zone_of_start_question(group, beside.groups, beside.started)
    aligned = beside.aligned.get(group.source)
    yield beside.before.dropped(group, clock=aligned is not None and aligned.offset_s is not None)
    yield from _of_clocks(group, beside)
    yield from group.questions
    yield from one_or_many(group, beside.groups, beside.table.rows if beside.table else ())
    yield two_formats(group, beside.groups, beside.folder)
    yield from packed_pieces(group, beside.ignored)


def _of_clocks(group: Group, beside: BesideSource) -> tuple[str | None, ...]:
    """Questions about when a source began, unless its clock is had from another's, times that repeat
    and a clock that was set."""
    known = group.source in beside.aligned or any(a.there == group.source for a in beside.aligned.values())
    return (
        None if known else start_question(group, beside.groups),
        repeats_question(group),
        set_back_question(group),
    )
