"""Makes an ingest visible: one transaction that compares, replaces what changed, and marks dependent fits stale."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.schema.campaign import Campaign
from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.files import key_of
from thermodata.store.catalogue.models import STALE
from thermodata.store.ingest.inventory import BY_TEST, Inventory, Row, same

if TYPE_CHECKING:
    import duckdb

Rows = Mapping[str, Mapping[str, list[Row]]]
# what a fit reads: words about a test or a channel don't make it stale
_DESCRIBING = ("test", "machine", "channel")
_WORDS = ("notes", "repeat_of", "added_at", "start", "sensor", "raw_unit")


@dataclass
class Planned:
    """The whole state of a campaign, as it is to be. rows: table -> test -> rows ('' for jump tests), all of them of
    the table `test`, of the others those of the tests that were looked at. versions: of the tests, by `version_of`."""

    campaign: Campaign
    path: Path
    rows: dict[str, dict[str, list[Row]]]
    calibrations: list[Row]
    versions: Mapping[str, str]

    @cached_property
    def spec(self) -> str:
        return self.campaign.model_dump_json(by_alias=True)

    def paths(self) -> set[str]:
        return {row["path"] for rows in self.rows["file"].values() for row in rows}

    def data_version(self) -> str:
        return key_of(*(f"{t}:{self.versions[t]}" for t in sorted(self.rows["test"])))


class VanishedError(Exception):
    """A file that the plan relies on was removed meanwhile."""


@lru_cache(maxsize=64)
def _read_by_a_fit(columns: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(sorted(c for c in columns if c not in _WORDS))


def _read_by_fits(rows: Rows, table: str, test: str) -> list[str]:
    """What fits read of a test's rows, in no order of these."""
    return sorted(repr([(k, row[k]) for k in _read_by_a_fit(tuple(row))]) for row in rows[table].get(test, []))


def version_of(rows: Mapping[str, Mapping[str, list[Row]]], test: str) -> str:
    """A digest of everything about a test that a fit depends on."""
    parts = [one for table in _DESCRIBING for one in _read_by_fits(rows, table, test)]
    parts += sorted({r["key"] for r in rows["file"].get(test, []) if r["layer"] == "tidy"})
    return key_of(*sorted(parts))


def parts_of(rows: Mapping[str, Mapping[str, list[Row]]], test: str) -> dict[str, int | None]:
    """The store's files of a test, and their sizes where the catalogue tells them."""
    return {row["path"]: row["bytes"] if row["layer"] == "tidy" else None for row in rows["file"].get(test, [])}


def changes(planned: Planned, inventory: Inventory) -> dict[str, set[str]]:
    """Table -> the tests whose rows differ from those in the catalogue."""
    return {table: _changed(planned.rows[table], inventory.rows[table]) for table in BY_TEST}


def _changed(planned: Mapping[str, list[Row]], stored: Mapping[str, list[Row]]) -> set[str]:
    """The tests whose rows of one table differ."""
    return {t for t in planned.keys() | stored.keys() if not same(planned.get(t, []), stored.get(t, []))}


def nothing_new(planned: Planned, inventory: Inventory, changed: Mapping[str, set[str]]) -> bool:
    """Whether the catalogue says already what the plan says. changed: their `changes`."""
    return (
        inventory.campaign is not None
        and (
            inventory.campaign["spec"] == planned.spec
            or json.loads(inventory.campaign["spec"]) == json.loads(planned.spec)
        )
        and same(planned.calibrations, inventory.calibrations)
        and not any(changed.values())
    )


def commit(
    con: duckdb.DuckDBPyConnection,
    store: Path,
    planned: Planned,
    inventory: Inventory,
    differing: Mapping[str, set[str]],
    now: datetime,
) -> list[str]:
    """Brings the campaign's rows to the plan inside the caller's transaction; returns the models gone stale.

    inventory: the state within this same transaction; differing: its `changes`.
    Raises VanishedError where a planned file isn't there.
    """
    missing = [p for p in planned.paths() if not os.path.exists(os.path.join(store, p))]
    if missing:
        raise VanishedError(missing[0])
    campaign = planned.campaign.id
    changed = {t for tests in differing.values() for t in tests}
    stale = {
        t
        for t in changed
        if inventory.rows["test"].get(t) and version_of(planned.rows, t) != version_of(inventory.rows, t)
    }
    for table in BY_TEST:
        gone = set(differing[table])
        if table == "test" and (gone or list(planned.rows[table]) != list(inventory.rows[table])):
            # it keeps the order of the campaign file, so all of its rows are written again
            gone = {*planned.rows[table], *inventory.rows[table]}
        if gone:
            con.execute(f"delete from {table} where campaign = ? and list_contains(?, test)", [campaign, sorted(gone)])
        insert(con, table, [row for t, rows in planned.rows[table].items() if t in gone for row in rows])
    con.execute(
        "update test set start = make_timestamp_ns(start_ns) where campaign = ? and start_ns is not null "
        "and start is null",
        [campaign],
    )
    con.execute("delete from calibration where campaign = ?", [campaign])
    insert(con, "calibration", planned.calibrations)
    con.execute("delete from campaign where campaign = ?", [campaign])
    insert(
        con,
        "campaign",
        [
            {
                "campaign": campaign,
                "spec": planned.spec,
                "spec_hash": key_of(planned.spec),
                "path": str(planned.path),
                "ingested_at": now,
                "data_version": planned.data_version(),
            }
        ],
    )
    # what models said of a test that was taken out stays, as their fits do: it may come back
    calibrated = not same(planned.calibrations, inventory.calibrations)
    return mark_stale(con, campaign, {t: what_changed(planned.rows, inventory.rows, t, calibrated) for t in stale})


