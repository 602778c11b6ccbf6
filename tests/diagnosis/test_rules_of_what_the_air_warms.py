"""Whether a body only follows the air that the model has (claims/refinement.py, candidates/warm_at_rest.py)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.candidates.warm_at_rest import part_of, share_at_rest
from thermodata.diagnosis.claims.refinement import Refinement, mode_of
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import Parts, problem, scored
from .test_rules_of_refinement import NOISE, OTHER, ROWS, WAVE, model

NUT = ChannelInfo("T_a", "temperature", "degC", at="axis.z.nut")
FEED = ChannelInfo("v_Z", "feed", "m/min", at="axis.z")
MODE = mode_of(["term0"])


def share(of: float) -> Float1D:
    """What the known effect does makes so much of its square."""
    return np.sqrt(of) * WAVE + np.sqrt(1 - of) * OTHER


def said(
    does: Float1D,
    rests: tuple[float, ...] = (),
    families: str = "ambient",
    lacks: int | None = None,
    twin: dict[str, Any] | None = None,
    **of: Any,
) -> str | None:
    """rests: how far the temperature moves in tests in which the axis stands; it moves by 1 in two others. lacks: the
    test in which it is not logged. twin: what does as much; `of`: the share of it
    that the air makes."""
    parts = [
        Parts(
            100.0 * WAVE,
            base=0.1 * WAVE[:, None],
            slack=WAVE[:, None] + 0.0,
            values={"T_a": far * WAVE, "v_Z": np.full(ROWS, speed)},
            channels={"T_a": NUT, "v_Z": FEED},
        )
        for far, speed in [(1.0, 5.0), (1.0, 4.0), *((far, 0.0) for far in rests)]
    ]
    doing = [does] * len(parts)
    if lacks is not None:
        parts[lacks] = replace(parts[lacks], values={"v_Z": parts[lacks].values["v_Z"]}, channels={"v_Z": FEED})
        doing[lacks] = 0.0 * does
    plain = {"family": "feed_z", "contribution": doing, "after": 0.5, "size": 1.0}
    one = scored(**{**plain, **of})
    twins = {}
    if twin is not None:
        given = {key: value for key, value in twin.items() if key != "of"}
        does_as_well = len(parts) * [share(twin.get("of", 0.9))]
        twins = {id(one.columns): [scored(**{**plain, "contribution": does_as_well, **given})]}
    return Refinement(model(*families.split()), problem(*parts), NOISE, twins)(one)


@pytest.mark.parametrize(("of", "expected"), [(0.81, MODE), (0.79, None), (0.0, None)])
def test_what_the_air_of_the_model_makes_four_fifths_of_is_a_mode_of_that(of: float, expected: str | None) -> None:
    assert said(share(of)) == expected
    assert said(share(of), families="spindle") is None, "a source of heat warms what is near it"


@pytest.mark.parametrize(("evidence", "expected"), [(999.0, MODE), (1001.0, None)])
def test_what_is_as_evident_as_one_a_sample_is_a_cause_whatever_it_follows(
    evidence: float, expected: str | None
) -> None:
    assert said(share(0.9), evidence=evidence) == expected


@pytest.mark.parametrize(
    ("twin", "expected"),
    [
        ({"channels": ("v_Z",), "of_motion": True}, None),
        ({"channels": ("T_a",), "of": 0.79}, None),  # of another temperature there
        ({"channels": ("T_a",), "of": 0.81}, MODE),
    ],
)
def test_what_another_of_its_part_does_as_well_that_follows_no_air_is_a_cause(
    twin: dict[str, Any], expected: str | None
) -> None:
    assert said(share(0.9), twin=twin) == expected


def test_only_one_temperature_of_a_body_follows_the_air() -> None:
    assert said(share(0.9), channels=("T_a", "T_b")) is None, "a difference has a name of its own"
    assert said(share(0.9), channels=("v_Z",)) is None, "a motion is no body"
    assert said(share(0.9), family="ambient") is None, "other air is another air"


@pytest.mark.parametrize(
    ("of", "rests", "expected"),
    [
        (0.51, (0.51,), MODE),
        (0.51, (0.49,), None),
        (0.49, (0.9,), None),
        (0.51, (0.9, 0.1, 0.1), None),
        (0.51, (), None),
    ],
)
def test_half_suffices_of_a_part_that_moves_half_as_far_at_rest(
    of: float, rests: tuple[float, ...], expected: str | None
) -> None:
    """By the median of tests; where the axis moves in all of them nobody can tell."""
    assert said(share(of), rests) == expected


@pytest.mark.parametrize("lacks", [0, 1])
def test_a_test_that_lacks_its_channel_says_nothing_of_what_it_follows(lacks: int) -> None:
    assert said(share(0.9), lacks=lacks) == MODE
    assert said(share(0.7), lacks=lacks) is None


def test_what_moves_at_its_part_is_told_by_the_place() -> None:
    assert part_of("axis.Z.nut") == "axis.z"
    assert part_of("spindle.bearing.front") == "spindle"
    assert part_of(None) is None
    tests = [_test(1.0, 5.0), _test(0.25, 0.0)]
    assert share_at_rest("T_a", tests) == pytest.approx(0.25)
    assert share_at_rest("T_b", tests) is None, "not logged"
    elsewhere = [replace(t, channels={**t.channels, "v_Z": replace(FEED, at="axis.x")}) for t in tests]
    assert share_at_rest("T_a", elsewhere) is None, "another axis says nothing of it"


def _test(far: float, speed: float) -> TestData:
    t_s = 60.0 * np.arange(ROWS)
    values = {"T_a": far * WAVE, "v_Z": np.full(ROWS, speed)}
    valid = {name: np.ones(ROWS, dtype=np.bool_) for name in values}
    channels = {"T_a": NUT, "v_Z": FEED}
    return TestData("c", f"t{speed}", "mixed", "calibration", t_s, values, valid, valid["T_a"], channels=channels)
