"""A test whose streams are tidied, and what an ingest notes of it for the other tests."""

from __future__ import annotations

from dataclasses import dataclass, field

from thermodata.schema.words.places import is_around, is_powered
from thermodata.store.ingest.known.inventory import Row, meta_of
from thermodata.store.ingest.known.left_alone import TestNote, estimated
from thermodata.store.ingest.told.channels.other_heads import head_of
from thermodata.store.tidy.clock.lent import dated_sources
from thermodata.store.tidy.clock.source_clock import Clock, Span
from thermodata.store.tidy.plan.plan import TestPlan
from thermodata.store.tidy.values.series import Member


@dataclass(slots=True)
class TidiedTest:
    """A test whose streams are tidied: member -> the rows of its tidy files, and of its quality events."""

    plan: TestPlan
    clocks: dict[str, Clock]
    where: Span
    files: dict[Member, list[Row]] = field(default_factory=dict)
    events: dict[Member, list[Row]] = field(default_factory=dict)


def note_before_tidying(plan: TestPlan) -> TestNote:
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


def note_courses(note: TestNote, test: TidiedTest) -> None:
    """What the other tests want to know of a test's channels."""
    note.tidied = True
    note.lent = estimated(test.clocks)
    note.start_s = None if test.where.relative else test.where.zero_ns / 1e9
    files = [(r["part"], meta_of(r)) for rows in test.files.values() for r in rows]
    note.empty = without_value(test)
    note.courses = [[meta["to_s"], meta.get("levels")] for part, meta in files if part == "test"]
    named = {name for _, levels in note.courses if levels for name in levels["values"]}
    own = {name: b.channel for name, b in test.plan.bound.items() if name in named}
    note.quantities = {name: channel.quantity for name, channel in own.items()}
    note.powered = [name for name, channel in own.items() if is_powered(channel.at)]
    note.around = [name for name, channel in own.items() if not channel.at or is_around(channel.at)]


def without_value(test: TidiedTest) -> list[list[str]]:
    """[source, stream, name] of each channel without a value in a test."""
    return [
        [source, stream, b.name]
        for (source, stream), rows in test.files.items()
        for meta in map(meta_of, rows)
        for b in test.plan.bound.values()
        if "filled" in meta and (b.source, b.stream) == (source, stream) and b.name not in meta["filled"]
    ]


def note_verdicts(note: TestNote, test: TidiedTest) -> None:
    """What was made with which verdict in mind."""
    for rows in test.files.values():
        meta = [meta_of(r) for r in rows]
        channels = [c for m in meta for c in m["channels"]]
        note.verdicts.append([channels, next((m["verdict"] for m in meta if "verdict" in m), {})])
