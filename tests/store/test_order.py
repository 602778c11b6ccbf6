"""Clocks with faults: strays, steps back, and clocks that were set while they ran."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.plugin import Int1D
from thermodata.store.raw import order as order_module
from thermodata.store.raw.order import Order, find_order

S = 1_000_000_000
T0 = 1_770_000_000 * S


def clock(n: int, step_s: float = 1.0) -> Int1D:
    return T0 + np.arange(n, dtype=np.int64) * round(step_s * S)


def ordered(t: Int1D, *, allowed: bool = False) -> tuple[Order, Int1D]:
    """(order, the times that come of it, in order)."""
    found = find_order(lambda a, b: t[a:b], len(t), resets_allowed=allowed)
    made = found.moved(t[: found.keep].copy(), 0)
    for a, b in found.islands.tolist():
        made[a:b] = np.sort(made[a:b])
    return found, made


@pytest.mark.parametrize("stray", [10**18, -(10**18), 3600 * S, -3600 * S, 30 * 365 * 86_400 * S])
@pytest.mark.parametrize(("row", "rows"), [(500, 1), (500, 3), (1, 2), (996, 3)])
def test_a_few_stray_times_are_drawn_between_their_neighbours(stray: int, row: int, rows: int) -> None:
    t = clock(1000)
    t[row : row + rows] += stray
    found, made = ordered(t)
    assert found.keep == 1000
    assert np.abs(made - clock(1000)).max() <= S
    assert found.marked.tolist() == list(range(row, row + rows))
    assert found.extent == (made[0], made[-1])
    assert "stray" in found.notes[0]


def test_a_clock_that_strays_again_and_again_is_looked_through_once() -> None:
    """To its end for each of 2,500 strays took 26 s."""
    t = clock(500_000)
    t[100::200] -= 3600 * S
    began = time.process_time()
    found, made = ordered(t)
    assert time.process_time() - began < 8
    assert found.keep == len(t)
    assert np.abs(made - clock(len(t))).max() <= S


@pytest.mark.parametrize(
    ("row", "rows", "stray"),
    [(0, 1, 10**18), (0, 3, 7200 * S), (997, 3, -7200 * S), (999, 1, 10**18), (999, 1, -(10**18))],
)
def test_strays_at_the_ends(row: int, rows: int, stray: int) -> None:
    t = clock(1000)
    t[row : row + rows] += stray
    found, made = ordered(t)
    assert made.tolist() == clock(1000).tolist()
    assert found.marked.tolist() == list(range(row, row + rows))


def test_a_pause_is_no_fault_of_the_clock() -> None:
    t = clock(1000)
    t[1:] += 3600 * S
    t[997:] += 90 * 86_400 * S
    found, made = ordered(t)
    assert made.tolist() == t.tolist()
    assert not found.marked.size


def test_a_clock_that_was_set_while_it_ran_moves_what_came_before_up_to_it() -> None:
    t = clock(1000)
    t[:300] -= t[0] + 66 * 365 * 86_400 * S  # begins in 1904, before any time server
    found, made = ordered(t)
    assert made.tolist() == clock(1000).tolist()
    assert found.marked.tolist() == [300]
    assert "set ahead by 122 years" in found.notes[0]
    assert found.extent == (T0, T0 + 999 * S)


def test_a_time_server_sets_the_clock_back_a_little_and_nothing_is_lost() -> None:
    t = clock(1000)
    t[600:] -= 90 * S
    found, made = ordered(t)
    assert found.keep == 1000
    assert made.tolist() == clock(1000).tolist()
    assert "once, by 89 s" in found.notes[0]


def test_a_long_step_back_is_refused_or_joined_as_declared() -> None:
    t = clock(1000)
    t[600:] -= 7200 * S
    found, made = ordered(t)
    assert (found.keep, len(made)) == (600, 600)
    assert found.extent == (T0, T0 + 599 * S)
    found, made = ordered(t, allowed=True)
    assert made.tolist() == clock(1000).tolist()
    assert found.marked.tolist() == [600]


def test_disorder_within_a_second_is_sorted_and_no_fault() -> None:
    t = clock(1000, 0.1)
    t[[50, 51]] = t[[51, 50]]
    found, made = ordered(t)
    assert made.tolist() == clock(1000, 0.1).tolist()
    assert not found.notes


@settings(max_examples=150, deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 199), st.sampled_from(["stray", "back", "set"]), st.integers(-(10**17), 10**17)),
        max_size=4,
    ),
    st.sampled_from([7, 50, 1000]),
)
def test_the_size_of_the_chunks_does_not_matter(faults: list[tuple[int, str, int]], chunk: int) -> None:
    t = clock(200)
    for row, kind, size in faults:
        if kind == "stray":
            t[row] += size
        elif kind == "back":
            t[row:] -= abs(size) % (100 * S)
        else:
            t[row:] += abs(size) + 400 * 86_400 * S
    whole, times = ordered(t, allowed=True)
    assert (np.diff(times) >= 0).all()
    before = order_module.CHUNK_ROWS
    order_module.CHUNK_ROWS = chunk
    try:
        cut, again = ordered(t, allowed=True)
    finally:
        order_module.CHUNK_ROWS = before
    assert again.tolist() == times.tolist()
    assert cut.marked.tolist() == whole.marked.tolist()


@pytest.mark.parametrize(("first", "period"), [(380, 10.0), (4, 1.0), (996, 1.0), (500, 1.0)])
@pytest.mark.parametrize("allowed", [False, True])
def test_a_ring_buffer_is_put_in_the_order_of_its_times(first: int, period: float, allowed: bool) -> None:
    t = clock(1000, period)
    found, made = ordered(np.concatenate([t[-first:], t[:-first]]), allowed=allowed)
    assert found.keep == 1000
    assert made.tolist() == t.tolist()
    assert found.extent == (t[0], t[-1])
    assert found.notes == (
        f"a ring buffer: its oldest rows stand from row {first + 1} on, and are put before the others",
    )
    assert not found.marked.size


def test_a_ring_buffer_of_several_rows_a_time_and_a_row_that_is_missing_at_its_seam() -> None:
    t = np.repeat(clock(1000, 10.0), 3)
    found, made = ordered(np.concatenate([t[1503:], t[:1497]]))
    assert found.keep == len(t) - 6
    assert made.tolist() == np.concatenate([t[:1497], t[1503:]]).tolist()


@pytest.mark.parametrize("pause_s", [31.0, 300.0, -5.0])
def test_a_part_that_ends_otherwise_than_a_period_before_the_first_row_is_no_ring(pause_s: float) -> None:
    t = clock(1000, 10.0)
    t[400:] += round((pause_s - 10) * S) if pause_s > 0 else -50 * S
    assert ordered(np.concatenate([t[400:], t[:400]]))[0].keep == 600
    assert ordered(np.concatenate([t[400:], t[:400]]), allowed=True)[0].keep == 1000


def test_two_steps_back_are_no_ring() -> None:
    t = clock(900)
    assert ordered(np.concatenate([t[600:], t[300:600], t[:300]]))[0].keep == 300


def test_resets_by_decades_end_where_no_time_is_left() -> None:
    years = np.arange(400) // 3 % 50  # seconds of a clock that were taken for years
    found, made = ordered(T0 + years * 365 * 86_400 * S + np.arange(400), allowed=True)
    assert 150 <= found.keep < 400
    assert (np.diff(made) > 0).all()
    assert made[-1] < 2**62
