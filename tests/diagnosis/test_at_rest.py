"""Commands that no open test moves, and what they would warm: claims/at_rest.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.candidates.kin import Kin
from thermodata.diagnosis.claims.at_rest import at_rest
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import a_test, candidate

CHANNELS = {
    "feed": ChannelInfo("feed", "feed", "m/min", at="axis.y"),
    "T_motor": ChannelInfo("T_motor", "temperature", "degC", at="axis.y.motor"),
    "T_bed": ChannelInfo("T_bed", "temperature", "degC", at="bed"),
    "pos": ChannelInfo("pos", "position", "mm", at="axis.y"),
}
POOL = [
    candidate("feed_motor", channels=("T_motor",)),
    candidate("feed_screw", channels=("feed",)),
    candidate("bed", channels=("T_bed",)),
    candidate("feed_twice", channels=("feed",), kin="same"),
    candidate("lag", family="generic", channels=("feed",)),
    candidate("growth", channels=("T_bed", "pos")),
]


def a_day(name: str, feed: float, pos: float = 100.0) -> TestData:
    values: Mapping[str, Float1D] = {
        "feed": feed * np.r_[np.zeros(50), np.ones(50)],
        "T_motor": np.full(100, 20.0),
        "T_bed": np.full(100, 20.0),
        "pos": np.r_[np.full(50, 100.0), np.full(50, pos)],
    }
    return a_test(name, 100, values=values, channels=CHANNELS)


def test_what_rests_in_all_open_tests_and_moves_elsewhere_is_told() -> None:
    (told,) = at_rest(POOL, [a_day("a", 0.1), a_day("b", 0.0)], [a_day("c", 0.0), a_day("d", 12.0)], CHANNELS)
    assert told.channel == "feed"
    assert told.warms == ("T_motor",)
    assert told.effects == ("feed_motor", "feed_screw")
    assert [t.test for t in told.moves_in] == ["d"]


@pytest.mark.parametrize(("open_feed", "told"), [(0.59, True), (0.61, False)])
def test_under_a_twentieth_of_what_it_does_elsewhere_a_command_rests(open_feed: float, told: bool) -> None:
    days = [a_day("b", 12.0), a_day("c", open_feed)]
    found = at_rest(POOL, [a_day("a", open_feed)], days, CHANNELS)
    assert [t.test for one in found for t in one.moves_in] == (["b"] if told else [])


def test_what_says_when_it_was_measured_moves_nothing() -> None:
    mask = {**CHANNELS, "feed": replace(CHANNELS["feed"], is_mask=True)}
    assert at_rest(POOL, [a_day("a", 0.0)], [a_day("b", 12.0)], mask) == []


@pytest.mark.parametrize(("kin", "told"), [(None, True), ("near", True), ("related", True), ("same", False)])
def test_another_mode_of_what_the_model_has_is_no_effect_that_could_be_missed(kin: Kin, told: bool) -> None:
    found = at_rest([candidate("screw", channels=("feed",), kin=kin)], [a_day("a", 0.0)], [a_day("b", 9.0)], CHANNELS)
    assert bool(found) is told


@pytest.mark.parametrize(("open_feed", "other_feed"), [(12.0, 12.0), (0.0, 0.0)])
def test_what_an_open_test_moves_or_none_does_is_not(open_feed: float, other_feed: float) -> None:
    assert at_rest(POOL, [a_day("a", open_feed)], [a_day("b", other_feed)], CHANNELS) == []


def test_a_position_that_stands_moves_nothing_and_warms_nothing() -> None:
    (told,) = at_rest(POOL, [a_day("a", 5.0)], [a_day("b", 5.0, pos=500.0)], CHANNELS)
    assert (told.channel, told.warms, told.effects) == ("pos", (), ("growth",))
