"""Whether a campaign file is of the campaign that the store holds under its id, or of another one with that id."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Set
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError
from thermodata.schema.files.campaign import Campaign, Test
from thermodata.schema.words.sentences import counted, with_count
from thermodata.store.ingest.days_of_tests import is_of_its_days
from thermodata.store.ingest.known.inventory import Inventory
from thermodata.store.ingest.reading.campaign_files import CampaignFiles

_NAMED = 3  # tests
_UNKNOWN = "unknown"  # the machine of a campaign that `init` drafted, until somebody writes its number


def refuse_another(inventory: Inventory, files: CampaignFiles, path: Path) -> None:
    """UsageError where the store holds another campaign with that id, whose tests and logs would go. path: of the
    campaign file.

    A campaign file is of the campaign that is held where one of these is so; its place, its logs and the names of its
    machine and tests may then be others than they were:

    - it stands at the same place, and its machine is no other;
    - all logs that are held are here;
    - logs of its own say so;
    - its machine is the same, and some test has logs of the same days, or no test has any logs now.

    Elsewhere it is another one as soon as the logs of a single test are all of other days."""
    held = _logs_held(inventory)
    if inventory.campaign is None or not held:
        return
    machines = {_machine_in(inventory.campaign), files.campaign.machine.id}
    stays = is_same_place(inventory.campaign["path"], path)
    if len(machines - {_UNKNOWN}) < 2 and stays:
        return
    found = {t.id: _logs_found(files, t) for t in files.campaign.tests}
    if _all_of(held) <= _all_of(found):
        return
    compared = _Compared(inventory, files, held, found)
    later = [] if stays else compared.of_other_days()
    if not later and _has_its_logs(held, found):
        return
    later = later or ([] if stays else compared.beside_other_days())
    one_machine = len(machines) == 1 and _UNKNOWN not in machines
    named = compared.named if one_machine else []
    if named and not later and compared.goes_on():
        return
    got = "none of them"
    if stays:
        got = "that file, of another machine"
    elif named or later:
        ids = later or [t.id for t in named]
        tests = "the test" if len(ids) == 1 else "the tests"
        got = f"{tests} {with_count(ids, _NAMED)} with other logs, of other days or of none"
    raise UsageError(
        f"the store holds another campaign with the id '{inventory.name}'",
        where="id",
        expected="the same machine with the same file or a test of the days that are held, or a test with the logs "
        "that it has there",
        got=f"{got}; the store's is that of "
        f"{_machines(inventory)}, {inventory.campaign['path']}, with "
        f"{counted(len(held), 'test')}: {with_count(held, _NAMED)}",
        hint=f"write an id of its own ('{_own_id(files.campaign, inventory)}'), or, where the store's tests are to go, "
        "or the machine only got another name: thermodata ingest --replace",
    )


def is_same_place(stored: str, path: Path) -> bool:
    """Whether two paths lead to one file, over links and '..' too."""
    return stored == str(path) or Path(stored).resolve() == path.resolve()


@dataclass(frozen=True, slots=True)
class _Compared:
    """The tests that both have by name. held, found: test -> hashes of its logs, in the store and beside the file."""

    inventory: Inventory
    files: CampaignFiles
    held: Mapping[str, set[str]]
    found: Mapping[str, set[str]]

    @property
    def named(self) -> list[Test]:
        return [t for t in self.files.campaign.tests if t.id in self.held]

    def of_other_days(self) -> list[str]:
        """The tests whose own logs are all of other days than those that are held, and none of them is held."""
        shared = self._logs_of_several_tests()
        known = _all_of(self.held) - shared
        return [t.id for t in self.named if not self.found[t.id] & known and self._days(t, shared) is False]

    def beside_other_days(self) -> list[str]:
        """The tests that have a log which is held, as all campaigns of a hall have its, beside logs which are all of
        other days than those that are held beside it. Of a campaign of one test nothing else says whose that log is."""
        return [
            t.id
            for t in self.named
            if (both := self.held[t.id] & self.found[t.id])
            and self._days(t, self._logs_of_several_tests() | both) is False
        ]

    def goes_on(self) -> bool:
        """Whether no test has a log now, or one has a log of its own that is held, or one of the same days."""
        if not any(self.found[t.id] for t in self.named):
            return True
        shared = self._logs_of_several_tests()
        return any((self.held[t.id] & self.found[t.id]) - shared or self._days(t, shared) for t in self.named)

    def _days(self, test: Test, shared: Set[str]) -> bool | None:
        return is_of_its_days(self.inventory, self.files, test, shared)

    def _logs_of_several_tests(self) -> set[str]:
        """Logs that say nothing of one test; none where no test that is held has another one, as where all are cut out
        of one recording."""
        shared = _of_several(self.held) | _of_several(self.found)
        return shared if _all_of(self.held) - shared else set()


def _has_its_logs(held: Mapping[str, set[str]], found: Mapping[str, set[str]]) -> bool:
    """Whether a test has all the logs of one that is held, or some of them and no other. One that several tests share,
    as all campaigns of a hall may share it, proves nothing of a test."""
    shared = _of_several(held) | _of_several(found)
    return any(
        now and before and (now <= before or now >= before)
        for now in (logs - shared for logs in found.values())
        for before in (logs - shared for logs in held.values())
    )


def _all_of(logs: Mapping[str, set[str]]) -> set[str]:
    """The logs of all tests."""
    return set().union(*logs.values())


def _of_several(logs: Mapping[str, set[str]]) -> set[str]:
    """The logs of more than one test."""
    return {log for log, tests in Counter(x for own in logs.values() for x in own).items() if tests > 1}


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
    names = sorted({row["machine"] for row in rows} or {_machine_in(inventory.campaign or {})})
    return f"machine{'s' if len(names) > 1 else ''} {with_count(names, _NAMED)}"


def _machine_in(campaign: Mapping[str, Any]) -> str:
    """As the campaign file of a row of the store names it."""
    spec = json.loads(campaign.get("spec") or "{}")
    return str((spec.get("machine") or {}).get("id"))


def _own_id(campaign: Campaign, inventory: Inventory) -> str:
    """An id that says the machine too; of the same one, another number."""
    if campaign.machine.id == _machine_in(inventory.campaign or {}):
        return f"{campaign.id}-2"
    return f"{campaign.id}-{campaign.machine.id}".replace(" ", "-")
