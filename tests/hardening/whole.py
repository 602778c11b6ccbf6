"""Is a store whole? Every view answers, the manifest and the files agree; and what it holds, to compare two stores."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any

import duckdb
import pyarrow.parquet as pq

from thermodata.store import Store

# when something was written, and what DuckDB keeps for itself, says nothing about what a store holds
_MOMENTS = ("added_at", "ingested_at", "created_at", "path")
TABLES = ("campaign", "test", "machine", "source", "channel", "file", "quality_event", "calibration", "model", "fit")


def views_of(con: Any) -> list[str]:
    return [
        r[0]
        for r in con.execute(
            "select view_name from duckdb_views() where not internal and database_name = current_database() order by 1"
        ).fetchall()
    ]


def check(folder: Path) -> dict[str, int]:
    """Rows of each view; AssertionError or StoreError where the store is not whole."""
    store = Store(folder)
    counts: dict[str, int] = {}
    with store.reader() as con:
        for view in views_of(con):
            counts[view] = con.execute(f'select count(*) from "{view}"').fetchone()[0]
            con.execute(f'select * from "{view}" limit 3').fetchall()
        rows = con.execute(
            "select path, rows, layer from file union all select path, rows, 'model' from prediction"
        ).fetchall()
        for path, n, layer in rows:
            file = pq.ParquetFile(folder / path)
            assert file.metadata.num_rows == n, (layer, path, n)
        tests = con.execute("select campaign, test from test order by all").fetchall()
        with_samples = {tuple(r) for r in con.execute("select distinct campaign, test from sample").fetchall()}
        assert set(tests) == with_samples, (tests, with_samples)
        for campaign, test in tests[:2]:
            assert con.execute("select count(*) from binned(?, ?, '60 s')", [campaign, test]).fetchone()[0] > 0
    # what a duckdb shell inside the folder sees
    alone = duckdb.connect(str(folder / "catalog.duckdb"), read_only=True)
    assert alone.execute("select count(*) from test").fetchone() == (len(tests),)
    alone.close()
    return counts


_SUPERSEDED = re.compile(r', \\"superseded_at\\": \\"[^"]*\\"')  # a moment inside of the JSON of a row


def content(folder: Path) -> str:
    """A digest of everything that a store holds, but for when and where it was made."""
    digest = hashlib.sha256()
    with Store(folder).reader() as con:
        for table in TABLES:
            cursor = con.execute(f"select * from {table}")
            names = [d[0] for d in cursor.description]
            wanted = [i for i, n in enumerate(names) if n not in _MOMENTS or (table, n) == ("file", "path")]
            rows = [{names[i]: row[i] for i in wanted} for row in cursor.fetchall()]
            told = sorted(_SUPERSEDED.sub("", json.dumps(r, default=str, sort_keys=True)) for r in rows)
            digest.update(json.dumps(told).encode())
        found = con.execute(
            "select campaign, test, channel, count(*), sum(hash(t_s, value, flag)::hugeint) "
            "from sample group by all order by all"
        ).fetchall()
        digest.update(repr(found).encode())
    return digest.hexdigest()[:16]


def left_over(folder: Path) -> list[str]:
    """Unfinished files."""
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob(".*") if ".tmp" in p.name)
