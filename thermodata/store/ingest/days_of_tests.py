"""When the logs of a test were recorded: those that the store holds, and those beside the campaign file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from contextlib import suppress
from datetime import UTC, datetime

from thermodata.errors import ThermodataError
from thermodata.reader.contract.guard import described
from thermodata.schema.files.campaign import Test
from thermodata.store.ingest.known.inventory import Inventory, Row
from thermodata.store.ingest.reading.campaign_files import CampaignFiles
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.streams import declared

_DAY_NS = 86_400 * 10**9  # zones and clocks of controls are hours off


def is_of_its_days(inventory: Inventory, files: CampaignFiles, test: Test, shared: Set[str]) -> bool | None:
    """Whether a log of a test begins in the days of those that the store holds of it: so it does where it was exported
    anew, or has grown. None where either has no date. shared: hashes of the logs that are not looked at."""
    held = list(_spans(inventory, test.id, shared))
    began = list(_began(files, test, shared)) if held else []
    if not began:
        return None
    return any(first - _DAY_NS <= at <= last + _DAY_NS for at in began for first, last in held)


def _spans(inventory: Inventory, test: str, shared: Set[str]) -> Iterator[tuple[int, int]]:
    """When the held logs of a test begin and end that have dates [ns since 1970]."""
    for row in inventory.rows["file"].get(test, ()):
        if row["layer"] == "raw" and row["sha256"] not in shared:
            raw = RawStream.from_row(row)
            if (first := _begin_ns(raw, inventory.rows["test"].get(test, ()))) is not None:
                yield first, first + raw.last_ns - raw.first_ns


def _begin_ns(raw: RawStream, rows: Iterable[Row]) -> int | None:
    """When a log begins [ns since 1970]: where it does not say so, with its test."""
    if raw.clock == "absolute":
        return raw.first_ns
    if raw.start_ns:
        return raw.start_ns + raw.first_ns
    # a declared start is what a clock counts from, which may be long before its first row
    return next((start - raw.first_ns for start in map(_start_held, rows) if start is not None), None)


def _start_held(row: Row) -> int | None:
    """When the recording of a test began [ns since 1970], in which its window may begin later."""
    if row["start_ns"] is None:
        return None
    before_s = float((row["window_s"] or [0.0])[0])
    return int(row["start_ns"]) - round(before_s * 1e9)


def _began(files: CampaignFiles, test: Test, shared: Set[str]) -> Iterator[int]:
    """When the logs of a test begin that can be read, by themselves or by the campaign file [ns since 1970]."""
    declared_ns = None if test.start is None else _start_declared(test.start)
    for name, spec in files.campaign.sources.items():
        own = spec.of_test(test.id)
        for path, sha256 in files.hashes_of(files.of_source(test, name).paths, name, own).items():
            if sha256 in shared:
                continue
            with suppress(ThermodataError, OSError):
                said = described(files.reader(spec.reader, name), files.full(path), declared(name, own))
                began = declared_ns if said.is_undated else said.start_ns
                if began is not None:
                    yield began


def _start_declared(start: str) -> int:
    moment = datetime.fromisoformat(start)
    moment = moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)  # which is hours off at most
    return round(moment.timestamp()) * 10**9
