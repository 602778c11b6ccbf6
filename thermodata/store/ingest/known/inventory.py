"""What the store already holds of a campaign, so that nothing is made twice."""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from thermodata.store.base.connection import fetch
from thermodata.store.base.files import is_whole
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock
from thermodata.store.tidy.clock_offsets import clock_from_json

if TYPE_CHECKING:
    import duckdb

BY_TEST = ("test", "machine", "source", "channel", "file", "quality_event")
# when a row was written says nothing about what it says
_MOMENTS = ("added_at", "start")

Row = dict[str, Any]


@dataclass(slots=True)
class Inventory:
    """name: the campaign. raws: key -> its streams, of any campaign and of earlier versions of files too.
    rows: table -> test -> rows of this campaign. sources: test -> its rows of the table `source`, also of tests
    that were not asked for. generation: of the store, as of this reading."""

    name: str = ""
    generation: int = -1
    raws: dict[str, list[RawStream]] = field(default_factory=dict)
    rows: dict[str, dict[str, list[Row]]] = field(default_factory=dict)
    sources: dict[str, list[Row]] = field(default_factory=dict)
    campaign: Row | None = None
    calibrations: list[Row] = field(default_factory=list)
    clocks: dict[str, Clock] = field(default_factory=dict)

    def raw_rows(self, test: str, source: str) -> list[RawStream]:
        """The raw streams that the catalogue lists for a test's source ('' and its name for a calibration)."""
        return [
            RawStream.from_row(r)
            for r in self.rows["file"].get(test, [])
            if r["layer"] == "raw" and r["source"] == source
        ]

    def tidy(self, test: str, base: str) -> list[Row]:
        """The rows of the tidy files with that key, whatever sensors of theirs failed before the test."""
        return [
            r
            for r in self.rows["file"].get(test, [])
            if r["layer"] == "tidy" and (r["key"] == base or meta_of(r).get("base") == base)
        ]


def read_inventory(
    con: duckdb.DuckDBPyConnection,
    store: Path | None,
    campaign: str,
    tests: Collection[str] | None = None,
    keys: Collection[str] = (),
) -> Inventory:
    """The catalogue's rows about a campaign. Raw data of which any stream is gone or cut is left out.

    store: the folder; None where the raw files don't matter, which each are opened to see whether they are whole.
    tests: only the rows of these, but for the table `test`, and the raw data of these keys; None: all."""
    inventory = Inventory(campaign, generation_of(con))
    some, named = "", []
    elsewhere = "layer in ('raw', 'superseded')" if store else "false"
    if tests is not None:
        some, named = " and list_contains(?, test)", [sorted({*tests, ""})]
        elsewhere += " and list_contains(?, key)"
    files = fetch(
        con,
        f"select * from file where (campaign = ?{some}) or ({elsewhere})",
        [campaign, *named, *([sorted(keys)] if tests is not None else [])],
    )
    if store:
        inventory.raws = _whole_files(files, str(store))
    for table in BY_TEST:
        grouped: dict[str, list[Row]] = {}
        # `start` would come as a Python datetime, which is optional and says what start_ns says
        columns = "* exclude (start)" if table == "test" else "*"
        if table == "file":
            own = files if tests is None else [r for r in files if r["test"] in tests or r["test"] == ""]
        elif table == "test":
            own = fetch(con, f"select {columns} from {table} where campaign = ?", [campaign])
        else:
            own = fetch(con, f"select {columns} from {table} where campaign = ?{some}", [campaign, *named])
        for row in own:
            if row["campaign"] == campaign:
                grouped.setdefault(row["test"], []).append(row)
        inventory.rows[table] = grouped
    for row in fetch(con, "select * from source where campaign = ?", [campaign]):
        inventory.sources.setdefault(row["test"], []).append(row)
    campaigns = fetch(con, "select * from campaign where campaign = ?", [campaign])
    inventory.campaign = campaigns[0] if campaigns else None
    inventory.calibrations = fetch(con, "select * from calibration where campaign = ?", [campaign])
    for rows in inventory.rows["source"].values():
        for row in rows:
            clock = clock_from_json(row["notes"])
            if clock is not None:
                inventory.clocks[clock.key] = clock
    return inventory


def _whole_files(rows: list[Row], folder: str) -> dict[str, list[RawStream]]:
    """Key -> the streams of the raw data whose files are all there: a source file is read again as a whole, so the
    streams that are left of a damaged one must not stand for it."""
    streams: dict[str, dict[str, Row]] = {}
    for row in rows:
        if row["layer"] in ("raw", "superseded"):
            streams.setdefault(row["key"], {}).setdefault(row["path"], row)
    return {
        key: [RawStream.from_row(row) for row in own.values()]
        for key, own in streams.items()
        if all(is_whole(os.path.join(folder, path)) for path in own)
    }


def meta_of(row: Row) -> Mapping[str, Any]:
    """What a row of `file` tells of its columns, to be read only: each is asked for in several places."""
    return _columns_of_json(row["columns"])


@lru_cache(maxsize=4096)
def _columns_of_json(text: str) -> Mapping[str, Any]:
    return MappingProxyType(json.loads(text))


def generation_of(con: duckdb.DuckDBPyConnection) -> int:
    """Counts the commits of a store: what was read at one is what stands there still."""
    row = con.execute("select max(generation) from store").fetchone()
    return int(row[0]) if row else 0


def same_rows(one: list[Row], other: list[Row]) -> bool:
    """Whether rows say the same, in whatever order and whenever they were written."""
    return one == other or _without_moments(one) == _without_moments(other) or comparable(one) == comparable(other)


def _without_moments(rows: list[Row]) -> list[Row]:
    return [{k: v for k, v in row.items() if k not in _MOMENTS} for row in rows]


def comparable(rows: list[Row]) -> list[str]:
    """Rows as sorted text, without the moments at which they were written."""
    return sorted(repr([(k, v) for k, v in sorted(row.items()) if k not in _MOMENTS]) for row in rows)
