"""Looks at the locked tests of data that were forgotten: they count on where the same data come back next, for nobody
has forgotten what he saw."""

from __future__ import annotations

import json
from collections.abc import Collection
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.files import key_of
from thermodata.store.ingest.known.state import Rows

if TYPE_CHECKING:
    import duckdb

FORGOTTEN = "forgotten"  # the kind of finding that says which data the looks at a test are of that is no more


def looked_at(con: duckdb.DuckDBPyConnection, campaign: str, tests: Collection[str]) -> set[str]:
    """Those of the tests whose lock was opened."""
    rows = con.execute(
        "select distinct test from locked_look where campaign = ? and list_contains(?, test)", [campaign, sorted(tests)]
    ).fetchall()
    return {test for (test,) in rows}


def keep_looks(con: duckdb.DuckDBPyConnection, campaign: str, rows: Rows, tests: Collection[str]) -> int:
    """Notes which data the looks at tests are of that go now; returns how many looks these are. rows: the inventory's,
    before they go."""
    looked = looked_at(con, campaign, tests) if tests else set()
    if not looked:
        return 0
    now = datetime.now(UTC).replace(tzinfo=None)
    insert(
        con,
        "finding",
        [
            # of no campaign and test, so that it outlasts both
            {
                "campaign": "",
                "test": "",
                "model": "",
                "kind": FORGOTTEN,
                "rank": None,
                "payload": json.dumps({"campaign": campaign, "test": test, "data": _data(rows, test)}),
                "created_at": now,
            }
            for test in sorted(looked)
        ],
    )
    (found,) = fetch(
        con,
        "select count(*) as n from locked_look where campaign = ? and list_contains(?, test)",
        [campaign, sorted(looked)],
    )
    return int(found["n"])


def count_on(con: duckdb.DuckDBPyConnection, campaign: str, rows: Rows, tests: Collection[str]) -> None:
    """Of tests that come into the store: looks at one of the same name count on where its data are the same, and go
    where they are others."""
    if not tests:
        return
    noted = fetch(
        con,
        "select payload->>'$.test' as test, payload->>'$.data' as data from finding where kind = ? "
        "and payload->>'$.campaign' = ? order by rowid",
        [FORGOTTEN, campaign],
    )
    data = {row["test"]: row["data"] for row in noted if row["test"] in tests}
    if not data:
        return
    con.execute(
        "delete from finding where kind = ? and payload->>'$.campaign' = ? and list_contains(?, payload->>'$.test')",
        [FORGOTTEN, campaign, sorted(data)],
    )
    others = sorted(test for test, was in data.items() if was != _data(rows, test))
    if others:
        con.execute("delete from locked_look where campaign = ? and list_contains(?, test)", [campaign, others])


def _data(rows: Rows, test: str) -> str:
    """A digest of the bytes of a test's files."""
    return key_of(*sorted({str(r["sha256"]) for r in rows["file"].get(test, []) if r["layer"] == "raw"}))
