"""What is asked again once the lock is open: without turned probes, and without what the locked tests refuse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .conftest import base, make_data
from .test_answer import of_nut


def with_a_stand_in(noise_K: float, besides_um: float = 0.0) -> Dataset:
    """The tank goes with the nut in all open tests, and against it in the locked one; the nut's sensor is noisy.
    besides_um: of what nobody logged in the locked test."""
    data = make_data(of_nut)
    tests = []
    for i, t in enumerate(data.tests):
        nut = t.values["T_nut_X"] + np.random.default_rng(i).normal(0, noise_K, len(t.t_s))
        tank = 30 + (t.values["T_nut_X"] - 22) * (-1 if t.role == "locked" else 1)
        of = {"T_nut_X": nut, "T_tank": tank}
        if t.role == "locked":
            of["dZ"] = t.values["dZ"] + besides_um * np.sin(2 * np.pi * t.t_s / 9000.0)
        tests.append(replace(t, values={**t.values, **of}))
    return replace(data, tests=tuple(tests))


def test_what_the_locked_tests_refuse_does_not_stand_in_the_way_of_what_they_bear_out(spec: Model) -> None:
    data = with_a_stand_in(noise_K=1.5)
    answered = answer(fit_model(spec, data, uncertainty=False), data, effects(), "m")
    assert ["hydraulics:T_tank" in look.asked for look in answered.looks] == [True, False], "each look counts"
    assert [[t.test for t in look.tests] for look in answered.looks] == [["t6"], ["t6"]]
    found = answered.diagnosis
    assert (found.verdict, [c.id for c in found.candidates if c.claimed]) == ("effect", ["feed_screw:T_nut_X"])
    refused = next(c for c in found.candidates if c.id == "hydraulics:T_tank")
    assert "the locked ones do not bear it out" in refused.why


def test_a_second_look_that_takes_less_than_half_of_the_error_claims_nothing(spec: Model) -> None:
    data = with_a_stand_in(noise_K=1.5, besides_um=5.0)
    answered = answer(fit_model(spec, data, uncertainty=False), data, effects(), "m")
    assert ["feed_screw:T_nut_X" in look.asked for look in answered.looks] == [False, True]
    assert (answered.diagnosis.verdict, [c.id for c in answered.diagnosis.candidates if c.claimed]) == ("unknown", [])


def test_a_probe_that_is_turned_in_a_locked_test_is_said_and_refuses_nothing() -> None:
    data = make_data(of_nut, tests=8)
    t6, t7 = data.tests[6:]
    turned = replace(t7, values={**t7.values, "dZ": -t7.values["dZ"]})
    data = replace(data, tests=(*data.tests[:6], replace(t6, role="locked"), turned))
    answered = answer(fit_model(base(), data, uncertainty=False), data, effects(), "m")
    found = answered.diagnosis
    assert [(a.kind, a.test) for a in found.artefacts] == [("sign", "t7")]
    assert found.put_right is not None
    assert found.put_right.left_out == [("c", "t7")]
    assert [c.id for c in found.candidates if c.claimed] == ["feed_screw:T_nut_X"]
    assert [[t.test for t in look.tests] for look in answered.looks] == [["t6", "t7"], ["t6"]]
    best = found.candidates[0]
    assert best.locked_rmse_um_after is not None
    assert best.locked_rmse_um_before is not None
    assert best.locked_rmse_um_after < 0.4 * best.locked_rmse_um_before
