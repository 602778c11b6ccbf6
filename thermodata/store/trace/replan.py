"""A test as it was ingested, put together again from the catalogue alone: which raw row stands behind a tidy row."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.schema.files.campaign import STORED, Campaign
from thermodata.store.base.connection import fetch
from thermodata.store.catalogue.format.document import read_document
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock, span
from thermodata.store.tidy.clock.undated import bases
from thermodata.store.tidy.clock_offsets import clock_from_json
from thermodata.store.tidy.plan.bind import bind
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan
from thermodata.store.tidy.values.series import Member, TestSeries

if TYPE_CHECKING:
    import duckdb


def read_campaign(con: duckdb.DuckDBPyConnection, campaign: str) -> Campaign:
    """The campaign file as it was ingested."""
    rows = fetch(con, "select spec from campaign where campaign = ?", [campaign])
    return read_document(Campaign, rows[0]["spec"], f"campaign {campaign}", STORED)


def read_series(con: duckdb.DuckDBPyConnection, store: Path, campaign: str, test: str) -> TestSeries:
    """The streams of a test on its time line, as the tidy layer was made from them. No calibration is applied."""
    spec = read_campaign(con, campaign)
    plan = TestPlan(spec, next(t for t in spec.tests if t.id == test))
    files = fetch(con, "select * from file where campaign = ? and test = ? and layer = 'raw'", [campaign, test])
    for name, own in spec.sources.items():
        source = own.with_clock(plan.test.clocks.get(name))
        raws = [RawStream.from_row(r) for r in files if r["source"] == name]
        # as resolve tells it: a pattern without the test's name gives other tests the same files
        patterns = [source.files] if isinstance(source.files, str) else list(source.files or [])
        named = any("{test}" in p for p in patterns) or source.sheet_a_test
        shared = name not in plan.test.files and bool(patterns) and not named
        plan.sources[name] = SourcePlan(name, source, raws, shared)
    bind(plan)
    base, _ = bases(plan)
    kept: dict[str, Clock] = {}
    for row in fetch(con, "select source, notes from source where campaign = ? and test = ?", [campaign, test]):
        estimated = clock_from_json(row["notes"])
        if estimated is not None:
            kept[row["source"]] = estimated
    clocks = {
        name: kept.get(name)
        or Clock(round((s.spec.clock.offset or 0.0) * 1e9), s.spec.clock.drift_ppm or 0.0, base[name])
        for name, s in plan.sources.items()
    }
    return TestSeries(store, plan, clocks, span(plan, clocks), {})


def raw_row_of(series: TestSeries, member: Member, row: int) -> tuple[RawStream, int] | None:
    """(raw stream, its row) behind a row of a stream in time order; None where no file holds the stream."""
    line = series.timeline(member)
    return line.raw_row(row) if line.raws else None
