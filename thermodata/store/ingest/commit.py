"""Makes an ingest visible: one transaction that compares, replaces what changed, and marks dependent fits stale."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.schema.files.campaign import Campaign
from thermodata.store.base.connection import insert
from thermodata.store.base.files import key_of
from thermodata.store.ingest.known.files_taken_out import keep_files
from thermodata.store.ingest.known.inventory import BY_TEST, Inventory, Row, same_rows
from thermodata.store.ingest.known.looks_of_gone import count_on, keep_looks, keep_looks_at_changed
from thermodata.store.ingest.known.mark_stale import is_fitted, mark_stale
from thermodata.store.ingest.known.state import states, version_of

if TYPE_CHECKING:
    import duckdb


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


def parts_of(rows: Mapping[str, Mapping[str, list[Row]]], test: str) -> dict[str, int | None]:
    """The store's files of a test, and their sizes where the catalogue tells them."""
    return {row["path"]: row["bytes"] if row["layer"] == "tidy" else None for row in rows["file"].get(test, [])}


@dataclass(frozen=True, slots=True)
class Difference:
    """What is to be beside what the catalogue holds. tests: table -> those whose rows differ."""

    planned: Planned
    inventory: Inventory
    tests: Mapping[str, set[str]]

    @property
    def taken_out(self) -> set[str]:
        """Tests that stand in the catalogue only."""
        return self.tests["test"] - {t.id for t in self.planned.campaign.tests}

    @property
    def is_none(self) -> bool:
        """Whether the catalogue says already what the plan says."""
        known, planned = self.inventory.campaign, self.planned
        return (
            known is not None
            and (known["spec"] == planned.spec or json.loads(known["spec"]) == json.loads(planned.spec))
            and same_rows(planned.calibrations, self.inventory.calibrations)
            and not any(self.tests.values())
        )


def difference(planned: Planned, inventory: Inventory) -> Difference:
    """Compared at once, for a commit holds the catalogue."""
    tests = {table: _differing(planned.rows[table], inventory.rows[table]) for table in BY_TEST}
    return Difference(planned, inventory, tests)


def _differing(planned: Mapping[str, list[Row]], stored: Mapping[str, list[Row]]) -> set[str]:
    """The tests whose rows of one table differ."""
    return {t for t in planned.keys() | stored.keys() if not same_rows(planned.get(t, []), stored.get(t, []))}


def commit(con: duckdb.DuckDBPyConnection, store: Path, found: Difference, now: datetime) -> list[str]:
    """Brings the campaign's rows to the plan inside the caller's transaction; returns the models gone stale.

    found: from the inventory within this same transaction. Raises VanishedError where a planned file isn't there.
    """
    planned, inventory = found.planned, found.inventory
    missing = [p for p in planned.paths() if not os.path.exists(os.path.join(store, p))]
    if missing:
        raise VanishedError(missing[0])
    campaign = planned.campaign.id
    changed = {t for tests in found.tests.values() for t in tests}
    differ = {
        t
        for t in (changed - {""} if is_fitted(con, campaign) else ())
        if version_of(planned.rows, t) != version_of(inventory.rows, t)
    }
    before, after = {*inventory.rows["test"]}, {*planned.rows["test"]}
    # what models said of a test that was taken out stays, as their fits do: it may come back
    keep_looks(con, campaign, before - after)
    keep_files(con, campaign, before - after, after)
    stay = found.tests["file"] & before & after
    keep_looks_at_changed(con, campaign, planned.rows, stay)
    for table in BY_TEST:
        _replace_rows(con, table, found)
    con.execute(
        "update test set start = make_timestamp_ns(start_ns) where campaign = ? and start_ns is not null "
        "and start is null",
        [campaign],
    )
    _replace_campaign(con, planned, now)
    then = states(inventory.rows, inventory.calibrations, differ)
    stale = mark_stale(con, campaign, then, states(planned.rows, planned.calibrations, differ))
    count_on(con, campaign, planned.rows, after - before)
    count_on(con, campaign, planned.rows, stay, stay=True)
    return stale


def _replace_rows(con: duckdb.DuckDBPyConnection, table: str, found: Difference) -> None:
    """The rows of one table of the tests that differ in it."""
    wanted, stored, campaign = found.planned.rows[table], found.inventory.rows[table], found.planned.campaign.id
    gone = found.tests[table]
    if table == "test" and (gone or list(wanted) != list(stored)):
        # it keeps the order of the campaign file, so all of its rows are written again
        gone = {*wanted, *stored}
    if gone:
        con.execute(f"delete from {table} where campaign = ? and list_contains(?, test)", [campaign, sorted(gone)])
    insert(con, table, [row for test, rows in wanted.items() if test in gone for row in rows])


def _replace_campaign(con: duckdb.DuckDBPyConnection, planned: Planned, now: datetime) -> None:
    """The rows of the campaign itself, and of its calibrations."""
    campaign = planned.campaign.id
    con.execute("delete from calibration where campaign = ?", [campaign])
    insert(con, "calibration", planned.calibrations)
    con.execute("delete from campaign where campaign = ?", [campaign])
    row = {
        "campaign": campaign,
        "spec": planned.spec,
        "spec_hash": key_of(planned.spec),
        "path": str(planned.path),
        "ingested_at": now,
        "data_version": planned.data_version(),
    }
    insert(con, "campaign", [row])
