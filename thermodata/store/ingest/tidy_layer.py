"""Makes the tidy files of a campaign's tests, those that are not there yet, and the catalogue's rows of all."""

from __future__ import annotations

import dataclasses
import errno
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from thermodata.calibration.result import CalibrationResult
from thermodata.errors import SpecError, StoreError, ThermodataError
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.words.places import is_around, is_powered
from thermodata.store.base.files import is_whole, key_of
from thermodata.store.ingest import catalogue_rows
from thermodata.store.ingest.known.inventory import BY_TEST, Inventory, Row, meta_of
from thermodata.store.ingest.known.left_alone import LeftAlone, TestNote, columns_of, estimated
from thermodata.store.ingest.tidy_rows import StreamOfTest, count, duration_s, step_s, tidy_rows
from thermodata.store.ingest.told.channels.empty_channels import empty_channels
from thermodata.store.ingest.told.channels.jumps_inside import tell_jumps_inside
from thermodata.store.ingest.told.channels.other_heads import head_of, other_heads
from thermodata.store.ingest.told.channels.other_units import other_units
from thermodata.store.ingest.told.declared.beyond_the_end import beyond_the_end
from thermodata.store.ingest.told.losses import Losses, loss_row
from thermodata.store.tidy.clock.cut_short import cut_short
from thermodata.store.tidy.clock.lent import dated_sources, lent
from thermodata.store.tidy.clock.source_clock import Clock, Span, span
from thermodata.store.tidy.clock_offsets import clocks_of
from thermodata.store.tidy.flags.beside.between import Verdict, verdicts
from thermodata.store.tidy.flags.event import event_of
from thermodata.store.tidy.flags.overrule import idle, met
from thermodata.store.tidy.keys import ChannelTexts, member_key
from thermodata.store.tidy.plan.plan import SCHEDULE, TestPlan
from thermodata.store.tidy.plan.unscaled import tell_unscaled
from thermodata.store.tidy.values.series import Member, TestSeries
from thermodata.store.tidy.writer import write_member

Columns = list[tuple[str, bool]]


@dataclass(slots=True)
class TidyLayer:
    """What a campaign's tidy layer is and lost. rows: table -> test -> the catalogue's rows; tests: what is told of
    each; both of the tests that were looked at. notes, losses: what concerns no one test, or shows beside others.
    new_streams: made now.
    """

    rows: dict[str, dict[str, list[Row]]] = field(default_factory=lambda: {t: {} for t in BY_TEST})
    tests: dict[str, TestNote] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    losses: Losses = field(default_factory=list)
    new_streams: int = 0