def what_changed(now: Rows, then: Rows, test: str, calibrated: bool) -> list[str]:
    """In words: gone, role, calibration, data, units or signals, how it is read, or else description. calibrated:
    whether the campaign's calibrations differ."""
    if not now["test"].get(test):
        return ["gone"]

    def differs(table: str, *columns: str, layer: str | None = None) -> bool:
        one, other = (
            sorted(repr([r[c] for c in columns]) for r in rows[table].get(test, []) if layer in (None, r.get("layer")))
            for rows in (now, then)
        )
        return one != other

    words = [
        ("role", differs("test", "role")),
        ("calibration", differs("channel", "channel", "calibration") or calibrated),
        ("data", differs("file", "key", layer="raw")),
        ("units or signals", differs("channel", "channel", "signal", "quantity", "unit", "raw_unit")),
    ]
    found = [word for word, holds in words if holds]
    described = any(_read_by_fits(now, table, test) != _read_by_fits(then, table, test) for table in _DESCRIBING)
    return found or ["description" if described else "how it is read"]


def drop_results(con: duckdb.DuckDBPyConnection, campaign: str, tests: set[str]) -> None:
    """Removes what models said about tests that are forgotten, wherever it stands."""
    for table in ("prediction", "score_row", "finding", "locked_look") if tests else ():
        con.execute(f"delete from {table} where campaign = ? and list_contains(?, test)", [campaign, sorted(tests)])
    for row in fetch(con, "select model, result from model where list_contains(campaigns, ?)", [campaign]):
        result = json.loads(row["result"])
        for scored in ("scores", "before"):
            if result.get(scored):
                result[scored] = [s for s in result[scored] if s["campaign"] != campaign or s["test"] not in tests]
        con.execute("update model set result = ? where model = ?", [json.dumps(result), row["model"]])


def mark_stale(con: duckdb.DuckDBPyConnection, campaign: str, tests: Mapping[str, Sequence[str]]) -> list[str]:
    """Marks the models that used any of the tests, and keeps what changed in each (test -> `what_changed`); one that
    names no tests used the whole campaign. Returns those that were not stale before."""
    if not tests:
        return []
    rows = fetch(
        con,
        """
        with used as (select distinct model, campaign, test from score_row
                      union select distinct model, campaign, test from prediction)
        select m.model, m.stale, m.result from model m where list_contains(m.campaigns, $1) and (
            exists (from used u where u.model = m.model and u.campaign = $1 and list_contains($2, u.test))
            or not exists (from used u where u.model = m.model and u.campaign = $1))""",
        [campaign, sorted(tests)],
    )
    for row in rows:
        con.execute("update model set stale = true where model = ?", [row["model"]])
        scored = {s["test"] for s in json.loads(row["result"]).get("scores", []) if s["campaign"] == campaign}
        _keep_what_changed(con, row["model"], campaign, {t: w for t, w in tests.items() if t in scored or not scored})
    return [r["model"] for r in rows if not r["stale"]]


def _keep_what_changed(
    con: duckdb.DuckDBPyConnection, model: str, campaign: str, tests: Mapping[str, Sequence[str]]
) -> None:
    """Beside what changed before."""
    insert(
        con,
        "finding",
        [
            # of no test, so that it outlasts a test that is gone
            {
                "campaign": campaign,
                "test": "",
                "model": model,
                "kind": STALE,
                "rank": None,
                "payload": json.dumps({"test": test, "what": list(what)}),
                "created_at": datetime.now(UTC).replace(tzinfo=None),
            }
            for test, what in tests.items()
        ],
    )
