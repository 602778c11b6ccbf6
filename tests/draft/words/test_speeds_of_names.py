"""Speeds that names say, where one pattern would stand for all tests: the numbers are those that are told of each."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.schema.files.load import load_campaign


def drafted(folder: Path, speeds: dict[str, float | None]) -> tuple[str, dict[str, object]]:
    """(the draft, test -> its speed). speeds: name -> what was logged [rpm], None where nothing was."""
    for k, (name, rpm) in enumerate(speeds.items()):
        head = "timestamp;T_bearing_front [degC]" + (";spindle speed [rpm]" if rpm else "")
        rows = [f"2026-05-{11 + k}T06:{m:02d}:00Z;{20 + 0.1 * m:.1f}{f';{rpm}' if rpm else ''}" for m in range(60)]
        (folder / f"{name}.csv").write_text("\n".join([head, *rows]) + "\n")
    draft_files(folder)
    campaign = load_campaign(folder / "campaign.yaml")
    return (folder / "campaign.yaml").read_text(), {t.id: t.conditions.get("speed") for t in campaign.tests}


@pytest.mark.parametrize("logged", [True, False])
def test_thousands_are_no_part_of_the_pattern(tmp_path: Path, logged: bool) -> None:
    text, speeds = drafted(tmp_path, {f"sp{k}k": 1000 * k if logged else None for k in (3, 6, 12)})
    assert "tests_from" not in text
    assert speeds == {"sp3k": "3000 rpm", "sp6k": "6000 rpm", "sp12k": "12000 rpm"}


def test_running_numbers_are_no_speeds(tmp_path: Path) -> None:
    text, speeds = drafted(tmp_path, {"sp1": 3000, "sp2": 6000, "sp3": 12000})
    assert "{speed}" not in text
    assert speeds == {"sp1": "3000 rpm", "sp2": "6000 rpm", "sp3": "12000 rpm"}


def test_running_numbers_of_tests_without_a_speed_say_none(tmp_path: Path) -> None:
    text, speeds = drafted(tmp_path, {"sp1": None, "sp2": None, "sp3": None})
    assert "{speed}" not in text
    assert set(speeds.values()) == {None}


def test_a_name_that_the_log_contradicts_is_asked_in_its_own_line(tmp_path: Path) -> None:
    text, _ = drafted(tmp_path, {"sp3000": 3000, "sp6000": 6000, "sp9000": 12000})
    assert "tests_from" not in text
    assert "speed: the name says 9000 rpm, the data 12000" in text


@pytest.mark.parametrize("logged", [True, False])
def test_speeds_in_rpm_are_one_pattern(tmp_path: Path, logged: bool) -> None:
    text, speeds = drafted(tmp_path, {f"sp{n}": n if logged else None for n in (3000, 6000, 12000)})
    assert 'files: "sp{speed}.csv"' in text
    assert sorted(str(v) for v in speeds.values()) == ["12000 rpm", "3000 rpm", "6000 rpm"]
