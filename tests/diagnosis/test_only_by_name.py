"""What the user may ask for, and diagnosis does not by itself (candidates/by_name.py)."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.candidates.by_name import only_by_name
from thermodata.diagnosis.question.present import Present
from thermodata.effect import effects
from thermodata.effect.registry import all_effects
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import a_test

HEAD = ChannelInfo("T_head", "temperature", "degC", at="headstock")
CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("dY", "displacement", "um", at="tcp"),
        HEAD,
        ChannelInfo("T_air", "temperature", "degC", at="ambient"),
        ChannelInfo("pos_z", "position", "mm", at="axis.z"),
        ChannelInfo("pos_x", "position", "mm", at="axis.x"),
    )
}
UNASKED = [one for name, one in all_effects().items() if name not in effects()]


def with_heights(heights: list[float]) -> TestData:
    rows = len(heights)
    warm = {"T_head": np.linspace(20, 25, rows), "T_air": np.linspace(20, 21, rows)}
    return a_test(n=rows, values={**warm, "pos_z": np.array(heights)})


@pytest.mark.parametrize(("heights", "named"), [([100.0, 400.0, 100.0], True), ([100.0] * 3, False)])
def test_the_same_heat_at_two_positions_may_be_asked_for_by_name(heights: list[float], named: bool) -> None:
    found = only_by_name(UNASKED, CHANNELS, [with_heights(heights)], "dY")
    assert found == (["overhang:T_head,pos_z"] if named else [])


def test_what_the_model_has_is_not_named_again() -> None:
    has = [Present("overhang", frozenset({"T_ram", "pos_z"}), "overhang"), Present("guideway", frozenset({"pos_z"}))]
    test = with_heights([100.0, 400.0])
    assert not only_by_name(UNASKED, CHANNELS, [test], "dY", has)
    assert only_by_name(UNASKED, CHANNELS, [test], "dY", has[1:])


def test_a_sensor_that_failed_is_none_to_ask_for() -> None:
    failed = {**CHANNELS, "T_head": ChannelInfo("T_head", "temperature", "degC", at="headstock", faulty="stuck")}
    assert not only_by_name(UNASKED, failed, [with_heights([100.0, 400.0])], "dY")


def test_artefacts_and_what_is_asked_for_anyway_are_not_named() -> None:
    channels = {**CHANNELS, "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle")}
    test = a_test(n=2, values={"n": np.array([0.0, 3000.0])})
    assert "runout_alias" in {one.name for one in UNASKED}
    assert not only_by_name(UNASKED, channels, [test], "dY")
