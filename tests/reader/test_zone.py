"""Local time to UTC around daylight saving."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.errors import UsageError
from thermodata.reader.times.zone import NAT, local_to_utc_ns

MIN = 60_000_000_000


def walk(first_utc: str, minutes: int, offset_minutes: list[tuple[str, int]]) -> tuple[np.ndarray, np.ndarray]:
    """UTC minutes, and the local times that a wall clock shows for them."""
    utc = np.datetime64(first_utc, "ns") + np.arange(minutes) * np.timedelta64(1, "m")
    local = utc.copy()
    for since, shift in offset_minutes:
        later = utc >= np.datetime64(since, "ns")
        local[later] = utc[later] + np.timedelta64(shift, "m")
    return utc.astype("datetime64[ns]").astype(np.int64), local


AUTUMN = [("2025-01-01", 120), ("2025-10-26T01:00", 60)]


def test_autumn_resolves_by_the_step_back() -> None:
    utc, local = walk("2025-10-25T22:00", 300, AUTUMN)
    got, notes = local_to_utc_ns(local, "Europe/Prague")
    np.testing.assert_array_equal(got, utc)
    assert "60 rows in its first pass, 60 in its second" in notes[0]


def test_autumn_starting_inside_the_second_pass_joins_what_follows() -> None:
    utc, local = walk("2025-10-26T01:10", 120, AUTUMN)
    got, _ = local_to_utc_ns(local, "Europe/Prague")
    np.testing.assert_array_equal(got, utc)


def test_autumn_ending_inside_the_first_pass_joins_what_precedes() -> None:
    utc, local = walk("2025-10-25T22:00", 150, AUTUMN)
    got, _ = local_to_utc_ns(local, "Europe/Prague")
    np.testing.assert_array_equal(got, utc)


def test_a_file_wholly_inside_the_repeated_hour_is_a_noted_guess() -> None:
    _, local = walk("2025-10-26T00:10", 20, AUTUMN)
    _, notes = local_to_utc_ns(local, "Europe/Prague")
    assert "a guess" in notes[0]


@pytest.mark.parametrize("every", [25, 45, 60, 75, 90, 110, 180])
@pytest.mark.parametrize("begins", range(0, 60, 7))
@pytest.mark.parametrize("newest_first", [False, True])
def test_autumn_with_seldom_rows_stands_where_the_steps_are_even(every: int, begins: int, newest_first: bool) -> None:
    utc, local = walk(f"2025-10-25T10:{begins:02}", 2400, AUTUMN)
    utc, local = utc[::every], local[::every]
    if newest_first:
        utc, local = utc[::-1], local[::-1]
    got, notes = local_to_utc_ns(local, "Europe/Prague")
    np.testing.assert_array_equal(got, utc)
    assert not any("a guess" in note for note in notes)


@pytest.mark.parametrize("every", [1, 10])
def test_autumn_with_a_pause_takes_the_pass_that_the_rows_join(every: int) -> None:
    utc, local = walk("2025-10-25T23:00", 600, AUTUMN)
    utc, local = utc[::every], local[::every]
    rows = np.arange(utc.size) * every
    for gap in ((120, 400), (-1, 120), (75, 119)):  # behind the first pass; before the second; in between
        kept = (rows < gap[0]) | (rows >= gap[1])
        got, _ = local_to_utc_ns(local[kept], "Europe/Prague")
        np.testing.assert_array_equal(got, utc[kept])


def test_jitter_is_not_the_repeated_hour() -> None:
    utc, local = walk("2025-10-25T23:00", 80, AUTUMN)  # ends in the first pass
    local[70] -= np.timedelta64(61, "s")  # 1 s before its predecessor
    utc[70] -= 61 * 1_000_000_000
    got, _ = local_to_utc_ns(local, "Europe/Prague")
    np.testing.assert_array_equal(got, utc)


def test_spring_and_a_whole_year() -> None:
    utc, local = walk("2025-03-29T23:00", 240, [("2025-01-01", 60), ("2025-03-30T01:00", 120)])
    got, notes = local_to_utc_ns(local, "Europe/Prague")
    np.testing.assert_array_equal(got, utc)
    assert notes == []


def test_a_time_that_does_not_exist_is_noted() -> None:
    got, notes = local_to_utc_ns(np.array(["2025-03-30T02:30"], "datetime64[ns]"), "Europe/Prague")
    assert got[0] == np.datetime64("2025-03-30T01:30", "ns").astype(np.int64)
    assert "skips" in notes[0]


def test_no_zone_is_utc_with_a_note_and_nat_survives() -> None:
    got, notes = local_to_utc_ns(np.array(["2025-01-01", "NaT"], "datetime64[ns]"), None)
    assert got[0] == np.datetime64("2025-01-01", "ns").astype(np.int64)
    assert got[1] == NAT
    assert "UTC" in notes[0]
    got, _ = local_to_utc_ns(np.array(["NaT", "2025-01-01"], "datetime64[ns]"), "Europe/Prague")
    assert got[0] == NAT
    assert got[1] == np.datetime64("2024-12-31T23:00", "ns").astype(np.int64)


def test_unknown_zone_is_refused() -> None:
    with pytest.raises(UsageError, match="no time zone 'Europe/Pragu'"):
        local_to_utc_ns(np.array(["2025-01-01"], "datetime64[ns]"), "Europe/Pragu")
