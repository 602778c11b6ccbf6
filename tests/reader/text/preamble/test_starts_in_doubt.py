"""Starts above the rows that may be another thing, or stand beside a surer one that can't be read: told, not taken."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.reader.text.preamble.test_head_start import NUMBERS, SEVEN, read


@pytest.mark.parametrize(
    "line",
    [
        "Messung: 02.03.2026, 8 h",
        "Test: 02.03.2026 24 h",
        "Start: 02.03.2026 24 h",
        "Start: 02.03.2026 24 hod",
        "Start: 02.03.2026 24 uur",
        "Measurement: 2026-03-02, 6 h",
        "Start IST: 2026-03-02 07:00",
    ],
)
def test_what_may_be_a_duration_or_in_another_zone_is_told(tmp_path: Path, line: str) -> None:
    clock, _, notes, _ = read(tmp_path, [line], NUMBERS)
    assert clock == "relative"
    assert any("the head says" in n for n in notes)


@pytest.mark.parametrize(
    "line",
    [
        "Messung: 02.03.2026 um 7 h",
        "Messung: 02.03.2026 7h00",
        "Essai: 02.03.2026 à 7 h",
        "Test: 02.03.2026 7 hod",
        "Test: 02.03.2026 7 uur",
    ],
)
def test_hours_behind_a_word_for_them_are_a_time_of_day(tmp_path: Path, line: str) -> None:
    assert read(tmp_path, [line], NUMBERS)[:2] == ("absolute", SEVEN)


def test_the_midnight_behind_a_day_is_one_where_it_is_written_as_a_time(tmp_path: Path) -> None:
    for said in ("24:00", "24 Uhr", "om 24 uur"):
        clock, start, *_ = read(tmp_path, [f"Start: 01.03.2026 {said}"], NUMBERS)
        assert (clock, start) == ("absolute", SEVEN - 7 * 3600 * 10**9), said


def test_a_surer_start_that_is_not_read_is_told_and_the_other_not_taken(tmp_path: Path) -> None:
    head = ["Recorded: 02.03.2026 09:30:00", "Start: 02.03.2026 07:00 Schichtzeit"]
    clock, _, notes, _ = read(tmp_path, head, NUMBERS)
    assert clock == "relative"
    assert any("Schichtzeit" in n for n in notes)
    assert read(tmp_path, head[:1], NUMBERS)[0] == "absolute"


def test_a_number_behind_a_date_is_no_hour(tmp_path: Path) -> None:
    assert read(tmp_path, ["Run: 2026-03-02-01"], NUMBERS)[0] == "relative"
