"""Files of tests that were taken out of a campaign file: that they are in no test is meant."""

from __future__ import annotations

import json
from collections.abc import Collection
from typing import TYPE_CHECKING

from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.moment import utc_now

if TYPE_CHECKING:
    import duckdb

TAKEN_OUT = "taken_out"  # the kind of finding that names the files which a test had


def keep_files(con: duckdb.DuckDBPyConnection, campaign: str, gone: Collection[str], there: Collection[str]) -> None:
    """Notes the files of tests that go, before their rows do; of those that are there nothing is noted any more."""
    con.execute(
        "delete from finding where campaign = ? and kind = ? and list_contains(?, test)",
        [campaign, TAKEN_OUT, sorted({*gone, *there})],
    )
    files: dict[str, set[str]] = {}
    for row in fetch(
        con,
        "select distinct test, source_path from file where campaign = ? and layer = 'raw' and list_contains(?, test)",
        [campaign, sorted(gone)],
    ):
        files.setdefault(row["test"], set()).add(row["source_path"])
    now = utc_now()
    insert(
        con,
        "finding",
        [
            {
                "campaign": campaign,
                "test": test,
                "model": "",
                "kind": TAKEN_OUT,
                "rank": None,
                "payload": json.dumps(sorted(own)),
                "created_at": now,
            }
            for test, own in sorted(files.items())
        ],
    )


def files_taken_out(con: duckdb.DuckDBPyConnection, campaign: str) -> set[str]:
    """The source paths of all such tests."""
    noted = fetch(con, "select payload from finding where campaign = ? and kind = ?", [campaign, TAKEN_OUT])
    return {file for row in noted for file in json.loads(row["payload"])}
