"""What a prediction does beyond the tests of the fit (predictions/beyond.py)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.predictions.beyond import Beyond, beyond
from thermodata.modelling.predictions.predict import predict
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS

Spec = Callable[..., Model]


def hotter(world: Dataset, times: float) -> Dataset:
    """A test of the fit again, with a nut that rises so many times as far."""
    test = world.tests[0]
    nut = test.values["T_nut"]
    changed = replace(test, test="new", values={**test.values, "T_nut": nut[0] + times * (nut - nut[0])})
    return replace(world, tests=(changed,))


@pytest.fixture(scope="module")
def found(world: Dataset, spec: Spec) -> Callable[[float], list[Beyond]]:
    fitted = fit_model(spec(*EFFECTS), world, uncertainty=False)
    return lambda times: beyond(fitted, world, predict(fitted, hotter(world, times))[0])


def test_an_effect_that_does_more_than_in_any_fitted_test_is_told(found: Callable[[float], list[Beyond]]) -> None:
    (one,) = found(3.0)
    assert (one.test, one.effect, one.drivers, one.unit) == ("new", "feed_screw", ("T_nut",), "um")
    assert one.reaches > 1.5 * one.fitted > 0


@pytest.mark.parametrize("times", [1.0, 0.5])
def test_within_the_fitted_tests_nothing_is_told(times: float, found: Callable[[float], list[Beyond]]) -> None:
    assert found(times) == []


def test_to_the_other_side_is_beyond_too(found: Callable[[float], list[Beyond]]) -> None:
    (one,) = found(-1.0)
    assert one.reaches < 0
    assert abs(one.reaches) > abs(one.fitted)
