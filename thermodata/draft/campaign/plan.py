"""The draft of a campaign from what its folder holds: sources, channels, calibrations, tests, and what is asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from thermodata.draft.campaign.among_channels.asked_once import asked_once
from thermodata.draft.campaign.among_channels.by_hand import asked_whether_held
from thermodata.draft.campaign.among_channels.feeds_of_positions import feeds_of_positions
from thermodata.draft.campaign.among_channels.other_units_in_tests import own_calibrations
from thermodata.draft.campaign.among_channels.renamed import with_renamed_asked
from thermodata.draft.campaign.among_channels.siblings import beside_each_other
from thermodata.draft.campaign.among_channels.speeds_told import with_told_speeds
from thermodata.draft.campaign.channels.channels import channels_of
from thermodata.draft.campaign.drafted_sources import BesideSource, drafted_sources
from thermodata.draft.campaign.drafted_tests import drafted_tests
from thermodata.draft.campaign.files_apart import files_apart
from thermodata.draft.campaign.hardly_looked_at import hardly_looked_at
from thermodata.draft.campaign.jumps.jump_sources import with_their_sources
from thermodata.draft.campaign.jumps.jumps_used import idle_jumps, jumps_of
from thermodata.draft.campaign.parts import Draft, DraftChannel, DraftJump
from thermodata.draft.campaign.two_campaigns import campaigns_in
from thermodata.draft.folder.beside.clock_said import clocks_said
from thermodata.draft.folder.beside.notes import described_in
from thermodata.draft.folder.beside.table import TestTable, closed_workbooks, find_table
from thermodata.draft.folder.into_sources.one_signal import joined_over_units
from thermodata.draft.folder.into_sources.sources import Group, sources_of
from thermodata.draft.folder.into_tests.group import counted_on, tests_of
from thermodata.draft.folder.scan import Scan
from thermodata.draft.probes.jumps import JumpTest
from thermodata.draft.probes.same_probe import names_in_tests, with_their_probes
from thermodata.draft.times.clocks import Named, alignments, mended_clocks
from thermodata.draft.times.named_days import over_midnight
from thermodata.draft.times.zones_before import ZonesBefore

NO_ZONES = ZonesBefore()


def plan(campaign: str, folder: Path, found: Scan, before: ZonesBefore = NO_ZONES) -> Draft:
    """What the folder holds, as a campaign. before: the zones of local times that the campaign file before declared."""
    sorted_out = files_apart(folder, found)
    found = sorted_out.scan
    jumps = jumps_of(found.logs)
    ignored = [path for path, _ in found.ignored]
    groups, joined = over_midnight(tests_of(sources_of(found.logs, [j.file for j in jumps]), ignored))
    of_probes = with_their_probes(jumps, groups)
    table = find_table(folder, found.others, list(dict.fromkeys(t for g in groups for t in g.tests)))
    of_groups = _channels(groups, of_probes)
    keyed = of_groups.keyed
    aligned = {a.source: a for a in alignments(groups, keyed)}
    tests = drafted_tests(folder, groups, table, keyed, sorted_out.texts, aligned)
    started = [t.id for t in tests if t.kind.start is not None and datetime.fromisoformat(t.kind.start).tzinfo is None]
    beside = BesideSource(folder, groups, aligned, table, found.ignored, before, started)
    own = own_calibrations(groups, keyed, of_groups.channels, of_groups.calibrations)
    tests = tuple(replace(t, channels=own.get(t.id, {})) for t in tests)
    sources = asked_once(drafted_sources(beside), groups)
    campaigns = campaigns_in(folder, groups)
    if not campaigns.certain:
        sources = with_renamed_asked(sources, groups, of_groups.channels)
    jumps_drafted, every_source = with_their_sources(of_groups.calibrations, sources)
    idle = idle_jumps(jumps, of_probes, of_groups.calibrations, found.logs, groups)
    left_out = (*_but_of(table, found.ignored), *sorted_out.unread, *idle)
    read = {str(f.path) for f in found.logs} - {path for path, _ in idle}  # of a workbook some sheets may be left out
    return Draft(
        campaign,
        tuple(every_source),
        tuple(of_groups.channels),
        tuple(jumps_drafted),
        tests,
        table,
        left_out,
        found.damaged,
        (
            *counted_on(groups),
            *joined,
            *sorted_out.through_tests,
            *mended_clocks(groups),
            *sorted_out.legends,
            *clocks_said(folder, described_in(folder, sorted_out.texts)),
            *of_groups.notes,
            *closed_workbooks(found.others),
            *hardly_looked_at(found.logs),
        ),
        _but_of(table, found.failed),
        tuple(dict.fromkeys(path for path, _ in left_out if path not in read)),
        feeds_of_positions(of_groups.channels, groups),
        campaigns,
    )


def _but_of(table: TestTable | None, files: Sequence[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """(path, reason) of files, without the table of tests."""
    return tuple(file for file in files if table is None or file[0] != table.file)


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
