"""Whether a campaign file is of the campaign that the store holds under its id, or of another one with that id."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError
from thermodata.schema.files.campaign import Campaign, Test
from thermodata.schema.words.sentences import counted, with_count
from thermodata.store.ingest.known.inventory import Inventory
from thermodata.store.ingest.reading.campaign_files import CampaignFiles

_NAMED = 3  # tests


def refuse_another(inventory: Inventory, files: CampaignFiles, path: Path) -> None:
    """UsageError where the store holds another campaign with that id, whose tests and logs would go. path: of the
    campaign file.

    It is the same one where it stands at the same path, or where a test has all the logs of one that is held, or some
    of them and no other: so it may move, and its machine and tests may get other names. A log that all campaigns of a
    hall share makes none the same."""
    held = _logs_held(inventory)
    if inventory.campaign is None or not held or inventory.campaign["path"] == str(path):
        return
    found = {t.id: _logs_found(files, t) for t in files.campaign.tests}
    if any(logs and (logs <= before or logs >= before) for logs in found.values() for before in held.values()):
        return
    if not any(found.values()) and not held.keys().isdisjoint(found):
        return  # it came without its logs, for which the store's raw copies stand
    raise UsageError(
        f"the store holds another campaign with the id '{inventory.name}'",
        where="id",
        expected="the same campaign file, or a test with the logs that it has in the store",
        got=f"none of them; the store's is that of {_machines(inventory)}, {inventory.campaign['path']}, with "
        f"{counted(len(held), 'test')}: {with_count(held, _NAMED)}",
        hint=f"write an id of its own ('{_own_id(files.campaign)}'), or, where the store's tests are to go: "
        "thermodata ingest --replace",
    )


def _logs_held(inventory: Inventory) -> dict[str, set[str]]:
    """Test -> the hashes of its logs in the store, of those that have any."""
    found: dict[str, set[str]] = {}
    for test, rows in inventory.rows["file"].items():
        logs = {row["sha256"] for row in rows if row["layer"] == "raw"}
        if test and logs:
            found[test] = logs
    return found


def _logs_found(files: CampaignFiles, test: Test) -> set[str]:
    """The hashes of the logs of a test that stand beside the campaign file now."""
    found: set[str] = set()
    for name, spec in files.campaign.sources.items():
        found.update(files.hashes_of(files.of_source(test, name).paths, name, spec.of_test(test.id)).values())
    return found


def _machines(inventory: Inventory) -> str:
    rows = (row for own in inventory.rows["machine"].values() for row in own)
    names = sorted({row["machine"] for row in rows}) or [_machine_in(json.loads(inventory.campaign["spec"]))]  # type: ignore[index]
    return f"machine{'s' if len(names) > 1 else ''} {with_count(names, _NAMED)}"


def _machine_in(spec: dict[str, Any]) -> str:
    return str((spec.get("machine") or {}).get("id"))


def _own_id(campaign: Campaign) -> str:
    """An id that says the machine too."""
    return f"{campaign.id}-{campaign.machine.id}".replace(" ", "-")