@dataclass(slots=True)
class _Tidied:
    """A test whose streams are tidied: member -> the rows of its tidy files, and of its quality events."""

    plan: TestPlan
    clocks: dict[str, Clock]
    where: Span
    files: dict[Member, list[Row]] = field(default_factory=dict)
    events: dict[Member, list[Row]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Making:
    """What the streams of an ingest are made with. store: its folder; inventory: what that holds; now: of the ingest;
    say: tells how far it is."""

    store: Path
    calibrations: Mapping[str, CalibrationResult]
    inventory: Inventory
    now: datetime
    say: Callable[[str], None]


def tidy_tests(making: Making, campaign: Campaign, plans: Sequence[TestPlan], left: LeftAlone) -> TidyLayer:
    """Tidies every stream of every planned test that isn't there under its content key.

    A sensor that failed between two tests, and a foreign part, show only once all are tidied; the streams that they
    spoil are made again. left: the tests that are not planned; OtherwiseError where what comes of the others changes
    any of them.
    """
    layer = TidyLayer(tests={p.test.id: _begun(p) for p in plans})
    known = {t.id: layer.tests.get(t.id) or left.tests[t.id] for t in campaign.tests}
    left.hold_beside(layer.tests)
    tidier = _Tidier(making, _columns(campaign, known), layer, ChannelTexts(making.calibrations))
    clocks = {name: note.own_clocks() for name, note in left.tests.items()}
    for plan in plans:
        with _loss_where_it_fails(layer, plan):
            own = clocks[plan.test.id] = clocks_of(making.store, plan, making.calibrations, making.inventory.clocks)
            layer.tests[plan.test.id].clocks = estimated(own)
    clocks = lent(clocks, {name: note.dated for name, note in known.items()})
    tidied: dict[str, _Tidied] = {}
    for plan in plans:
        if plan.test.id in clocks:
            with _loss_where_it_fails(layer, plan):
                tidied[plan.test.id] = tidier.tidy(plan, clocks[plan.test.id])
                _note_courses(layer.tests[plan.test.id], tidied[plan.test.id])
    levels = [x for name, note in known.items() if (x := note.levels(name)) is not None]
    found = verdicts(levels)
    left.stand(clocks, found)
    for plan in plans:
        test, note = tidied.get(plan.test.id), layer.tests[plan.test.id]
        if test is not None:
            with _loss_where_it_fails(layer, plan):
                tidier.mark(test, found.get(plan.test.id, Verdict()))
                _add_rows(layer, test, making)
                _note_courses(note, test)
                _note_verdicts(note, test)
                tell_jumps_inside(plan, test.where, test.clocks, making.calibrations)
            tell_unscaled(making.store, plan)
            note.overruled = met(campaign.overrule, [event_of(r) for rows in test.events.values() for r in rows])
        note.losses += [loss_row(p, test=plan.test.id) for p in plan.problems]
        note.notes += plan.notes
    layer.losses += empty_channels(campaign, known)
    layer.losses += other_units([x for x, _ in levels])
    layer.losses += other_heads(known)
    layer.notes += idle(campaign.overrule, {name: note.overruled for name, note in known.items() if note.tidied})
    return layer


def _begun(plan: TestPlan) -> TestNote:
    """What is told of a test before it is tidied."""
    sources = [s for s in plan.sources.values() if s.raws]
    return TestNote(
        files=list(dict.fromkeys(r.source_path for s in sources for r in s.raws)),
        sources=[s.name for s in sources],
        lossy=list(dict.fromkeys(r.key for s in sources for r in s.raws if r.losses)),
        channels=[[b.source, b.stream, b.name, b.is_text] for b in plan.bound.values()],
        dated=dated_sources(plan),
        warm=plan.test.start_state == "warm",
        heads={n: [b.unit, head] for n, b in plan.bound.items() if b.unit and (head := head_of(b.signal))},
    )


def _note_courses(note: TestNote, test: _Tidied) -> None:
    """What the other tests want to know of a test's channels."""
    note.tidied = True
    note.lent = estimated(test.clocks)
    note.start_s = None if test.where.relative else test.where.zero_ns / 1e9
    files = [(r["part"], meta_of(r)) for rows in test.files.values() for r in rows]
    note.empty = _empty(test)
    note.courses = [[meta["to_s"], meta.get("levels")] for part, meta in files if part == "test"]
    named = {name for _, levels in note.courses if levels for name in levels["values"]}
    own = {name: b.channel for name, b in test.plan.bound.items() if name in named}
    note.quantities = {name: channel.quantity for name, channel in own.items()}
    note.powered = [name for name, channel in own.items() if is_powered(channel.at)]
    note.around = [name for name, channel in own.items() if not channel.at or is_around(channel.at)]


def _empty(test: _Tidied) -> list[list[str]]:
    """[source, stream, name] of each channel without a value in a test."""
    return [
        [source, stream, b.name]
        for (source, stream), rows in test.files.items()
        for meta in map(meta_of, rows)
        for b in test.plan.bound.values()
        if "filled" in meta and (b.source, b.stream) == (source, stream) and b.name not in meta["filled"]
    ]


def _note_verdicts(note: TestNote, test: _Tidied) -> None:
    """What was made with which verdict in mind."""
    for rows in test.files.values():
        meta = [meta_of(r) for r in rows]
        channels = [c for m in meta for c in m["channels"]]
        note.verdicts.append([channels, next((m["verdict"] for m in meta if "verdict" in m), {})])


@contextmanager
def _loss_where_it_fails(layer: TidyLayer, plan: TestPlan) -> Iterator[None]:
    """A test that can't be made is a loss; the others go on."""
    try:
        yield
    except (StoreError, SpecError):
        raise
    except ThermodataError as error:
        layer.tests[plan.test.id].losses.append(loss_row("; ".join(str(error).splitlines()), test=plan.test.id))


def _columns(campaign: Campaign, tests: Mapping[str, TestNote]) -> dict[Member, Columns]:
    """The channels of each (source, stream) over all tests, in the campaign's order."""
    order = {name: i for i, name in enumerate(campaign.channels)}
    found = columns_of(note.channels for note in tests.values())
    return {m: sorted(c.items(), key=lambda item: order[item[0]]) for m, c in found.items()}


@dataclass(frozen=True, slots=True)
class _Tidier:
    making: Making
    columns: Mapping[Member, Columns]
    layer: TidyLayer
    texts: ChannelTexts

    def tidy(self, plan: TestPlan, clocks: dict[str, Clock]) -> _Tidied:
        """Every stream of a test, kept where the store has it already. clocks: of its sources."""
        test = _Tidied(plan, clocks, span(plan, clocks))
        plan.notes.extend(said for said in cut_short(plan, clocks) if said not in plan.notes)
        series = self._series(test)
        for member in plan.members():
            if member[0] == SCHEDULE and not any(s.raws for s in plan.sources.values()):
                continue
            base = self._base(test, member)
            kept = self.making.inventory.tidy(plan.test.id, base)
            if kept and all(_kept_alive(os.path.join(self.making.store, row["path"]), row["bytes"]) for row in kept):
                test.files[member] = kept
                test.events[member] = [
                    r
                    for r in self.making.inventory.rows["quality_event"].get(plan.test.id, [])
                    if (r["source"], r["stream"]) == member
                ]
            else:
                self._write(test, series, member, base, Verdict())
        return test

    def mark(self, test: _Tidied, verdict: Verdict) -> None:
        """Makes those streams again whose files were made with another verdict in mind."""
        series = None
        for member, rows in test.files.items():
            meta = [meta_of(r) for r in rows]
            wanted = verdict.of(c for m in meta for c in m["channels"])
            if wanted.to_json() != next((m["verdict"] for m in meta if "verdict" in m), {}):
                series = series or self._series(test)
                self._write(test, series, member, self._base(test, member), wanted)

    def _series(self, test: _Tidied) -> TestSeries:
        return TestSeries(self.making.store, test.plan, test.clocks, test.where, self.making.calibrations)

    def _base(self, test: _Tidied, member: Member) -> str:
        return member_key(test.plan, member, self.columns[member], test.clocks, test.where, self.texts)

    def _write(self, test: _Tidied, series: TestSeries, member: Member, base: str, verdict: Verdict) -> None:
        making, name = self.making, test.plan.test.id
        making.say(f"{name}: {member[0]}/{member[1]}")
        said = verdict.to_json()
        key = key_of(base, json.dumps(said, sort_keys=True)) if said else base
        result = write_member(series, member, self.columns[member], key, verdict)
        if not result.files:  # told here, for no file is there to keep it
            self.layer.tests[name].losses += [loss_row(p, test=name, source=member[0]) for p in result.problems]
            test.files[member] = test.events[member] = []
            return
        self.layer.new_streams += 1
        of = StreamOfTest(test.plan.campaign.id, name, *member)
        test.files[member] = tidy_rows(of, result, making.store, making.now, base, said)
        test.events[member] = [dataclasses.asdict(of) | dataclasses.asdict(e) for e in result.events]


def _add_rows(layer: TidyLayer, tidied: _Tidied, making: Making) -> None:
    """The catalogue's rows of a test."""
    plan, clocks, test = tidied.plan, tidied.clocks, tidied.plan.test.id
    files = [*catalogue_rows.raw_rows(plan, making.now), *(r for rows in tidied.files.values() for r in rows)]
    note = layer.tests[test]
    for rows in tidied.files.values():
        count(note, rows, test)
    for row in files:
        # the same clock for all of one ingest, and for a kept file the moment at which it was made
        row.setdefault("added_at", making.now)
    _add(layer, test, "file", files)
    _add(layer, test, "quality_event", [e for rows in tidied.events.values() for e in rows])
    lasts_s = duration_s(plan, files)
    _add(layer, test, "test", [catalogue_rows.test_row(plan, tidied.where, lasts_s)])
    note.notes += beyond_the_end(plan.test, lasts_s, step_s(files))
    _add(layer, test, "machine", [catalogue_rows.machine_row(plan.campaign, plan)])
    _add(layer, test, "source", catalogue_rows.source_rows(plan, clocks))
    empty = {name for *_, name in _empty(tidied)}
    _add(layer, test, "channel", catalogue_rows.channel_rows(plan, making.calibrations, empty))
    note.notes += [f"{test}, {name}: {n}" for name, clock in clocks.items() for n in clock.notes]
    note.notes += [f"{r.source_path}: {n}" for s in plan.sources.values() for r in s.raws for n in r.notes]
    note.losses += [
        loss_row(n, test=test, source=name) for name, clock in clocks.items() for n in clock.notes if clock.suspect
    ]


def _kept_alive(path: str, size_bytes: int) -> bool:
    if not is_whole(path, size_bytes):
        return False
    try:
        os.utime(path)  # so that a gc which runs meanwhile sees a young file
    except OSError as error:
        # where nothing can be written, no gc runs either
        return error.errno in (errno.EROFS, errno.EACCES, errno.EPERM)
    return True


def _add(layer: TidyLayer, test: str, table: str, rows: list[Row]) -> None:
    layer.rows[table][test] = rows


__all__ = ["Making", "TidyLayer", "tidy_tests"]
