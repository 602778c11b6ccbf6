"""A hall's logger that writes a file a day or an hour, beside tests that run across these."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from tests.commands import Say


def _log(path: Path, begin: datetime, minutes: int, name: str, step: int = 1) -> None:
    rows = [
        f"{begin + timedelta(minutes=k):%Y-%m-%d %H:%M:%S},{20 + (k % 97) / 50:.2f}" for k in range(0, minutes, step)
    ]
    path.parent.mkdir(exist_ok=True, parents=True)
    path.write_text("\n".join([f"time,{name}", *rows, ""]), encoding="utf-8")


def _drafted(folder: Path, say: Say) -> str:
    assert say("init", folder).code == 0
    return (folder / "campaign.yaml").read_text(encoding="utf-8")


def _tests(folder: Path, hour: int, hours: int) -> None:
    for day in (4, 5, 6):
        _log(folder / f"S{day}000.csv", datetime(2026, 5, day, hour), 60 * hours, "dZ [um]")


def test_a_file_a_day_is_one_log_of_tests_over_midnight_though_a_zone_would_pair_them(tmp_path: Path, say: Say) -> None:
    """Each test begins three whole hours before a day's file."""
    _tests(tmp_path, 21, 6)
    _log(tmp_path / "hall/hall_2026-05-04.csv", datetime(2026, 5, 4, 20, 23), 217, "T_hall [degC]")
    for day in (5, 6):
        _log(tmp_path / f"hall/hall_2026-05-0{day}.csv", datetime(2026, 5, day), 1440, "T_hall [degC]")
    _log(tmp_path / "hall/hall_2026-05-07.csv", datetime(2026, 5, 7), 202, "T_hall [degC]")
    text = _drafted(tmp_path, say)
    assert "files: hall/hall_2026-05-0*.csv}" in text
    assert "one log for many tests, in parts?" in text
    assert "files: {hall" not in text
    assert "2026" not in text[text.index("\ntests") :]


def test_files_of_an_hour_each_are_no_tests_of_their_own(tmp_path: Path, say: Say) -> None:
    _tests(tmp_path, 8, 6)
    for day in (4, 5, 6):
        for hour in range(7, 15):
            _log(tmp_path / f"hall/202605{day:02d}_{hour:02d}.csv", datetime(2026, 5, day, hour), 60, "T_hall [degC]")
    text = _drafted(tmp_path, say)
    assert "files: hall/2026050*.csv}" in text
    assert "2026" not in text[text.index("\ntests") :]


@pytest.mark.parametrize("ahead", [0, 2])
def test_a_file_a_test_stays_with_its_test_though_it_is_ahead(tmp_path: Path, ahead: int, say: Say) -> None:
    """Tests without a pause between them, and another log whose files begin and end with them, in another zone."""
    for k in range(3):
        begin = datetime(2026, 5, 4, 8) + timedelta(hours=6 * k)
        _log(tmp_path / f"S{k + 4}000.csv", begin, 360, "dZ [um]")
        _log(tmp_path / f"hall/log{k}.csv", begin - timedelta(hours=ahead), 360, "T_hall [degC]")
    text = _drafted(tmp_path, say)
    assert "files joined to tests by their times" in text
    assert "files: {hall: hall/log0.csv}" in text
