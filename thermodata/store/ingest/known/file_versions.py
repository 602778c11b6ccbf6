"""Versions of a source file: a changed file stands beside what it was, and a campaign file may go back to that.

The current version's rows of `file` have the layer `raw`, earlier ones `superseded`; both keep their Parquet file.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, cast

from thermodata.errors import UsageError
from thermodata.plugin import Reader, Source
from thermodata.store.ingest.known.inventory import Inventory, Row
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.streams import raw_key

SUPERSEDED = "superseded"


def keep_earlier(rows: dict[str, list[Row]], inventory: Inventory, now: datetime) -> None:
    """Adds to the planned rows of `file` (test -> rows) what the catalogue holds of earlier versions.

    A current file keeps the moment at which it was first stored.
    """
    for test, planned in rows.items():
        before = inventory.rows["file"].get(test, [])
        raw = [r for r in planned if r["layer"] == "raw"]
        current = {_place(r): r for r in before if r["layer"] == "raw"}
        for row in raw:
            old = current.get(_place(row))
            if old is not None and old["key"] == row["key"]:
                row["added_at"] = old["added_at"]
        hashes: dict[tuple[str, str], set[str]] = {}
        for row in raw:
            hashes.setdefault((row["source"], row["source_path"]), set()).add(row["sha256"])
        for row in before:
            there = hashes.get((row["source"], row["source_path"]))
            # the same bytes under a newer reader are no other version
            if there is None or row["sha256"] in there:
                if row["layer"] == SUPERSEDED and there is None:
                    planned.append(row)
                continue
            if row["layer"] == "raw":
                meta = json.loads(row["columns"]) | {"superseded_at": now.isoformat(timespec="seconds")}
                planned.append(row | {"layer": SUPERSEDED, "columns": json.dumps(meta, sort_keys=True)})
            elif row["layer"] == SUPERSEDED:
                planned.append(row)


def _place(row: Mapping[str, Any]) -> tuple[str, str, str]:
    return row["source"], row["source_path"], row["stream"]


def pinned(inventory: Inventory, test: str, source: str, path: str, wanted: str) -> list[RawStream]:
    """The raw streams of the version of a file whose SHA-256 begins with `wanted`; UsageError where none or
    several do."""
    listed = [
        r
        for r in inventory.rows["file"].get(test, [])
        if r["source_path"] == path and r["source"] == source and r["layer"] in ("raw", SUPERSEDED)
    ]
    hashes = sorted({r["sha256"] for r in listed})
    fitting = [h for h in hashes if h.startswith(wanted.lower())]
    if len(fitting) != 1:
        raise UsageError(
            f"no version '{wanted}' of '{path}'" if not fitting else f"several versions '{wanted}'",
            where=f"versions, {path}",
            expected=", ".join(h[:12] for h in hashes) or "a file in the store",
            got=wanted,
            hint=f"thermodata trace {inventory.name} {test} lists them",
        )
    return [RawStream.from_row(r) for r in listed if r["sha256"] == fitting[0]]


@dataclass(frozen=True, slots=True)
class _Was:
    name: str
    version: str


def read_otherwise(raw: RawStream, reader: Reader, source: Source) -> str | None:
    """Why a raw copy isn't what the reader would make of the file today; None where it is."""
    if raw.key == raw_key(raw.sha256, reader, source):
        return None
    was = cast(Reader, _Was(raw.reader, raw.reader_version))
    if raw.reader == reader.name and raw.key == raw_key(raw.sha256, was, source):
        return f"read by {raw.reader} {raw.reader_version}"
    return "read with other settings than the campaign file's now"


def twins(paths: Iterable[str], hashes: Mapping[str, str]) -> dict[str, str]:
    """Path -> the path with the same bytes that is no copy: that of the shortest name, 'a.csv' beside 'a (1).csv'."""
    first: dict[str, str] = {}
    copies: dict[str, str] = {}
    for path in sorted(paths, key=len):
        if path in hashes:
            other = first.setdefault(hashes[path], path)
            if other != path:
                copies[path] = other
    return copies
