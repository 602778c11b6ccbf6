"""A cause that one axis hardly shows and another one plainly, from the data to the answer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.diagnosis import Diagnosis

from .conftest import CHANNELS, base, make_data
from .test_answer import of_nut

X = replace(CHANNELS["dZ"], name="dX", axis="X")


@pytest.fixture(scope="module")
def on_two_axes() -> dict[bool, Diagnosis]:
    """A screw in a drift along Z, and plain along X; with dX and without."""
    found = {}
    for logged in (True, False):
        rng = np.random.default_rng(3)

        def add(channels: dict[str, Any], t: np.ndarray, rng: np.random.Generator = rng) -> np.ndarray:
            slow = np.cumsum(rng.normal(0, 0.15, len(t)))
            return 0.5 * of_nut(channels, t) + slow - slow.mean()

        data = make_data(add, tests=5)
        tests = []
        for i, test in enumerate(data.tests):
            own = np.random.default_rng(100 + i)
            bearing = test.values["dZ"] * 0 + 2 * (test.values["T_bearing"] - test.values["T_bearing"][0])
            values = {
                **test.values,
                "dX": bearing + of_nut(dict(test.values), test.t_s) + own.normal(0, 0.1, len(bearing)),
            }
            valid = {**test.valid, "dX": np.ones(len(bearing), bool)}
            channels = {**CHANNELS, "dX": X} if logged else CHANNELS
            if test.role != "locked":  # they would speak for it, too
                tests.append(replace(test, values=values, valid=valid, channels=channels))
        data = replace(data, tests=tuple(tests), channels={**CHANNELS, "dX": X} if logged else CHANNELS)
        found[logged] = answer(fit_model(base(), data, uncertainty=False), data, effects(), "m").diagnosis
    return found


def test_a_weak_cause_is_claimed_where_another_axis_misses_it_plainly(on_two_axes: dict[bool, Diagnosis]) -> None:
    with_x, without = on_two_axes[True], on_two_axes[False]
    assert without.candidates[0].effect == "feed_screw"
    assert not any(c.claimed for c in without.candidates)
    (claim,) = (c for c in with_x.candidates if c.claimed)
    assert claim.effect == "feed_screw"
    assert claim.also_on["dX"] > 0.9
    assert "dX misses it as well (" in claim.why
