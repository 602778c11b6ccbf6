"""When the logs of a test were recorded: those that the store holds, and those beside the campaign file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from thermodata.errors import ThermodataError
from thermodata.reader.contract.guard import described
from thermodata.schema.files.campaign import Test
from thermodata.store.ingest.known.inventory import Inventory
from thermodata.store.ingest.reading.campaign_files import CampaignFiles
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.streams import declared

_DAY_NS = 86_400 * 10**9  # zones and clocks of controls are hours off


def is_of_its_days(inventory: Inventory, files: CampaignFiles, test: Test) -> bool:
    """Whether a log of a test begins, by its own clock, in the days of those that the store holds of it: so it does
    where it was exported anew, or has grown. False where either has no date."""
    held = [_span(raw) for raw in _held(inventory, test.id) if _is_dated(raw)]
    began = _began(files, test) if held else ()
    return any(first - _DAY_NS <= at <= last + _DAY_NS for at in began for first, last in held)


def _held(inventory: Inventory, test: str) -> Iterator[RawStream]:
    yield from (RawStream.from_row(row) for row in inventory.rows["file"].get(test, ()) if row["layer"] == "raw")


def _is_dated(raw: RawStream) -> bool:
    return raw.clock == "absolute" or raw.start_ns is not None


def _span(raw: RawStream) -> tuple[int, int]:
    start = raw.start_ns or 0 if raw.clock == "relative" else 0
    return start + raw.first_ns, start + raw.last_ns


def _began(files: CampaignFiles, test: Test) -> Iterator[int]:
    """When the logs of a test begin that have dates, and can be read [ns since 1970]."""
    for name, spec in files.campaign.sources.items():
        for path in files.of_source(test, name).paths:
            with suppress(ThermodataError, OSError):
                reader = files.reader(spec.reader, name)
                said = described(reader, files.full(path), declared(name, spec.of_test(test.id)))
                if said.start_ns is not None:
                    yield said.start_ns
