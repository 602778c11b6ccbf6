"""The draft of a campaign from what its folder holds: sources, channels, calibrations, tests, and what is asked."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from thermodata.draft.campaign.asked_once import asked_once
from thermodata.draft.campaign.by_hand import asked_whether_held
from thermodata.draft.campaign.channels import channels_of
from thermodata.draft.campaign.jump_sources import with_their_sources
from thermodata.draft.campaign.one_test import drafted_test
from thermodata.draft.campaign.orientation import why_idle
from thermodata.draft.campaign.parts import Draft, DraftChannel, DraftJump, DraftSource
from thermodata.draft.campaign.siblings import beside_each_other
from thermodata.draft.campaign.speeds_told import with_told_speeds
from thermodata.draft.courses.warm import warm_starts
from thermodata.draft.files.letters_of_files import common
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.by_listed_times import parted_by_lists
from thermodata.draft.folder.clock_said import clocks_said
from thermodata.draft.folder.file_copies import other_versions
from thermodata.draft.folder.group import counted_on, tests_of
from thermodata.draft.folder.legend import with_legends
from thermodata.draft.folder.lists_of_tests import lists_apart, times_listed
from thermodata.draft.folder.notes import described_in, notes_of
from thermodata.draft.folder.one_or_many import one_or_many
from thermodata.draft.folder.one_signal import joined_over_units
from thermodata.draft.folder.packed_pieces import packed_pieces
from thermodata.draft.folder.saved_twice import saved_once
from thermodata.draft.folder.scan import Scan
from thermodata.draft.folder.sensor_files import with_their_sensors
from thermodata.draft.folder.sensors_described import with_sensors_described
from thermodata.draft.folder.sources import Group, sources_of
from thermodata.draft.folder.table import TestTable, closed_workbooks, find_table, is_called_table, most_rows
from thermodata.draft.probes.jumps import JumpTest, jump_of
from thermodata.draft.probes.same_probe import names_in_tests, with_their_probes
from thermodata.draft.probes.twin_probes import each_its_own
from thermodata.draft.times.beside_list import not_as_listed
from thermodata.draft.times.clocks import (
    Alignment,
    Named,
    alignments,
    mended_clocks,
    repeats_question,
    set_back_question,
    start_question,
)
from thermodata.draft.times.date_order import with_orders_told
from thermodata.draft.times.hints import hinted
from thermodata.draft.times.named_days import over_midnight
from thermodata.draft.times.zones import zone_as_before, zone_question
from thermodata.draft.times.zones_before import ZonesBefore
from thermodata.schema.words.sentences import counted

NO_ZONES = ZonesBefore()


def plan(campaign: str, folder: Path, found: Scan, before: ZonesBefore = NO_ZONES) -> Draft:
    """What the folder holds, as a campaign. before: the zones of local times that the campaign file before declared."""
    found, beside = _table_apart(folder, found)
    found = saved_once(lists_apart(folder, found))
    logs, through = parted_by_lists(found.logs, [times_listed(folder, p) for p in found.others])
    found = replace(found, logs=logs)
    found = replace(found, logs=with_their_sensors(with_orders_told(folder, found.logs)))
    texts = [p for p, _ in found.ignored]  # one that says what signals are may say what tests are, too
    found, described = with_sensors_described(folder, found)
    found, legends = with_legends(folder, found)
    legends = [*described, *legends]
    beside = [x for x in beside if not any(told.startswith(f"{x[0]} says") for told in legends)]
    recorded = [j for f in found.logs if (j := jump_of(f)) is not None and (j.named or _short(j, found.logs))]
    jumps = each_its_own(recorded)
    groups, joined = over_midnight(
        tests_of(sources_of(found.logs, [j.file for j in jumps]), [p for p, _ in found.ignored])
    )
    of_probes = with_their_probes(jumps, groups)
    ids = list(dict.fromkeys(t for g in groups for t in g.tests))
    table = find_table(folder, found.others, ids)
    of_groups = _channels(groups, of_probes)
    calibrations, keyed = of_groups.calibrations, of_groups.keyed
    sources = asked_once(_sources(folder, groups, keyed, table, found, before), groups)
    jumps_drafted, every_source = with_their_sources(calibrations, sources)
    named = {id(f): keyed[g.source] for g in groups for f in (*g.files, *(x for own in g.tests.values() for x in own))}
    versions = {t: v for g in groups for t, v in other_versions(g.tests).items()}
    recordings = {t: [f for g in groups for f in g.tests.get(t, ())] for t in ids}
    notes = notes_of(folder, [p for p in texts if table is None or p != table.file], recordings)
    warm = warm_starts(recordings, named)
    otherwise = not_as_listed(recordings, table.times if table else {})
    used = {j.file for j in calibrations}
    idle = [str(j.file.path) for j in jumps if str(j.file.path) not in used]
    known = [j for of_source in of_probes.values() for j in of_source]
    left_out = (
        *(x for x in found.ignored if table is None or x[0] != table.file),
        *beside,
        *((p, why_idle(p, known, calibrations, _behind(p, calibrations, found, groups))) for p in idle),
    )
    read = {str(f.path) for f in found.logs} - set(idle)  # of a workbook some sheets may be left out
    return Draft(
        campaign,
        tuple(every_source),
        tuple(of_groups.channels),
        tuple(jumps_drafted),
        tuple(
            drafted_test(t, groups, table, named, warm.get(t), versions.get(t), notes.get(t), otherwise.get(t, ()))
            for t in ids
        ),
        table,
        left_out,
        found.damaged,
        (
            *counted_on(groups),
            *joined,
            *through,
            *mended_clocks(groups),
            *legends,
            *clocks_said(folder, described_in(folder, texts)),
            *of_groups.notes,
            *closed_workbooks(found.others),
            *_hardly_looked_at(found.logs),
        ),
        tuple(x for x in found.failed if table is None or x[0] != table.file),
        tuple(dict.fromkeys(path for path, _ in left_out if path not in read)),
    )


def _table_apart(folder: Path, found: Scan) -> tuple[Scan, list[tuple[str, str]]]:
    """(what was found, a table of tests that a reader takes for a log among the others; its sheets that are not read,
    with why)."""
    early = _claimed_table(folder, found)
    if early is None:
        return found, []
    own = next(f for f in found.logs if str(f.path) == early)
    unread = [(early, f"its {note}") for note in own.recording.notes if re.match(r"sheet '.*' is not read", note)]
    logs = tuple(f for f in found.logs if str(f.path) != early)
    return replace(found, logs=logs, others=(*found.others, early)), unread


@dataclass(frozen=True, slots=True)
class _Channels:
    """Of all sources. keyed: source -> its channels, by (stream, signal) of the files."""

    channels: list[DraftChannel]
    calibrations: list[DraftJump]
    keyed: dict[str, Named]
    notes: list[str]


def _channels(groups: Sequence[Group], of_probes: Mapping[str, Sequence[JumpTest]]) -> _Channels:
    """of_probes: source -> the jump tests of its probes."""
    found = _Channels([], [], {}, [])
    in_tests = names_in_tests(groups)
    for g in groups:
        of_source = channels_of(g, of_probes[g.source], in_tests, {c.name.lower() for c in found.channels})
        made = asked_whether_held(beside_each_other(with_told_speeds(of_source.channels, g)), g, groups)
        found.channels.extend(made)
        found.calibrations.extend(of_source.calibrations)
        found.notes.extend(of_source.notes)
        found.keyed[g.source] = _keyed(
            g, {(c.stream or "", c.signal): (c.said.quantity, c.said.at, c.name) for c in made if c.said.quantity}
        )
    return found


def _sources(
    folder: Path,
    groups: Sequence[Group],
    keyed: Mapping[str, Named],
    table: TestTable | None,
    found: Scan,
    before: ZonesBefore,
) -> tuple[DraftSource, ...]:
    aligned = {a.source: a for a in alignments(groups, keyed)}
    zones = {g.source: zone_as_before(g, groups, before.of(g)) for g in groups}

    def told(group: Group) -> tuple[str, ...]:
        return (*group.told, *(["timezone as in the campaign file before"] if zones[group.source] else []))

    return tuple(
        DraftSource(
            g.source,
            g.reader,
            g.template,
            tuple(
                filter(None, _questions(folder, g, groups, aligned, table, found, None if zones[g.source] else before))
            ),
            g.table,
            aligned.get(g.source),
            common(f.letters for f in (*g.files, *g.calibrations)),
            told(g),
            zones[g.source],
        )
        for g in groups
    )


def _hardly_looked_at(logs: Sequence[RawFile]) -> Iterator[str]:
    """What is told of files for which there was no time, or not enough."""
    if like := [f for f in logs if f.like]:
        yield (
            f"{counted(len(like), 'file', 'was', 'were')} not opened (the folder's time was up): taken to be like "
            f"others of their name, e.g. {like[0].path} like {like[0].like}"
        )
    if unseen := [f for f in logs if not (f.like or f.sample.whole or f.sample.rows or f.sample.losses)]:
        yield (
            f"{counted(len(unseen), 'file', 'was', 'were')} opened, and no values looked at (the folder's time was "
            f"up): their tests are drafted from their names alone, e.g. {unseen[0].path}; check these lines"
        )
    if hurried := [f for f in logs if f.sample.hurried]:
        yield (
            f"{counted(len(hurried), 'file', 'was', 'were')} looked at in the first rows only (the time for each was "
            f"up): what their tests did later is not in this draft, e.g. {hurried[0].path} after "
            f"{counted(hurried[0].sample.rows, 'row')}; check these lines"
        )


def _behind(path: str, used: Sequence[DraftJump], found: Scan, groups: Sequence[Group]) -> list[str]:
    """The tests that were recorded after a jump test, where those that are used were before it."""
    began = {str(f.path): f.start_ns for f in found.logs}
    own, others = began.get(path), [began.get(j.file) for j in used]
    if own is None or any(o is None or o >= own for o in others):
        return []
    tests = {t: [f.start_ns for f in fs if f.start_ns is not None] for g in groups for t, fs in g.tests.items()}
    return [t for t, starts in tests.items() if starts and min(starts) > own]


def _claimed_table(folder: Path, found: Scan) -> str | None:
    """A table of tests that a reader takes for a log, because it has a column of dates; what holds long logs is none,
    though a sheet beside them lists the tests."""
    most = most_rows(len(found.logs))
    small = [str(f.path) for f in found.logs if f.size < 200_000 and f.part is None and f.sample.rows <= most]
    called = [p for p in small if is_called_table(p)]
    jumps = [j.file for f in found.logs if (j := jump_of(f)) is not None and j.named]
    logs = [f for f in found.logs if str(f.path) not in called]
    holding = [(t, fs) for g in tests_of(sources_of(logs, jumps), ()) for t, fs in g.tests.items()]
    for candidates, by_number in ((called, True), ([p for p in small if p not in called], False)):
        for candidate in candidates[:20]:
            ids = list(dict.fromkeys(t for t, fs in holding if any(str(f.path) != candidate for f in fs)))
            stems = [f.path.stem for f in logs if str(f.path) != candidate]
            if any(find_table(folder, [candidate], names, by_number) for names in (ids, stems)):
                return candidate
    return None


def _keyed(
    group: Group, named: dict[tuple[str, str], tuple[str, str | None, str]]
) -> dict[tuple[str, str], tuple[str, str | None, str]]:
    """The channels by (stream, signal) of the files, whatever the campaign file calls them."""
    plain = {signal.split(":", 1)[-1] if stream else signal: value for (stream, signal), value in named.items()}
    return {
        (s.stream, s.name): named.get((s.stream, f"{s.stream}:{one.written}")) or plain[one.written]
        for one in joined_over_units(group.signals)
        for s in one.spellings
        if one.written in plain
    }


def _short(jump: JumpTest, files: Sequence[RawFile]) -> bool:
    """Whether a recording that nobody calls a jump test is far shorter than the tests, as one is."""
    spans = sorted((f.sample.last_ns or 0) - (f.sample.first_ns or 0) for f in files if f is not jump.file)
    own = (jump.file.sample.last_ns or 0) - (jump.file.sample.first_ns or 0)
    return bool(spans) and own * 3 < spans[len(spans) // 2]


def _questions(
    folder: Path,
    group: Group,
    groups: Sequence[Group],
    aligned: Mapping[str, Alignment],
    table: TestTable | None,
    found: Scan,
    before: ZonesBefore | None,
) -> Iterator[str | None]:
    """What is asked of a source. before: the zones that were declared; None where its own is known."""
    yield from (hinted(a, group, groups) for a in group.asks)
    if before is not None and (asked := zone_question(group, groups, folder)):
        yield asked + before.said()
    yield from _of_clocks(group, groups, aligned)
    yield from group.questions
    yield from one_or_many(group, groups, table.rows if table else ())
    yield from packed_pieces(group, found.ignored)


def _of_clocks(group: Group, groups: Sequence[Group], aligned: Mapping[str, Alignment]) -> tuple[str | None, ...]:
    """Questions about when a source began, unless its clock is had from another's, times that repeat
    and a clock that was set."""
    known = group.source in aligned or any(a.there == group.source for a in aligned.values())
    return (
        None if known else start_question(group, groups),
        repeats_question(group),
        set_back_question(group),
    )
