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


def two_logs(folder: Path, hall_min: int, campaign: str = "", hall_rows: int = 60) -> tuple[Store, list[str]]:
    """Ingests a test of probes from 08:00 on and a log of the hall from a minute of the day on, both without dates."""
    for name, first, rows, column in (("log", 480, 60, "dZ"), ("hall", hall_min, hall_rows, "T_hall")):
        cells = [f"{m // 60 % 24:02d}:{m % 60:02d}:00;{m / 10}" for m in range(first, first + rows)]
        (folder / f"day_{name}.csv").write_text("\n".join([f"Uhrzeit;{column}", *cells, ""]))
    (folder / "campaign.yaml").write_text(campaign or TWO)
    store = Store(folder / "s.store", create=True)
    return store, [str(x) for x in ingest(store, folder / "campaign.yaml").losses]


TWO = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  hall: {reader: table, files: "{test}_hall.csv"}
  log: {reader: table, files: "{test}_log.csv"}
channels:
  T_hall: {source: hall, signal: T_hall, quantity: temperature, unit: degC, at: hall}
  dZ: {source: log, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp, relative_to: table}
tests:
  - {id: day, kind: spindle, role: none}
"""
BERLIN = TWO.replace('.csv"}', '.csv", timezone: Europe/Berlin}')


def begins(store: Store) -> dict[str, float]:
    with store.reader() as con:
        return dict(con.execute("select channel, min(t_s) from sample group by all").fetchall())


@pytest.mark.parametrize(
    ("hall_min", "s"),
    [
        (500, 1200.0),
        (455, -1500.0),  # before the probes
        (480, 0.0),
        (481, 60.0),  # clocks that have dates count to the second, too
        (1430, 57000.0 - 86400.0),  # 23:50 the night before, a log of 12 h
    ],
)
def test_logs_without_dates_keep_what_lies_between_their_times_of_day(tmp_path: Path, hall_min: int, s: float) -> None:
    store, losses = two_logs(tmp_path, hall_min, hall_rows=720)
    assert begins(store) == {"dZ": 0.0, "T_hall": s}
    assert not losses


def test_what_begins_at_another_time_of_day_is_told(tmp_path: Path) -> None:
    two_logs(tmp_path, 500)
    notes = [str(x) for x in ingest(Store(tmp_path / "t.store", create=True), tmp_path / "campaign.yaml").notes]
    assert any("'hall' begins 20 min after 'log' by its times of day" in x for x in notes)


def test_a_declared_start_is_that_of_the_probes(tmp_path: Path) -> None:
    store, losses = two_logs(tmp_path, 500, TWO.replace("{id: day,", '{id: day, start: "2026-06-15 08:00",'))
    assert begins(store) == {"dZ": 0.0, "T_hall": 1200.0}
    assert not losses


def test_logs_of_two_zones_are_put_together_by_the_date_of_the_start(tmp_path: Path) -> None:
    zones = BERLIN.replace('hall.csv", timezone: Europe/Berlin', 'hall.csv", timezone: UTC')
    store, losses = two_logs(tmp_path, 380, zones.replace("{id: day,", '{id: day, start: "2026-06-15 08:00",'))
    assert begins(store) == {"dZ": 0.0, "T_hall": 1200.0}  # 06:20 UTC is 08:20 there in summer
    assert not losses


def test_zones_without_a_date_are_asked(tmp_path: Path) -> None:
    _, losses = two_logs(
        tmp_path, 380, BERLIN.replace('hall.csv", timezone: Europe/Berlin', 'hall.csv", timezone: UTC')
    )
    assert any("try: give the test its start" in x for x in losses)


def test_a_log_that_says_that_they_began_together_does(tmp_path: Path) -> None:
    store, losses = two_logs(tmp_path, 500, TWO.replace('hall.csv"}', 'hall.csv", clock: {offset: 0 s}}'))
    assert begins(store) == {"dZ": 0.0, "T_hall": 0.0}
    assert not losses


@pytest.mark.parametrize(("campaign", "asked"), [(TWO, True), (BERLIN, False)])
def test_whole_hours_apart_are_asked_where_nobody_says_the_zone(tmp_path: Path, campaign: str, asked: bool) -> None:
    store, losses = two_logs(tmp_path, 540, campaign, hall_rows=120)
    assert any("which may be the zones of two clocks" in x for x in losses) is asked
    assert begins(store)["T_hall"] == 3600.0
    draft = draft_files(tmp_path, force=True).draft
    assert any("begins 1 h after" in q or "begins 1 h before" in q for s in draft.sources for q in s.questions)


def test_a_log_that_fits_on_two_days_is_asked(tmp_path: Path) -> None:
    _, losses = two_logs(tmp_path, 470, hall_rows=3000)
    assert any("runs with it on another day as well" in x for x in losses)


def test_a_log_that_begins_at_midnight_may_count_from_its_start(tmp_path: Path) -> None:
    store, losses = two_logs(tmp_path, 0)
    assert any("'hall' begins at 0:00" in x and "{offset: -28800 s}" in x for x in losses)
    assert begins(store) == {"dZ": 0.0, "T_hall": 0.0}
