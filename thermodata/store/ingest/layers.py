"""The layers of a campaign as an ingest makes them, and the catalogue's rows and notes of its tests from both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime

from thermodata.calibration.result import CalibrationResult
from thermodata.store.ingest.catalogue_rows import raw_row
from thermodata.store.ingest.commit import parts_of
from thermodata.store.ingest.known.file_versions import keep_earlier
from thermodata.store.ingest.known.inventory import BY_TEST, Inventory, Row
from thermodata.store.ingest.known.left_alone import LeftAlone, TestNote
from thermodata.store.ingest.known.state import version_of
from thermodata.store.ingest.reading.campaign_files import CampaignFiles
from thermodata.store.ingest.reading.raw_layer import RawIngest
from thermodata.store.ingest.tidier import Making
from thermodata.store.ingest.tidy_layer import TidyLayer, tidy_tests
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.plan.bind import bind
from thermodata.store.tidy.values.calibrations import evaluate


@dataclass(frozen=True, slots=True)
class Layers:
    """left: the tests that were not looked at. jumps: calibration -> the raw data of its jump test. problems: why
    calibrations could not be evaluated."""

    files: CampaignFiles
    left: LeftAlone
    raw: RawIngest
    jumps: Mapping[str, list[RawStream]]
    calibrations: Mapping[str, CalibrationResult]
    problems: list[str]
    tidy: TidyLayer

    @property
    def is_as_stored(self) -> bool:
        """Whether no file was read and none made: what was damaged and is made anew has the same rows, and the views
        must see it all the same."""
        return not self.tidy.new_streams and not self.raw.read

    def rows(self, inventory: Inventory, now: datetime) -> dict[str, dict[str, list[Row]]]:
        """Table -> test -> its rows, '' for those of jump tests."""
        campaign = self.files.campaign
        rows: dict[str, dict[str, list[Row]]] = {t: dict(self.tidy.rows[t]) for t in BY_TEST}
        rows["file"][""] = [
            raw_row(campaign.id, "", name, raw, "calibration", now) for name, raws in self.jumps.items() for raw in raws
        ]
        keep_earlier(rows["file"], inventory, now)
        if self.left.tests:
            # its rows stand in the order of the campaign file, so a commit may write all of them
            looked_at, known = rows["test"], inventory.rows["test"]
            of_each = {t.id: (known if t.id in self.left.tests else looked_at).get(t.id) for t in campaign.tests}
            rows["test"] = {name: own for name, own in of_each.items() if own}
        return rows

    def notes_of_tests(self, rows: Mapping[str, Mapping[str, list[Row]]]) -> dict[str, TestNote]:
        """What is told of each test, in the order of the campaign file."""
        for name, note in self.tidy.tests.items():
            said = self.raw.said[name]
            note.losses[:0], note.notes[:0] = said.losses, said.notes
            note.parts = parts_of(rows, name)
            note.version = version_of(rows, name) if name in rows["test"] else None
        return {t.id: self.left.tests.get(t.id) or self.tidy.tests[t.id] for t in self.files.campaign.tests}


def make_layers(files: CampaignFiles, inventory: Inventory, left: LeftAlone, now: datetime) -> Layers:
    """Reads what the store does not hold yet, evaluates the calibrations, and tidies the tests that are not left
    alone. CalibrationError for a contradictory calibration."""
    store, campaign = files.store, files.campaign
    raw = RawIngest(files, inventory)
    raw.read_ahead()
    jumps = raw.jump_files()
    calibrations, problems = evaluate(store, campaign, jumps)
    plans = [raw.plan(test) for test in campaign.tests if test.id not in left.tests]
    for plan in plans:
        bind(plan)
    making = Making(store, calibrations, inventory, now, files.watch.say)
    tidy = tidy_tests(making, campaign, plans, left)
    return Layers(files, left, raw, jumps, calibrations, problems, tidy)
