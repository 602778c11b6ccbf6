"""What names of files and folders say: a number is taken only where the name says what it is."""

from __future__ import annotations

import pytest

from thermodata.draft.words.said_by_names import said_by, speed_in


@pytest.mark.parametrize(
    ("name", "conditions"),
    [
        ("6000 rpm", {"speed": "6000 rpm"}),
        ("Warmlauf_S4000_5H", {"speed": "4000 rpm"}),
        ("woAC-n6000", {"speed": "6000 rpm", "air_conditioning": "off"}),
        ("Otacky 4500 ot/min", {"speed": "4500 rpm"}),
        ("8krpm", {"speed": "8000 rpm"}),
        ("sp3k", {"speed": "3000 rpm"}),
        ("sp1", {}),
        ("gauge-speed-2026-09-01", {"date": "2026-09-01"}),
        ("speed_2026-09-01_n6000", {"speed": "6000 rpm", "date": "2026-09-01"}),
        ("speed 2026", {"speed": "2026 rpm"}),
        ("spindle_49", {}),
        ("spindle_50", {"speed": "50 rpm"}),
        ("20 rpm", {"speed": "20 rpm"}),
        ("sp2_n6000", {"speed": "6000 rpm"}),
        ("1k+2krpm", {"schedule": "1000 rpm, 2000 rpm"}),
        ("3-1k+2krpm", {"schedule": "1000 rpm, 2000 rpm"}),
        ("2k-4k-8k", {"schedule": "2000 rpm, 4000 rpm, 8000 rpm"}),
        ("wAC-from0-20Cto25C", {"air": "20 degC to 25 degC", "air_conditioning": "on"}),
        ("hall -5C", {"air": "-5 degC"}),
        ("Z feed 10m/min", {"feed": "10 m/min"}),
        ("VF2_thermal_3000rpm", {"speed": "3000 rpm"}),
        ("VF_12", {}),
        ("vf2000", {"feed": "2000 mm/min"}),
        ("vf 2 m/min", {"feed": "2 m/min"}),
        ("X_vf10m/min", {"feed": "10 m/min"}),
        ("X_F10", {"feed": "10 m/min"}),
        ("run_20210612", {"date": "2021-06-12"}),
        ("Messung 12.6.2021", {"date": "2021-06-12"}),
        ("S001", {}),
        ("S010", {}),
        ("S103", {}),
        ("sample 4000", {}),
        ("block 5", {}),
        ("Speed steps", {}),
    ],
)
def test_names_say_conditions(name: str, conditions: dict[str, str]) -> None:
    assert said_by([name]).conditions == conditions


def test_a_speed_that_reads_in_two_ways_is_a_question() -> None:
    said = said_by(["1-8k"])
    assert said.conditions == {}
    assert said.speeds == (1800.0, 8000.0)
    assert said.questions == ("speed: '1-8k' is 1800 rpm, or number 1 at 8000 rpm?",)


def test_what_nothing_names_is_asked_or_only_likely() -> None:
    assert said_by(["20C"]).conditions == {}
    assert "of what?" in said_by(["20C"]).questions[0]
    assert said_by(["12k"]).guessed == {"speed"}
    assert said_by(["6000 rpm"]).guessed == frozenset()
    assert said_by(["Z_F500"]).questions == ("feed in mm/min?",)


def test_a_date_with_a_time_of_day_is_a_start() -> None:
    assert said_by(["run_20210612_1254"]).start == "2021-06-12 12:54:00"
    assert said_by(["run 2021-06-12"]).start is None


def test_the_first_name_counts_most_and_folders_add() -> None:
    said = said_by(["run1", "temps", "2026-03-02 8000rpm"])
    assert said.conditions == {"speed": "8000 rpm", "date": "2026-03-02"}


def test_a_piece_of_a_pattern_is_a_speed_or_a_number() -> None:
    assert speed_in("S8000")
    assert not speed_in("S001")


@pytest.mark.parametrize(
    "name",
    ["20260307_f_2", "20260304_c", "2026-03-04c", "04.03.2026_c", "26_03_17_c", "2026-03-02_0800_c", "20260307_f"],
)
def test_the_letter_of_a_test_of_a_day_makes_no_quantity_of_its_date(name: str) -> None:
    said = said_by([name])
    assert set(said.conditions) <= {"date"}
    assert said.questions == ()


@pytest.mark.parametrize(
    ("name", "conditions"),
    [
        ("20260307_f2000", {"feed": "2000 mm/min", "date": "2026-03-07"}),
        ("20260307_f 2000", {"feed": "2000 mm/min", "date": "2026-03-07"}),
        ("20260307_f_n6000", {"speed": "6000 rpm", "date": "2026-03-07"}),
        ("2026-03-07_air 22c", {"air": "22 degC", "date": "2026-03-07"}),
        ("f_2", {"feed": "2 m/min"}),
    ],
)
def test_what_a_name_says_beside_its_date_stays(name: str, conditions: dict[str, str]) -> None:
    assert said_by([name]).conditions == conditions
