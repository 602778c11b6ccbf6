"""Looks at the locked tests of data that are there no more: they count on where the same data come back, whatever was
in their place meanwhile and under whichever name, for nobody has forgotten what he saw."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from datetime import datetime
from typing import TYPE_CHECKING, Any

from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.files import key_of
from thermodata.store.base.moment import utc_now
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


def keep_looks(con: duckdb.DuckDBPyConnection, campaign: str, tests: Collection[str]) -> int:
    """Notes the looks at tests with the data that they are of, before these go; returns how many looks these are."""
    looked = looked_at(con, campaign, tests) if tests else set()
    now = utc_now()
    noted = {test: _looks(con, campaign, test) for test in sorted(looked)}
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
                "payload": json.dumps(
                    {"campaign": campaign, "test": test, **_stored(con, campaign, test), "looks": looks}
                ),
                "created_at": now,
            }
            for test, looks in noted.items()
        ],
    )
    return sum(map(len, noted.values()))


def keep_looks_at_changed(con: duckdb.DuckDBPyConnection, campaign: str, rows: Rows, tests: Collection[str]) -> None:
    """The same of tests that stay, where their data are others in `rows`, which come."""
    others = {t for t in looked_at(con, campaign, tests) if _stored(con, campaign, t)["data"] != _data(rows, t)}
    keep_looks(con, campaign, others)


def count_on(
    con: duckdb.DuckDBPyConnection, campaign: str, rows: Rows, tests: Collection[str], *, stay: bool = False
) -> None:
    """Of tests that come into the store, or of which other data come: the looks at these data count on. Those at other
    data that had the name of a test wait for these. stay: whether what was seen of a test counts all the same: its data
    may differ by a byte."""
    if not tests:
        return
    noted = fetch(con, "select rowid as place, payload from finding where kind = ? order by rowid", [FORGOTTEN])
    found = [(row["place"], json.loads(row["payload"])) for row in noted]
    elsewhere = _looked_at_elsewhere(con, campaign, tests)
    for test in sorted(tests) if found or elsewhere else ():
        own = [(place, one) for place, one in found if (one["campaign"], one["test"]) == (campaign, test)]
        same = [(place, one) for place, one in found if _is_of(one, campaign, test, rows)]
        twins = [key for key, one in elsewhere.items() if _is_of(one, campaign, test, rows)]
        if not own and not same and not twins:
            continue
        now = _looks(con, campaign, test)
        # a version that noted no looks left them where they were
        before = [look for _, one in same for look in one.get("looks", now)]
        before += [look for key in twins for look in _looks(con, *key)]
        looks = [list(look) for look in dict.fromkeys(map(tuple, [*(now if stay else ()), *before]))]
        con.execute("delete from locked_look where campaign = ? and test = ?", [campaign, test])
        insert(
            con,
            "locked_look",
            [
                {"campaign": campaign, "test": test, "model": model, "reason": reason, "at": datetime.fromisoformat(at)}
                for model, reason, at in looks
            ],
        )
        back = [place for place, one in same if (one["campaign"], one["test"]) == (campaign, test)]
        con.execute("delete from finding where kind = ? and list_contains(?, rowid)", [FORGOTTEN, back])


def _looked_at_elsewhere(
    con: duckdb.DuckDBPyConnection, campaign: str, tests: Collection[str]
) -> dict[tuple[str, str], dict[str, Any]]:
    """(campaign, test) of each other test that the store has and whose lock was opened -> what it is of."""
    rows = con.execute("select distinct campaign, test from locked_look semi join test using (campaign, test)")
    return {
        (c, t): {"campaign": c, "test": t, **_stored(con, c, t)}
        for c, t in rows.fetchall()
        if c != campaign or t not in tests
    }


def _is_of(noted: Mapping[str, Any], campaign: str, test: str, rows: Rows) -> bool:
    """Whether looks are of the data of a test: of its name, or of the same window where it had another one."""
    if noted["data"] != _data(rows, test):
        return False
    named = (noted["campaign"], noted["test"]) == (campaign, test)
    return named or (bool(_files(rows, test)) and noted.get("window") == _window(rows, test))


def _looks(con: duckdb.DuckDBPyConnection, campaign: str, test: str) -> list[list[str]]:
    """(model, reason, at) of each, the first one first."""
    rows = con.execute(
        'select model, reason, "at" from locked_look where campaign = ? and test = ? order by "at", rowid',
        [campaign, test],
    ).fetchall()
    return [[model, reason, at.isoformat()] for model, reason, at in rows]


def _stored(con: duckdb.DuckDBPyConnection, campaign: str, test: str) -> dict[str, Any]:
    """The same of what the store holds of a test: `data` and `window`."""
    named = [campaign, test]
    files = con.execute("select sha256 from file where campaign = ? and test = ? and layer = 'raw'", named).fetchall()
    window = con.execute("select window_s from test where campaign = ? and test = ?", named).fetchone()
    return {"data": key_of(*sorted({str(sha) for (sha,) in files})), "window": window[0] if window else None}


def _window(rows: Rows, test: str) -> list[float] | None:
    """From where to where of its files a test is [s]; None: all of them."""
    found = rows["test"].get(test, [])
    window = found[0].get("window_s") if found else None
    return None if window is None else list(window)


def _data(rows: Rows, test: str) -> str:
    """A digest of the bytes of a test's files."""
    return key_of(*sorted(_files(rows, test)))


def _files(rows: Rows, test: str) -> set[str]:
    return {str(r["sha256"]) for r in rows["file"].get(test, []) if r["layer"] == "raw"}
