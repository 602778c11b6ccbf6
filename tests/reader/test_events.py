"""Events as rows that hold."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.plugin import Signal
from thermodata.reader.events import fill_forward, held_blocks
from thermodata.schema.flag import INVALID

SIGNALS = (Signal("T", "nc"), Signal("mode", "nc", dtype="str"), Signal("other", "elsewhere"))
EVENTS = [(10, "T", 1.0), (10, "mode", "AUTO"), (20, "T", 2.0), (20, "T", 2.5), (30, "mode", None), (40, "T", None),
          (50, "mode", "MDI")]


@pytest.mark.parametrize("rows", [1, 2, 100])
def test_each_signal_holds_its_last_value_whatever_the_blocks(rows: int) -> None:
    blocks = list(held_blocks(EVENTS, SIGNALS, "nc", rows))
    t = np.concatenate([b.t_ns for b in blocks])
    temperature = np.concatenate([b.values["T"] for b in blocks])
    mode = np.concatenate([b.values["mode"] for b in blocks])
    np.testing.assert_array_equal(t, [10, 20, 30, 40, 50])
    np.testing.assert_array_equal(temperature, [1.0, 2.5, 2.5, np.nan, np.nan])
    assert list(mode) == ["AUTO", "AUTO", "", "", "MDI"]
    assert all(set(b.values) == {"T", "mode"} for b in blocks)


def test_before_the_first_value_and_while_unavailable_a_signal_is_flagged() -> None:
    block = next(held_blocks([(1, "mode", "A"), (2, "T", 3.0), (3, "T", None)], SIGNALS, "nc"))
    assert block.flags is not None
    assert [bool(f & INVALID) for f in block.flags["T"].tolist()] == [True, False, True]
    assert "mode" not in block.flags


def test_time_that_steps_back_keeps_the_order_of_the_log() -> None:
    block = next(held_blocks([(5, "T", 1.0), (3, "T", 2.0)], SIGNALS, "nc"))
    np.testing.assert_array_equal(block.t_ns, [5, 3])
    np.testing.assert_array_equal(block.values["T"], [1.0, 2.0])


def test_an_undeclared_signal_is_an_error() -> None:
    with pytest.raises(KeyError):
        list(held_blocks([(1, "speed", 1.0)], SIGNALS, "nc"))


def test_fill_forward_from_the_first_written_value() -> None:
    got = fill_forward(np.array([7.0, 1.0, 0.0, 0.0, 2.0]), np.array([False, True, False, False, True]))
    np.testing.assert_array_equal(got, [7.0, 1.0, 1.0, 1.0, 2.0])
