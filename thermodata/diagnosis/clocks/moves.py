"""Logs put where it happened: the clocks that a diagnosis found to be off, moved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.schema.answers.diagnosis import ClockMoved
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData


def with_clocks_right(data: Dataset, clocks: Sequence[ClockMoved]) -> Dataset:
    """The same with what sources logged, in all tests or in one, later by so many seconds; moves add up."""
    if not clocks:
        return data
    return replace(data, tests=tuple(moved(t, _shift_s(t, data.channels, clocks)) for t in data.tests))


def _shift_s(test: TestData, channels: Mapping[str, ChannelInfo], clocks: Sequence[ClockMoved]) -> dict[str, float]:
    """Channel -> by how much it is moved in a test."""
    here = [c for c in clocks if not c.test or (c.campaign, c.test) == test.key]
    moves = {n: sum(c.moved_s for c in here if c.source == info.source) for n, info in channels.items()}
    return {n: shift_s for n, shift_s in moves.items() if shift_s}


def moved(test: TestData, shift_s: Mapping[str, float]) -> TestData:
    """The test with some channels later by shift_s. Ends hold their value, which is valid nowhere beyond the log."""
    values, valid = dict(test.values), dict(test.valid)
    for name, by_s in shift_s.items():
        if name in values:
            then_s = test.t_s - by_s
            values[name] = np.interp(then_s, test.t_s, values[name])
            known = np.interp(then_s, test.t_s, np.asarray(valid[name], dtype=np.float64), left=0.0, right=0.0)
            valid[name] = known >= 0.5
    return replace(test, values=values, valid=valid)
