"""Times of day beside a source that has dates: both clocks are at hand, and where they differ it is asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.tidy.clock.times_of_day import began, first_of

pytestmark = pytest.mark.usefixtures("installed_readers")
HOUR = 3600 * 10**9
NIGHT = 1772490600 * 10**9  # 2026-03-02 22:30 UTC

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  nc: {reader: table, files: "{test}_nc.csv", timezone: Europe/Berlin}
  log: {reader: table, files: "{test}.csv"}
channels:
  n: {source: nc, signal: n, quantity: rotational_speed, unit: rpm, at: spindle}
  dZ: {source: log, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp, relative_to: table}
tests:
  - {id: night, kind: spindle, role: none}
"""


@pytest.mark.parametrize(
    ("of_day_h", "zone", "at"),
    [
        (22.75, "UTC", "2026-03-02 22:45:00"),
        (0.25, "UTC", "2026-03-03 00:15:00"),  # over midnight
        (22.5, "UTC", None),
        (22.52, "UTC", None),  # both begin by hand
        (23.5, "Europe/Berlin", None),
        (22.5, "Europe/Berlin", "2026-03-02 22:30:00"),
        (23.5, None, None),  # which may be the zone
        (23.75, None, "2026-03-02 23:45:00"),
    ],
)
def test_when_a_log_began_by_its_own_clock(of_day_h: float, zone: str | None, at: str | None) -> None:
    assert began(round(of_day_h * HOUR), NIGHT, zone) == at


def test_a_part_without_a_time_of_day_leaves_all_open() -> None:
    assert first_of([5, 6]) == 5
    assert first_of([5, None]) is None
    assert first_of([]) is None


def written(folder: Path, first_min: int) -> Path:
    nc = [f"2026-03-02 {22 + m // 60}:{m % 60:02d}:00;{3000 + m % 7}" for m in range(30, 90)]
    log = [f"{22 + m // 60}:{m % 60:02d}:00;{m / 10}" for m in range(first_min, first_min + 60)]
    (folder / "night_nc.csv").write_text("\n".join(["Zeit;n", *nc, ""]))
    (folder / "night.csv").write_text("\n".join(["Uhrzeit;dZ", *log, ""]))
    return folder


@pytest.mark.parametrize(("first_min", "asked"), [(45, True), (30, False)])
def test_both_clocks_are_held_beside_each_other(tmp_path: Path, first_min: int, asked: bool) -> None:
    written(tmp_path, first_min)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    losses = [str(x) for x in ingest(Store(tmp_path / "s.store", create=True), tmp_path / "campaign.yaml").losses]
    assert any("by its first row it began 2026-03-02 22:45:00" in x for x in losses) is asked
    answered = CAMPAIGN.replace("{id: night,", '{id: night, start: "2026-03-02 22:45:00",')
    (tmp_path / "campaign.yaml").write_text(answered)
    store = Store(tmp_path / "t.store", create=True)
    assert not ingest(store, tmp_path / "campaign.yaml").losses


@pytest.mark.parametrize(("first_min", "asked"), [(45, True), (30, False)])
def test_a_draft_asks_with_the_start_that_fits(tmp_path: Path, first_min: int, asked: bool) -> None:
    draft = draft_files(written(tmp_path, first_min)).draft
    said = [q for s in draft.sources for q in s.questions if "by its first row" in q]
    assert bool(said) is asked
    assert all("start: 2026-03-02 22:45:00" in q for q in said)
