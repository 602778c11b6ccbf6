"""An effect of the model whose driver rests in the tests that were fitted: they say nothing of its gain."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.tell.of_version.undetermined import is_unsure, undetermined
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.result import Parameter
from thermodata.schema.answers.undetermined import Undetermined
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset

from .conftest import STEP_S, base, make_data


def of_nut(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
    return lag(2.0 * (channels["T_nut_X"] - channels["T_nut_X"][0]), 2400, STEP_S)


def nut_at_rest(data: Dataset, *but: str) -> Dataset:
    """The nut stays as warm as it is, to a hundredth of a kelvin that it wanders, but in some tests."""
    rng = np.random.default_rng(3)

    def one(test: Any) -> Any:
        wander = 22 + 0.01 * np.cumsum(rng.normal(size=len(test.t_s))) / np.sqrt(len(test.t_s))
        return test if test.test in but else replace(test, values={**test.values, "T_nut_X": wander})

    return replace(data, tests=tuple(map(one, data.tests)))


def with_screw() -> Model:
    screw = EffectSpec(effect="feed_screw", drivers={"temperature": "T_nut_X"})
    return base().model_copy(update={"effects": [*base().effects, screw]})


def asked(data: Dataset, spec: Model) -> list[Undetermined]:
    fitted = fit_model(spec, data)
    return undetermined(fitted, fitted.responses[0], data, fitted.parameters())


def test_an_effect_whose_driver_rests_in_all_fitted_tests_is_told_with_what_it_would_do_elsewhere() -> None:
    (one,) = asked(nut_at_rest(make_data(), "t6"), with_screw())
    assert (one.effect, one.drivers, one.elsewhere) == ("feed_screw", ["T_nut_X"], "t6")
    assert one.elsewhere_um is not None
    assert one.elsewhere_um > 10 * one.does_um
    assert list(one.gains) == ["feed_screw.gain"]
    assert one.left_out_um is not None
    assert one.left_out_without_um is not None
    assert one.left_out_without_um == pytest.approx(one.left_out_um, rel=0.1)


def test_a_test_that_it_is_foretold_badly_in_speaks_for_the_model_without_it() -> None:
    (one,) = asked(nut_at_rest(make_data(), "t5", "t6"), with_screw().model_copy(update={"calibrate_on": ["t0", "t1"]}))
    assert one.left_out_um is not None
    assert one.left_out_without_um is not None
    assert one.left_out_without_um < 0.9 * one.left_out_um


def test_effects_that_the_tests_move_are_told_of_nowhere() -> None:
    assert asked(make_data(of_nut), with_screw()) == []


def test_the_only_effect_of_a_model_is_told_without_errors() -> None:
    """What a model of nothing leaves is the response."""
    spec = with_screw()
    alone = spec.model_copy(update={"effects": spec.effects[1:]})
    (one,) = asked(nut_at_rest(make_data(), "t6"), alone)
    assert (one.left_out_um, one.left_out_without_um) == (None, None)


@pytest.mark.parametrize(
    ("value", "low", "high", "unsure"),
    [
        (2.0, 0.21, 3.79, False),
        (2.0, 0.19, 3.81, True),
        (-2.0, -3.81, -0.19, True),
        (-2.0, -3.79, -0.21, False),
        (2.0, None, 3.0, True),
        (2.0, 1.0, None, False),
        (2.0, None, None, False),
        (0.0, -1.0, 1.0, True),
    ],
)
def test_a_gain_is_unsure_where_it_may_as_well_be_a_tenth(
    value: float, low: float | None, high: float | None, unsure: bool
) -> None:
    assert is_unsure({"a.gain": Parameter(value=value, unit="um/K", low=low, high=high)}) is unsure


def test_one_gain_that_is_sure_makes_an_effect_sure() -> None:
    sure, other = (Parameter(value=2.0, unit="um", low=low, high=4.0) for low in (1.0, -1.0))
    assert not is_unsure({"a.heating": sure, "a.cooling": other})
    assert not is_unsure({})
