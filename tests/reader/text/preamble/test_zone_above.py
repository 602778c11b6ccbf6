"""A zone that stands above the rows: taken where it is an offset alone, and nobody declared another."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.plugin import Recording, Source
from thermodata.reader.text import delimited

EIGHT = 1772438400 * 10**9  # 2026-03-02 08:00 UTC
HOUR = 3600 * 10**9
ROWS = ["Zeit;T1 [°C]", *(f"2026-03-02 08:{k:02d}:00;{20 + k % 9},5" for k in range(40))]


def described(folder: Path, head: str, rows: list[str] = ROWS, zone: str | None = None) -> Recording:
    (folder / "log.csv").write_text("\n".join(["Logger 7", head, *rows, ""]), "utf-8")
    source = Source(timezone=zone)
    return delimited.describe(delimited.open_table(folder / "log.csv", source), source)


@pytest.mark.parametrize(
    ("head", "hours"),
    [
        ("Zeitzone: UTC+1", 1),
        ("時差:GMT+9:00/夏時間:off", 9),
        ("# Time zone = GMT-05:00", -5),
        ("Timezone;+02:00", 2),
        ("Fuseau horaire : UTC", 0),
        ("UTC offset: +9", 9),
    ],
)
def test_an_offset_above_the_rows_is_their_zone(tmp_path: Path, head: str, hours: int) -> None:
    found = described(tmp_path, head)
    assert found.start_ns == EIGHT - hours * HOUR
    assert any("by a line above the rows" in n for n in found.notes)
    assert not any("no time zone" in n for n in found.notes)


@pytest.mark.parametrize(
    "head",
    [
        "Zeitzone: (UTC+01:00) Amsterdam, Berlin",
        "Zeitzone: CET",
        "Time zone: +05:30",
        "Zone: +1",
        "Time zone correction: +1",
        "Zeitzone:",
    ],
)
def test_one_whose_clocks_may_be_put_ahead_is_asked(tmp_path: Path, head: str) -> None:
    found = described(tmp_path, head)
    assert found.start_ns == EIGHT
    assert any("no time zone" in n for n in found.notes)


@pytest.mark.parametrize(
    ("head", "zone", "said"),
    [
        ("Zeitzone: UTC+3", "Europe/Prague", True),
        ("Zeitzone: UTC+1", "Europe/Prague", False),
        ("Zeitzone: UTC", "Etc/UTC", False),
        ("Zeitzone: CET", "Europe/London", False),
    ],
)
def test_a_declared_zone_of_another_offset_is_told(tmp_path: Path, head: str, zone: str, said: bool) -> None:
    notes = described(tmp_path, head, zone=zone).notes
    assert (f"the line above the rows says '{head}'; the declared {zone} is used" in notes) is said
    assert not any("above" in n for n in notes) or said
    summer = [ROWS[0], *(row.replace("-03-", "-07-") for row in ROWS[1:])]
    assert any(
        "the declared Europe/Prague is used" in n
        for n in described(tmp_path, "Zeitzone: UTC+1", summer, "Europe/Prague").notes
    ), "whose clocks are put ahead"


def test_a_declared_zone_and_one_in_the_cells_come_first(tmp_path: Path) -> None:
    assert described(tmp_path, "Zeitzone: UTC+3", zone="Europe/Prague").start_ns == EIGHT - HOUR
    zoned = [ROWS[0], *(row.replace(";", "+02:00;") for row in ROWS[1:])]
    assert described(tmp_path, "Zeitzone: UTC+3", zoned).start_ns == EIGHT - 2 * HOUR


def test_clocks_of_t_and_d_that_are_put_ahead_leave_the_zone_open(tmp_path: Path) -> None:
    found = described(tmp_path, "時差:GMT+9:00/夏時間:on")
    assert found.start_ns == EIGHT
    said = "the head says '時差: GMT+9:00; 夏時間: on', whose clocks may be put ahead in summer or not"
    assert any(n.startswith(said) and n.endswith("timezone: Etc/GMT-9 where they never are") for n in found.notes)
    declared = described(tmp_path, "時差:GMT+9:00/夏時間:on", zone="Asia/Tokyo")
    assert declared.start_ns == EIGHT - 9 * HOUR
    assert not any("夏時間" in n for n in declared.notes)
