"""Local times and times of day over parts of a file: however it is cut, the times are those of the whole."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.reader.text.times.local_clock import DayCount, LocalClock
from thermodata.reader.times.zone import NAT

S = 1_000_000_000
DAY = 86_400
PRAGUE = ZoneInfo("Europe/Prague")
AUTUMN = int(datetime(2026, 10, 25, tzinfo=UTC).timestamp())  # at 01:00 UTC, 03:00 is 02:00 again


def local(utc_s: list[int]) -> np.ndarray:
    """What a clock in Prague shows, as nanoseconds since 1970."""
    shown = [datetime.fromtimestamp(s, PRAGUE).replace(tzinfo=UTC) for s in utc_s]
    return np.array([int(t.timestamp()) * S for t in shown], np.int64)


def parts(values: np.ndarray, cuts: list[int]) -> list[np.ndarray]:
    return np.split(values, sorted(c % (values.size + 1) for c in cuts))


@settings(deadline=None)
@given(st.integers(60, 900), st.integers(0, 3599), st.lists(st.integers(0, 500), max_size=6))
def test_the_hour_that_repeats_over_any_parts(step: int, start: int, cuts: list[int]) -> None:
    utc = list(range(AUTUMN - 3600 + start, AUTUMN + 3 * 3600, step))
    clock = LocalClock("Europe/Prague")
    found = np.concatenate([clock.utc(part) for part in parts(local(utc), cuts)])
    assert (found // S).tolist() == utc


def test_the_first_row_of_a_part_is_told_by_the_rows_before_it() -> None:
    """One row a part: only the rows before say which of two hours it is."""
    utc = [AUTUMN + m * 60 for m in (-5, 10, 40, 55, 65, 70, 100, 125)]
    clock = LocalClock("Europe/Prague")
    assert [int(clock.utc(local([s]))[0]) // S for s in utc] == utc


def test_without_a_zone_times_stay() -> None:
    times = np.array([5, 3], np.int64)
    assert LocalClock(None).utc(times).tolist() == [5, 3]
    assert LocalClock("Europe/Prague").utc(times[:0]).size == 0


@given(st.lists(st.integers(1, DAY // 2 - 1), min_size=1, max_size=12), st.lists(st.integers(0, 20), max_size=4))
def test_times_of_day_over_any_parts(steps: list[int], cuts: list[int]) -> None:
    since = np.concatenate([[0], np.cumsum(steps)]).astype(np.int64)
    of_day = (since + 80_000) % DAY * S
    days = DayCount()
    found = np.concatenate([days.relative(part) for part in parts(of_day, cuts)])
    assert (found // S).tolist() == since.tolist()


def test_half_a_day_back_is_a_step_and_more_is_midnight() -> None:
    for back, nights in ((timedelta(hours=12), 0), (timedelta(hours=12, seconds=1), 1)):
        start, seconds = DAY - 1, int(back.total_seconds())
        found = DayCount().relative(np.array([start, start - seconds], np.int64) * S)
        assert (found // S).tolist() == [0, nights * DAY - seconds]


def test_rows_without_a_time_of_day_do_not_move_the_others() -> None:
    days = DayCount()
    assert days.relative(np.array([NAT, NAT], np.int64)).tolist() == [NAT, NAT]
    first = days.relative(np.array([NAT, 80_000 * S, NAT, 100 * S], np.int64))
    assert first.tolist() == [NAT, 0, NAT, (DAY + 100 - 80_000) * S]
    assert days.relative(np.array([NAT, 200 * S], np.int64)).tolist() == [NAT, (DAY + 200 - 80_000) * S]
