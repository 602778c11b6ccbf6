"""What is added to a model is fitted within its reach, and what a model has within its bounds."""

from __future__ import annotations

import pytest

from thermodata.modelling.versions.candidate import with_effect
from thermodata.schema.files.model import EffectSpec

from .conftest import Spec


@pytest.mark.parametrize(
    ("given", "bounds"),
    [
        ({}, {"tau": (1.0, 360.0)}),
        ({"bounds": {"tau": (20.0, 40.0)}}, {"tau": (20.0, 40.0)}),
        ({"fixed": {"tau": 30.0}}, {}),
    ],
)
def test_an_effect_that_is_added_may_reach_further_unless_somebody_says_how_far(
    spec: Spec, given: dict[str, object], bounds: dict[str, tuple[float, float]]
) -> None:
    motor = EffectSpec.model_validate({"effect": "spindle_motor", "drivers": {"temperature": "T_motor"}, **given})
    assert with_effect(spec("spindle_bearing"), motor).effects[-1].bounds == bounds


def test_an_effect_without_a_reach_keeps_its_bounds(spec: Spec) -> None:
    nut = EffectSpec.model_validate({"effect": "lag", "drivers": {"u": "T_nut"}})
    assert with_effect(spec("spindle_bearing"), nut).effects[-1] == nut


def test_what_the_model_has_keeps_its_bounds(spec: Spec) -> None:
    nut = EffectSpec.model_validate({"effect": "lag", "drivers": {"u": "T_nut"}})
    model = spec("spindle_bearing", {"effect": "spindle_motor", "drivers": {"temperature": "T_nut"}})
    assert with_effect(model, nut).effects[:-1] == model.effects
