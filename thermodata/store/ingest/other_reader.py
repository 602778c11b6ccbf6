"""Logs that the store holds as another version of their reader made them."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence

from thermodata.errors import UsageError
from thermodata.schema.words.sentences import counted
from thermodata.store.ingest.known.inventory import Inventory, Row, meta_of
from thermodata.store.ingest.reading.campaign_files import CampaignFiles
from thermodata.store.raw.streams import version_of

_RELEASE = re.compile(r"\d+(\.\d+)*")


def refuse_older_reader(inventory: Inventory, files: CampaignFiles) -> None:
    """UsageError where logs of the campaign were read by a newer version of a reader than the installed one: it would
    set them back, and the newer program would read them anew in turn."""
    kept: dict[str, str] = {}
    for rows in inventory.rows["file"].values():
        for row in rows:
            if row["layer"] == "raw":
                name, version = meta_of(row)["reader"], meta_of(row)["reader_version"]
                kept[name] = max(kept.get(name, ""), version, key=_release_numbers)
    for source, spec in files.campaign.sources.items():
        try:
            reader = files.reader(spec.reader, source)
        except UsageError:
            continue  # told where a file needs it
        here, there = version_of(reader), kept.get(reader.name, "")
        if _release_numbers(here) and _release_numbers(here) < _release_numbers(there):
            raise UsageError(
                f"the store holds this campaign as a newer reader '{reader.name}' made it",
                where=f"sources.{source}.reader",
                expected=f"{reader.name} {there} or newer",
                got=f"{reader.name} {here}",
                hint="use the program that made it, or a newer one; to stay with this one: ingest into a store of its "
                "own, with --store",
            )


def _release_numbers(version: str) -> tuple[int, ...]:
    """() for what is no release, which is neither older nor newer."""
    return tuple(map(int, version.split("."))) if _RELEASE.fullmatch(version) else ()


def read_by_another(inventory: Inventory, rows: Mapping[str, list[Row]]) -> list[str]:
    """A line for each reader whose version changed while the logs did not. rows: of the table `file`, by test."""
    found: defaultdict[tuple[str, str, str], set[str]] = defaultdict(set)  # hashes: one log may be of many tests
    for test, planned in rows.items():
        before, now = (_readers(of_test) for of_test in (inventory.rows["file"].get(test, []), planned))
        for log, (name, version) in now.items():
            if before.get(log, (name, version))[1] != version and before[log][0] == name:
                found[name, before[log][1], version].add(log[2])
    return [
        f"reader {name} {was} -> {now}: {counted(len(logs), 'log')} {'was' if len(logs) == 1 else 'were'} read anew by "
        f"it, and {'is' if len(logs) == 1 else 'are'} unchanged; what differs now comes from the program"
        for (name, was, now), logs in found.items()
    ]


def _readers(rows: Sequence[Row]) -> dict[tuple[str, str, str], tuple[str, str]]:
    """(source, path, SHA-256) of each log -> the reader that read it, and its version."""
    return {
        (row["source"], row["source_path"], row["sha256"]): (meta_of(row)["reader"], meta_of(row)["reader_version"])
        for row in rows
        if row["layer"] == "raw"
    }
