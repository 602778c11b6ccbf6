"""An axis whose loop a scale closes: the growth of its screw does not reach the tool (candidates/feedback.py)."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.diagnosis.candidates.feedback import feedback_of_axes
from thermodata.diagnosis.candidates.of_library import candidates
from thermodata.diagnosis.candidates.seen import Seen
from thermodata.effect import effects
from thermodata.errors import PluginError
from thermodata.testing.effect import check_effect
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import a_test

CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", at="tcp"),
        ChannelInfo("T_nut", "temperature", "degC", at="axis.z.nut"),
        ChannelInfo("T_guide", "temperature", "degC", at="axis.z.guide"),
        ChannelInfo("v", "feed", "m/min", at="axis.z"),
        ChannelInfo("v1", "feed", "m/min", at="axis.y1"),
    )
}
SCREWS = {"feed_screw:T_nut", "feed_screw:v", "feed_screw:v1"}


@pytest.mark.parametrize(
    ("feedback", "left_out"),
    [
        ({}, set()),
        ({"z": "scale"}, {"feed_screw:T_nut", "feed_screw:v"}),
        ({"y": "scale"}, {"feed_screw:v1"}),  # the letter of an axis that has two motors
        ({"z": "screw", "x": "scale"}, set()),
    ],
)
def test_a_screw_is_not_asked_of_an_axis_with_a_scale_and_all_else_of_it_is(
    feedback: dict[str, str], left_out: set[str]
) -> None:
    found = {c.id for c in candidates(effects(), CHANNELS, (), "dZ", Seen(feedback=feedback))}
    assert found & SCREWS == SCREWS - left_out
    assert {"guideway:T_guide", "lag:T_nut", "lag:v", "lag:v1"} <= found


@pytest.mark.parametrize(
    ("axis", "feedback", "lesser"),
    [("z", {}, True), ("z", {"z": "scale"}, False), ("z", {"x": "scale"}, True), ("y2", {"y": "scale"}, False)],
)
def test_a_guideway_behind_whose_scale_no_screw_acts_may_be_no_screw(
    axis: str, feedback: dict[str, str], lesser: bool
) -> None:
    """Though no sensor reads that screw; where it might act, it is mostly the screw."""
    guide = ChannelInfo("T_guide", "temperature", "degC", at=f"axis.{axis}.guide")
    channels = {"dZ": CHANNELS["dZ"], "T_guide": guide}
    asked = {c.id: c for c in candidates(effects(), channels, (), "dZ", Seen(feedback=feedback))}
    assert asked["guideway:T_guide"].unread == ((f"axis.{axis}.nut",) if lesser else ())
    assert asked["guideway:T_guide"].lesser is lesser


def test_the_feedback_of_an_axis_is_what_all_tests_declare() -> None:
    said = [{"axes.Z.feedback": "scale", "axes.Y.feedback": second, "tool": "T1"} for second in ("scale", "screw")]
    tests = [replace(a_test(f"t{k}"), conditions=one) for k, one in enumerate(said)]
    assert feedback_of_axes(tests) == {"z": "scale"}
    assert feedback_of_axes([]) == {}


def test_an_effect_names_a_feedback_that_there_is() -> None:
    class Odd(type(effects()["feed_screw"])):  # type: ignore[misc]
        closed_by = "ruler"

    with pytest.raises(PluginError, match="'closed_by' is 'ruler', and no feedback of an axis: scale, screw, motor"):
        check_effect(Odd())
