"""Forgetting, cleaning, the snapshot, and the way back from a value to its file."""

from __future__ import annotations

import hashlib
import os
import time
from pathlib import Path

import duckdb
import pytest
from store_fakes import daq

from thermodata.errors import UsageError
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.forget import forget
from thermodata.store.keep.gc import gc
from thermodata.store.keep.snapshot import snapshot
from thermodata.store.trace.lineage import trace


def test_a_forgotten_test_leaves_no_row_and_no_file(filled: Store) -> None:
    before = len(list(filled.path.rglob("*.parquet")))
    assert forget(filled, "shop", "one")["tests"] == ["one"]
    with filled.reader() as con:
        for table in ("test", "file", "channel", "source", "machine", "quality_event"):
            assert con.execute(f"select count(*) from {table} where test = 'one'").fetchone() == (0,)
        assert con.execute("select count(*) from displacement").fetchone() == (1200,)
    assert gc(filled, grace_s=3600)["removed"] == 0
    assert gc(filled, grace_s=0)["removed"] == before - len(list(filled.path.rglob("*.parquet"))) > 0


def test_a_forgotten_campaign_comes_back_by_ingest(filled: Store, campaign: Path) -> None:
    forget(filled, "shop")
    gc(filled, grace_s=0)
    assert not list(filled.path.rglob("*.parquet"))
    assert ingest(filled, campaign).changed
    with filled.reader() as con:
        assert con.execute("select count(*) from displacement").fetchone() == (2400,)


def test_unknown_names_are_refused_with_the_nearest(filled: Store) -> None:
    with pytest.raises(UsageError, match="did you mean 'shop'"):
        forget(filled, "shopp")
    with pytest.raises(UsageError, match="one, two"):
        forget(filled, "shop", "three")
    with pytest.raises(UsageError, match="T_a"):
        trace(filled, "shop", "one", "T_c")


def test_gc_takes_leftovers_but_nothing_young_or_strange(filled: Store) -> None:
    left = filled.path / "tidy/.x.parquet.0011.tmp"
    left.write_bytes(b"half")
    mine = filled.path / "tidy/notes.txt"
    mine.write_text("keep")
    assert gc(filled, grace_s=60)["removed"] == 0
    old = time.time() - 120
    os.utime(left, (old, old))
    assert gc(filled, grace_s=60)["removed"] == 1
    assert mine.exists()
    with filled.reader() as con:
        assert con.execute("select count(*) from sample").fetchone() == (7460,)


def test_a_snapshot_stands_alone(filled: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = snapshot(filled, tmp_path / "all.duckdb")
    with filled.reader() as con:
        expected = {q: con.execute(q).fetchall() for q in QUESTIONS}
    for path in filled.path.rglob("*.parquet"):
        path.unlink()
    monkeypatch.chdir(tmp_path)
    alone = duckdb.connect(str(out), read_only=True)
    assert {q: alone.execute(q).fetchall() for q in QUESTIONS} == expected
    alone.close()
    with pytest.raises(UsageError, match="exists"):
        snapshot(filled, out)


QUESTIONS = (
    "select campaign, test, channel, count(*), sum(value) from sample group by all order by all",
    "select count(*), avg(value) from signal('shop', 'two', 'T_a')",
    "select * from binned('shop', 'one', '60 s') order by t_s limit 5",
    "select * from aligned('shop', 'two', '60 s') order by t_s limit 5",
    "select message, count(*) from wide_shop_nc group by all order by all",
    "select count(*) from residual",
    "select test, role from test order by 1",
    "select count(*) from score",
)


def test_a_sample_is_traced_to_file_hash_and_row(filled: Store, campaign: Path) -> None:
    found = trace(filled, "shop", "two", "dZ", 123.0)
    source = campaign.parent / "raw/two_a.npz"
    assert found["files"][0]["sha256"] == hashlib.sha256(source.read_bytes()).hexdigest()
    place = found["sample"]["raw"]
    assert (place["source_path"], place["row"]) == ("raw/two_a.npz", 123)
    assert place["raw_value"] == daq(seed=1)["main"]["Z"][123]
    assert found["sample"]["value"] == pytest.approx(-10 * place["raw_value"])
    assert found["calibrations"][0]["gain"] == -10.0
    assert [f["source_path"] for f in trace(filled, "shop", "two")["files"]] == ["raw/two_a.npz", "raw/two.nc.npz"]


def test_a_snapshot_sweeps_what_killed_ones_have_left_beside_it_and_nothing_else(store: Store, tmp_path: Path) -> None:
    old, young, foreign = (
        tmp_path / n for n in (".out.duckdb.0a1b2c3d.tmp", ".out.duckdb.4e5f6a7b.tmp.wal", ".else.duckdb.0a1b2c3d.tmp")
    )
    for path in (old, young, foreign):
        path.write_bytes(b"cut")
    for path in (old, foreign):
        os.utime(path, (1, 1))
    snapshot(store, tmp_path / "out.duckdb")
    assert [p.exists() for p in (old, young, foreign)] == [False, True, True]
