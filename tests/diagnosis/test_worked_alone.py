"""The advice knows which sources the tests work by themselves, and names those that none does."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.tell.advising.to_find import to_find
from thermodata.diagnosis.tell.advising.worked import AIR, Worked, worked
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import a_test, scored

CHANNELS = {
    "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle"),
    "n_AWZ": ChannelInfo("n_AWZ", "rotational_speed", "rpm", at="turret"),
    "F_X": ChannelInfo("F_X", "feed", "m/min", at="axis.x"),
    "T_nut": ChannelInfo("T_nut", "temperature", "degC", at="axis.x.nut"),
    "T_bed": ChannelInfo("T_bed", "temperature", "degC", at="bed"),
    "T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall"),
}


def doing(name: str, **levels: float) -> TestData:
    return a_test(name, values={c: np.full(100, levels.get(c, 0.0)) for c in ("n", "n_AWZ", "F_X")}, channels=CHANNELS)


TESTS = [doing("D3000", n=3000), doing("AWZ", n_AWZ=4000), doing("MIX", n=2000, F_X=10, n_AWZ=100), doing("ETVE")]


def test_a_test_works_one_source_alone() -> None:
    found = worked(TESTS, CHANNELS)
    assert dict(found.alone) == {"spindle": ("D3000",), "turret": ("AWZ",), "axis.x": (), AIR: ("ETVE",)}
    assert dict(found.acts) == {"spindle": 2, "turret": 1, "axis.x": 1, AIR: 4}, "a hundred of 4000 1/min is rest"
    assert found.lacking() == ["turret", "axis.x"]


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        ("n_AWZ", "so repeat AWZ, where what moves it works alone, or run it longer, or open the locked tests"),
        ("T_hall", "so repeat ETVE, where what moves it works alone"),
        ("T_nut", "so run a test that moves it alone"),
        ("T_bed", "so run a test that moves it alone"),
    ],
)
def test_a_test_that_is_there_is_repeated(channel: str, said: str) -> None:
    advice = to_find(8, [], CHANNELS, scored("lag", channels=(channel,), after=0.4), worked(TESTS, CHANNELS))
    assert said in advice


def test_sources_that_no_test_works_alone_are_named() -> None:
    advice = to_find(4, [], CHANNELS, None, worked(TESTS, CHANNELS))
    assert "until each source acts in two at least (none works axis.x alone yet; turret acts in one only)" in advice
    full = worked([*TESTS, doing("X", F_X=12), doing("AWZ2", n_AWZ=4000)], CHANNELS)
    assert full.lacking() == []
    assert "are worked alone in a test already, so add tests that work several" in to_find(6, [], CHANNELS, None, full)
    assert "(spindle, one axis, table, hall air)" in to_find(4, [], CHANNELS, None, Worked())
