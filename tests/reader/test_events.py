"""Events as rows that hold."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import pytest

from thermodata.plugin import Block
from thermodata.reader.signals.events import HeldRows, Value, fill_forward
from thermodata.schema.flag import INVALID, Flag

EVENTS = [
    (10, "T", 1.0),
    (10, "mode", "AUTO"),
    (20, "T", 2.0),
    (20, "T", 2.5),
    (30, "mode", None),
    (40, "T", None),
    (50, "mode", "MDI"),
]


def _blocks(events: Iterable[tuple[int, str, Value]], rows: int = 100) -> Iterator[Block]:
    """A block ends only between two times, so that no row is torn."""
    held = HeldRows[int]({"T": "float64", "mode": "str"}, "nc")
    for event in events:
        if len(held) >= rows and event[0] != held.last:
            yield _taken(held)
        held.add(*event)
    yield _taken(held)


def _taken(held: HeldRows[int]) -> Block:
    block, _ = held.take(lambda stamps: np.array(stamps, np.int64))
    assert block is not None
    return block


@pytest.mark.parametrize("rows", [1, 2, 100])
def test_each_signal_holds_its_last_value_whatever_the_blocks(rows: int) -> None:
    blocks = list(_blocks(EVENTS, rows))
    t = np.concatenate([b.t_ns for b in blocks])
    temperature = np.concatenate([b.values["T"] for b in blocks])
    mode = np.concatenate([b.values["mode"] for b in blocks])
    np.testing.assert_array_equal(t, [10, 20, 30, 40, 50])
    np.testing.assert_array_equal(temperature, [1.0, 2.5, 2.5, np.nan, np.nan])
    assert list(mode) == ["AUTO", "AUTO", None, None, "MDI"]
    assert all(set(b.values) == {"T", "mode"} for b in blocks)


def test_before_the_first_value_and_while_unavailable_a_signal_is_flagged() -> None:
    block = next(_blocks([(1, "mode", "A"), (2, "T", 3.0), (3, "T", None)]))
    assert block.flags is not None
    assert [bool(f & INVALID) for f in block.flags["T"].tolist()] == [True, False, True]
    assert "mode" not in block.flags


@pytest.mark.parametrize("rows", [1, 100])
def test_the_first_value_after_a_hole_is_flagged_as_such_once(rows: int) -> None:
    events = [(1, "T", 1.0), (2, "T", None), (3, "T", 3.0), (4, "mode", "A"), (5, "T", 5.0)]
    flags = np.concatenate(
        [
            np.zeros(b.t_ns.size, np.uint16) if b.flags is None or "T" not in b.flags else b.flags["T"]
            for b in _blocks(events, rows)
        ]
    )
    assert flags.tolist() == [0, Flag.NOT_MEASURING, Flag.GAP, 0, 0]


def test_a_bad_value_is_kept_and_flagged_while_it_holds() -> None:
    held = HeldRows[int]({"T": "float64", "n": "float64"}, "nc")
    for t, name, value, flag in (
        (1, "T", 20.0, 0),
        (2, "T", 99.0, Flag.NOT_MEASURING),
        (3, "n", 1.0, 0),
        (4, "T", 21.0, 0),
    ):
        held.add(t, name, value, int(flag))
    block, bad = held.take(lambda stamps: np.array(stamps, np.int64))
    assert block is not None
    assert block.flags is not None
    assert not bad
    assert block.values["T"].tolist() == [20, 99, 99, 21]
    assert block.flags["T"].tolist() == [0, Flag.NOT_MEASURING, Flag.NOT_MEASURING, 0]


def test_stamps_of_several_clocks_are_sorted_and_a_reset_is_not() -> None:
    def times(stamps: list[int], ordered: bool) -> list[int]:
        held = HeldRows[int]({"T": "float64", "n": "float64"}, "nc", ordered)
        for k, t in enumerate(stamps):
            held.add(t, "Tn"[k % 2], float(k))
        block, _ = held.take(lambda s: np.array(s, np.int64) * 10**9)
        assert block is not None
        return [int(t) // 10**9 for t in block.t_ns]

    assert times([5, 3, 5, 7], ordered=True) == [5, 3, 5, 7]
    assert times([5, 3, 5, 7], ordered=False) == [3, 5, 7]
    assert times([500, 300, 500, 700], ordered=False) == [500, 300, 500, 700]


def test_time_that_steps_back_keeps_the_order_of_the_log() -> None:
    block = next(_blocks([(5, "T", 1.0), (3, "T", 2.0)]))
    np.testing.assert_array_equal(block.t_ns, [5, 3])
    np.testing.assert_array_equal(block.values["T"], [1.0, 2.0])


def test_an_undeclared_signal_is_an_error() -> None:
    with pytest.raises(KeyError):
        list(_blocks([(1, "speed", 1.0)]))


def test_fill_forward_from_the_first_written_value() -> None:
    got = fill_forward(np.array([7.0, 1.0, 0.0, 0.0, 2.0]), np.array([False, True, False, False, True]))
    np.testing.assert_array_equal(got, [7.0, 1.0, 1.0, 1.0, 2.0])


@pytest.mark.parametrize(("ordered", "at"), [(True, [4, 6, 7]), (False, [6, 4])])
def test_a_row_stands_where_its_first_value_does(ordered: bool, at: list[int]) -> None:
    held = HeldRows[int]({"T": "float64", "n": "float64"}, "nc", ordered)
    for line, (t, name) in enumerate([(2, "T"), (2, "n"), (1, "T"), (2, "n"), (9, "T")], 4):
        held.add(t, name, 1.0, at=line)
    held.drop_last()
    block, _ = held.take(lambda stamps: np.array(stamps, np.int64))
    assert block is not None
    assert block.at is not None
    assert block.at.tolist() == at
    held.add(5, "T", 1.0)
    block, _ = held.take(lambda stamps: np.array(stamps, np.int64))
    assert block is not None
    assert block.at is None


SAMPLES = [(1, "T", 1.0), (1, "n", 5.0), (1, "T", 2.0), (3, "T", 4.0), (2, "T", 3.0), (3, "n", 6.0), (3, "T", 7.0)]


def test_where_all_is_kept_no_value_stands_in_for_another_of_its_time() -> None:
    held = HeldRows[int]({"T": "float64", "n": "float64"}, "nc", ordered=False, keep_all=True)
    for t, name, value in SAMPLES:
        held.add(t * 1_000_000_000, name, value)
    block, _ = held.take(lambda stamps: np.array(stamps, np.int64))
    assert block is not None
    assert (block.t_ns // 1_000_000_000).tolist() == [1, 1, 2, 3, 3]
    assert block.values["T"].tolist() == [1, 2, 3, 4, 7]
    assert block.values["n"].tolist() == [5, 5, 5, 5, 6]


def test_a_state_has_one_value_at_a_time() -> None:
    held = HeldRows[int]({"T": "float64", "n": "float64"}, "nc", ordered=False)
    for t, name, value in SAMPLES:
        held.add(t * 1_000_000_000, name, value)
    block, _ = held.take(lambda stamps: np.array(stamps, np.int64))
    assert block is not None
    assert block.values["T"].tolist() == [2, 3, 7]
