"""The tidy files of a campaign's tests, and the catalogue's rows of all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

from thermodata.errors import SpecError, StoreError, ThermodataError
from thermodata.schema.files.campaign import Campaign
from thermodata.store.ingest import catalogue_rows
from thermodata.store.ingest.known.inventory import BY_TEST, Row
from thermodata.store.ingest.known.left_alone import LeftAlone, TestNote, columns_of, estimated
from thermodata.store.ingest.tidied import TidiedTest, note_before_tidying, note_courses, note_verdicts, without_value
from thermodata.store.ingest.tidier import Columns, Making, Tidier
from thermodata.store.ingest.tidy_rows import count, duration_s, step_s
from thermodata.store.ingest.told.channels.empty_channels import empty_channels
from thermodata.store.ingest.told.channels.jumps_inside import tell_jumps_inside
from thermodata.store.ingest.told.channels.other_heads import other_heads
from thermodata.store.ingest.told.channels.other_units import other_units
from thermodata.store.ingest.told.declared.beyond_the_end import beyond_the_end
from thermodata.store.ingest.told.losses import Losses, loss_row
from thermodata.store.tidy.clock.lent import lent
from thermodata.store.tidy.clock_offsets import clocks_of
from thermodata.store.tidy.flags.beside.between import Verdict, verdicts
from thermodata.store.tidy.flags.event import event_of
from thermodata.store.tidy.flags.overrule import idle, met
from thermodata.store.tidy.keys import ChannelTexts
from thermodata.store.tidy.plan.plan import TestPlan
from thermodata.store.tidy.plan.unscaled import tell_unscaled
from thermodata.store.tidy.values.series import Member


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


def tidy_tests(making: Making, campaign: Campaign, plans: Sequence[TestPlan], left: LeftAlone) -> TidyLayer:
    """Tidies every stream of every planned test that isn't there under its content key.

    A sensor that failed between two tests, and a foreign part, show only once all are tidied; the streams that they
    spoil are made again. left: the tests that are not planned; OtherwiseError where what comes of the others changes
    any of them.
    """
    layer = TidyLayer(tests={p.test.id: note_before_tidying(p) for p in plans})
    known = {t.id: layer.tests.get(t.id) or left.tests[t.id] for t in campaign.tests}
    left.hold_beside(layer.tests)
    tidier = Tidier(making, _columns(campaign, known), layer.tests, ChannelTexts(making.calibrations))
    clocks = {name: note.own_clocks() for name, note in left.tests.items()}
    for plan in plans:
        with _loss_where_it_fails(layer, plan):
            own = clocks[plan.test.id] = clocks_of(making.store, plan, making.calibrations, making.inventory.clocks)
            layer.tests[plan.test.id].clocks = estimated(own)
    clocks = lent(clocks, {name: note.dated for name, note in known.items()})
    tidied: dict[str, TidiedTest] = {}
    for plan in plans:
        if plan.test.id in clocks:
            with _loss_where_it_fails(layer, plan):
                tidied[plan.test.id] = tidier.tidy(plan, clocks[plan.test.id])
                note_courses(layer.tests[plan.test.id], tidied[plan.test.id])
    levels = [x for name, note in known.items() if (x := note.levels(name)) is not None]
    found = verdicts(levels)
    left.stand(clocks, found)
    for plan in plans:
        test, note = tidied.get(plan.test.id), layer.tests[plan.test.id]
        if test is not None:
            with _loss_where_it_fails(layer, plan):
                tidier.mark(test, found.get(plan.test.id, Verdict()))
                _add_rows(layer, test, making)
                note_courses(note, test)
                note_verdicts(note, test)
                tell_jumps_inside(making.store, plan, test.where, test.clocks, making.calibrations)
            tell_unscaled(making.store, plan)
            note.overruled = met(campaign.overrule, [event_of(r) for rows in test.events.values() for r in rows])
        note.losses += [loss_row(p, test=plan.test.id) for p in plan.problems]
        note.notes += plan.notes
    layer.new_streams = tidier.new_streams
    layer.losses += empty_channels(campaign, known)
    layer.losses += other_units([x for x, _ in levels])
    layer.losses += other_heads(known)
    layer.notes += idle(campaign.overrule, {name: note.overruled for name, note in known.items() if note.tidied})
    return layer


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


def _add_rows(layer: TidyLayer, tidied: TidiedTest, making: Making) -> None:
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
    empty = {name for *_, name in without_value(tidied)}
    _add(layer, test, "channel", catalogue_rows.channel_rows(plan, making.calibrations, empty))
    note.notes += [f"{test}, {name}: {n}" for name, clock in clocks.items() for n in clock.notes]
    note.notes += [f"{r.source_path}: {n}" for s in plan.sources.values() for r in s.raws for n in r.notes]
    note.losses += [
        loss_row(n, test=test, source=name) for name, clock in clocks.items() for n in clock.notes if clock.suspect
    ]


def _add(layer: TidyLayer, test: str, table: str, rows: list[Row]) -> None:
    layer.rows[table][test] = rows
