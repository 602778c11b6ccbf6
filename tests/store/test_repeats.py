"""Rows that stand in a recording twice, and clocks that were set back."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.plugin import Array, Int1D
from thermodata.store.ingest.told.clocks.repeated_times import said_of_repeats
from thermodata.store.raw import order as order_module
from thermodata.store.raw import repeats as repeats_module
from thermodata.store.raw.order import Order, find_order
from thermodata.store.raw.repeats import Repeats, find_repeats, keys_of, pieces

S = 1_000_000_000
N = 200


def found(t_s: Array, *columns: Array, begins: tuple[int, ...] = (), held: bool = False) -> Repeats:
    t: Int1D = (np.asarray(t_s) * S).astype(np.int64)
    return find_repeats(
        lambda a, b: t[a:b], lambda a, b: keys_of([c[a:b] for c in columns], b - a), len(t), begins, held=held
    )


def order(t_s: Array, twice: Repeats) -> Order:
    keep = np.ones(len(t_s), bool)
    for a, b in twice.cut.tolist():
        keep[a:b] = False
    t = (np.asarray(t_s)[keep] * S).astype(np.int64)
    return find_order(lambda a, b: t[a:b], len(t), resets_allowed=False, sound=twice.left())


def overlapping(rows: Array, again: Array) -> Array:
    return np.concatenate([rows[:100], again, rows[100:]])


@pytest.mark.parametrize("chunk", [7, 64, 500_000])
@pytest.mark.parametrize("first", [40, 89, 95])
def test_rows_that_repeat_earlier_ones_are_cut_and_move_nothing(
    chunk: int, first: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(repeats_module, "CHUNK_ROWS", chunk)
    monkeypatch.setattr(order_module, "CHUNK_ROWS", chunk)
    t, temperature = np.arange(N) * 5.0, 20 + np.arange(N) / 8
    t, temperature = (overlapping(x, x[first:100]) for x in (t, temperature))
    twice = found(t, temperature)
    assert twice.cut.tolist() == [[100, 200 - first]]
    assert twice.notes() == (f"{100 - first} rows repeat earlier ones, times and values: left out",)
    made = order(t, twice)
    assert (made.keep, made.at.size, made.notes) == (N, 0, ())


def test_a_clock_that_was_set_back_logs_other_values() -> None:
    t, temperature = np.arange(N) * 5.0, 20 + np.arange(N) / 8
    again = temperature[89:100].copy()
    again[5] += 0.125
    twice = found(overlapping(t, t[89:100]), overlapping(temperature, again))
    assert not twice.rows
    assert "set back once" in order(overlapping(t, t[89:100]), twice).notes[0]


def test_one_channel_that_differs_is_enough() -> None:
    t = overlapping(np.arange(N) * 5.0, np.arange(89, 100) * 5.0)
    same, other = np.sin(np.round(t)), np.arange(len(t)) * 1.0
    assert found(t, same).rows == 11
    assert not found(t, same, other).rows


@pytest.mark.parametrize(("begins", "cut"), [((), []), ((100,), [[100, 111]])])
def test_where_nothing_moves_only_the_begin_of_a_file_tells_a_copy(begins: tuple[int, ...], cut: list[object]) -> None:
    t = overlapping(np.arange(N) * 5.0, np.arange(89, 100) * 5.0)
    assert found(t, np.full(len(t), 20.5), begins=begins).cut.tolist() == cut


def test_rows_that_the_first_file_lacks_are_sorted_in() -> None:
    t, temperature = np.arange(N) * 5.0, 20 + np.arange(N) / 8
    there = np.delete(np.arange(100), [93, 94])
    rows = np.concatenate([there, np.arange(89, N)])
    twice = found(t[rows], temperature[rows])
    assert (twice.cut.tolist(), twice.mixed.tolist(), twice.rows) == ([], [[98, 109]], 9)
    made = order(t[rows], twice)
    assert (made.keep, made.at.size) == (len(rows), 0)
    assert len(made.islands)


def test_the_first_rows_of_a_copy_of_held_values_may_hold_others() -> None:
    t = overlapping(np.arange(N) * 5.0, np.arange(89, 100) * 5.0)
    speed = np.round(t)
    speed[100:102] = np.nan
    assert not found(t, speed).rows
    twice = found(t, speed, held=True)
    assert (twice.cut.tolist(), twice.mixed.tolist()) == ([[102, 111]], [[100, 102]])
    assert order(t, twice).at.size == 0


def test_words_and_missing_values_are_values() -> None:
    t = overlapping(np.arange(N) * 5.0, np.arange(89, 100) * 5.0)
    number = np.where(t % 10 == 0, np.nan, t)
    word = np.array([None if x % 15 == 0 else str(x) for x in t], dtype=object)
    count = 2**60 + np.round(t).astype(np.int64)
    assert found(t, number, word, count).rows == 11
    word[105] = "door open"
    assert not found(t, number, word, count).rows
    count[105] += 1
    assert not found(t, number, count).rows


def test_a_copy_behind_steps_back_that_are_none_is_found_and_behind_very_many_it_is_not() -> None:
    def behind(steps: int) -> Repeats:
        t = np.arange(10.0 * steps)
        t[5::10] -= 3.5
        end = t.max() + np.arange(1.0, 101)
        t = np.concatenate([t, end, end[50:]])
        return found(t, np.round(t * 7))

    assert behind(150).rows == 50
    assert behind(250).rows == 0


def test_what_is_left_of_several_files() -> None:
    cut = np.array([[2, 4], [5, 6], [9, 12]])
    assert list(pieces([5, 6, 4], cut)) == [(0, 0, 2), (0, 4, 5), (1, 1, 4), (2, 1, 4)]


def test_nobody_looks_for_copies_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each is held against all rows before it."""
    t = np.concatenate([4 * k + np.array([0.0, 2.0, 0.0, 2.0]) for k in range(20)])
    assert len(found(t, t).cut) == 20
    monkeypatch.setattr(repeats_module, "_MOST_COPIES", 5)
    assert len(found(t, t).cut) == 5


@pytest.mark.parametrize(("to_s", "advice"), [(5990.0, ", which is about 10 s by their number"), (-28800.0, "")])
def test_a_period_is_only_told_where_time_goes_on(to_s: float, advice: str) -> None:
    meta = {"samples": 600, "flags": {"duplicate_time": 599}, "to_s": to_s}
    (said,) = said_of_repeats("t1", "log", meta, 600)
    assert f"{{period: ...}}}}{advice}, and in the test" in said
