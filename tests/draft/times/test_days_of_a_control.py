"""A control's file a day beside a probe's log a test: which part of it is the test's is known by its zone alone."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.schema.files.load import load_campaign

MIDNIGHT = datetime(2026, 3, 2, tzinfo=UTC)
MORNING, NOON = 7 * 60 + 4, 13 * 60 + 4  # when the tests of a day begin, by the control's clock [min]


def drafted(folder: Path, say: Say, tests: list[int], hours: int, logged: tuple[int, int], more: int = 0) -> str:
    """The draft of two days' tests of 4 h, that begin so many minutes after the midnights of a control, whose clock is
    so many hours ahead of UTC. logged: from and to [min] of each day's file, with 2000 rpm before noon and 8000 rpm
    behind. more: days before and behind that it has files of."""
    for day in range(2):
        for k, first in enumerate(tests):
            began = MIDNIGHT + timedelta(days=day, minutes=first, hours=-hours)
            rows = [f"{began + timedelta(minutes=i):%Y-%m-%dT%H:%M:%SZ},{i % 7},{20 + i / 99:.2f}" for i in range(240)]
            (folder / f"run{day}{k}.csv").write_text("\n".join(["time,dZ [um],T_bed [degC]", *rows, ""]))
    for day in range(-more, 2 + more):
        minutes = range(*logged)
        own = [MIDNIGHT + timedelta(days=day, minutes=m) for m in minutes]
        rows = [
            f"{t:%Y-%m-%d %H:%M:%S},{22 + m / 999:.2f},{8000 if m > 740 else 2000}"
            for t, m in zip(own, minutes, strict=True)
        ]
        lines = ["time,T_front [degC],n [rpm]", *rows, ""]
        (folder / f"cnc_{MIDNIGHT + timedelta(days=day):%Y%m%d}.csv").write_text("\n".join(lines))
    assert say("init", folder).code == 0
    return (folder / "campaign.yaml").read_text()


def test_a_day_that_holds_its_tests_at_many_hours_tells_no_zone_and_no_speed(tmp_path: Path, say: Say) -> None:
    text = drafted(tmp_path, say, [MORNING, NOON], -6, (0, 1440))
    campaign = load_campaign(tmp_path / "campaign.yaml")
    files = {t.id: t.files["cnc"] for t in campaign.tests}
    assert files == {f"run{day}{k}": f"cnc_2026030{2 + day}.csv" for day in (0, 1) for k in (0, 1)}
    assert "from the other sources' UTC" not in text
    assert "timezone? it logs local times without a zone; taken as UTC" in text
    assert not any("speed" in t.conditions for t in campaign.tests)


def test_one_that_holds_them_at_one_hour_alone_tells_the_speed_of_each(tmp_path: Path, say: Say) -> None:
    drafted(tmp_path, say, [MORNING, NOON], -6, (MORNING - 1, NOON + 250))
    campaign = load_campaign(tmp_path / "campaign.yaml")
    speeds = {t.id: str(t.conditions.get("speed")) for t in campaign.tests}
    assert {test: said.split()[0] for test, said in speeds.items()} == {
        "run00": "2000",
        "run01": "8000",
        "run10": "2000",
        "run11": "8000",
    }


@pytest.mark.parametrize("hours", [9, -9])
def test_days_of_which_another_is_the_tests_by_another_zone_are_of_no_test(
    tmp_path: Path, say: Say, hours: int
) -> None:
    """The tests lie in the first files by one zone, and in those of the next day by another."""
    text = drafted(tmp_path, say, [60, 5 * 60], hours, (0, 1440), more=1)
    campaign = load_campaign(tmp_path / "campaign.yaml")
    assert [(t.id, "cnc" in t.files) for t in campaign.tests] == [
        (test, False) for test in ("run00", "run01", "run10", "run11")
    ]
    assert campaign.sources["cnc"].files == "cnc_2026030*.csv"
    assert "from the other sources' UTC" not in text


def test_one_test_a_day_at_one_hour_tells_no_zone_beside_files_of_whole_days(tmp_path: Path, say: Say) -> None:
    """At 07:00 UTC each day, and 08:00 by the control: that its file begins 7 h before says nothing of its zone."""
    (tmp_path / "days").mkdir()
    text = drafted(tmp_path / "days", say, [8 * 60], 1, (0, 1440))
    assert "-7 h from the other sources' UTC if each log begins with its test; they are longer" in text
    assert "-7 to +13 h fit as well" in text
    assert "is the clock wrong" not in text
    declared = text.replace("{reader: table}   # ? timezone?", "{reader: table, timezone: Europe/Prague}   #")
    (tmp_path / "days/campaign.yaml").write_text(declared)
    assert say("init", tmp_path / "days", "--force").code == 0
    assert "timezone: Europe/Prague}" in (tmp_path / "days/campaign.yaml").read_text()


def test_logs_that_are_no_longer_than_their_tests_tell_their_zone_as_before(tmp_path: Path, say: Say) -> None:
    text = drafted(tmp_path, say, [8 * 60], 2, (8 * 60, 8 * 60 + 245))
    assert "+2 h from the other sources' UTC: so are Europe/Helsinki and others" in text


@pytest.mark.parametrize(
    ("begins", "told"),
    [
        (((13, 22, 3), (41, 7, 3), (5, 53, 4)), True),
        (((13, 22, 3), (41, 7, 40), (5, 53, 4)), False),  # each begins as it comes
        (((0, 0, 3), (30, 0, 3), (0, 0, 3)), False),  # by a timetable
        (((13, 22, 3), (13, 22, 3), (13, 22, 3)), False),
    ],
)
def test_longer_logs_tell_their_zone_where_they_begin_with_their_tests_to_seconds(
    tmp_path: Path, say: Say, begins: tuple[tuple[int, int, int], ...], told: bool
) -> None:
    """begins: minute and second of a log, and by how many seconds its test begins later."""
    for k, (minute, second, later) in enumerate(begins):
        own = MIDNIGHT + timedelta(days=k, hours=8, minutes=minute, seconds=second)
        test = own + timedelta(hours=-1, seconds=later)
        rows = [f"{test + timedelta(seconds=20 * i):%Y-%m-%dT%H:%M:%SZ},{i % 7},{20 + i / 99:.2f}" for i in range(360)]
        (tmp_path / f"daq_t{k}.csv").write_text("\n".join(["time,dZ [um],T_bed [degC]", *rows, ""]))
        rows = [f"{own + timedelta(seconds=20 * i):%Y-%m-%d %H:%M:%S},{2000 + i % 5},{i % 9}" for i in range(600)]
        (tmp_path / f"nc_t{k}.csv").write_text("\n".join(["time,n [rpm],nLoad [%]", *rows, ""]))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert ("+1 h from the other sources' UTC: so are Europe/Prague, Europe/Berlin and others" in text) is told
    assert ("+1 to +2 h fit as well" in text) is not told
