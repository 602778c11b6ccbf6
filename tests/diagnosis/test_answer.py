"""The whole question on machines whose truth is known."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit import fit_model
from thermodata.schema.model import Model
from thermodata.schema.result import Diagnosis
from thermodata.view.dataset import Dataset

from .conftest import STEP_S, make_data


def diagnosis(data: Dataset, spec: Model) -> Diagnosis:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis


def of_nut(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
    return lag(2.0 * (channels["T_nut_X"] - channels["T_nut_X"][0]), 2400, STEP_S)


def test_a_missing_screw_is_named_with_its_axis_and_holds_on_the_locked_test(spec: Model) -> None:
    found = diagnosis(make_data(of_nut), spec)
    best = found.candidates[0]
    assert found.verdict == "effect"
    assert (best.effect, best.family, best.drivers, best.claimed) == ("feed_screw", "feed_x", ["T_nut_X"], True)
    assert best.rmse_um_after is not None
    assert best.rmse_um_before is not None
    assert best.rmse_um_after < 0.3 * best.rmse_um_before
    assert best.locked_rmse_um_after is not None
    assert best.locked_rmse_um_before is not None
    assert best.locked_rmse_um_after < 0.4 * best.locked_rmse_um_before
    assert best.parameters["feed_screw.gain"].value == np.float64(best.parameters["feed_screw.gain"].value)
    assert 1.5 < best.parameters["feed_screw.gain"].value < 2.5
    assert sum(c.claimed for c in found.candidates) == 1


def test_locked_figures_are_filled_for_the_claim_only(spec: Model) -> None:
    found = diagnosis(make_data(of_nut), spec)
    assert all(c.locked_rmse_um_before is None and not c.parameters for c in found.candidates[1:])


def test_nothing_is_claimed_where_nothing_is_missing(spec: Model) -> None:
    found = diagnosis(make_data(), spec)
    assert found.verdict == "none"
    assert not any(c.claimed for c in found.candidates)


def test_a_cause_that_was_not_logged_stays_unknown(spec: Model) -> None:
    rng = np.random.default_rng(5)

    def unlogged(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        return lag(12.0 * np.repeat(rng.uniform(size=12) > 0.5, len(t) // 12), 3000, STEP_S)

    found = diagnosis(make_data(unlogged), spec)
    assert found.verdict == "unknown"
    assert found.unknown is not None
    assert found.unknown.time_constants_h
    assert not any(c.claimed for c in found.candidates)


def test_one_short_test_is_not_testable(spec: Model) -> None:
    data = make_data(of_nut, tests=2)
    short = [replace(t, in_window=t.t_s < 3600) for t in data.tests]
    found = diagnosis(replace(data, tests=tuple(short)), spec)
    assert found.verdict == "not_testable"
    assert found.next_test is not None


def test_a_slipped_probe_is_an_artefact_and_does_not_hide_the_effect(spec: Model) -> None:
    def slipped(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        still = np.flatnonzero(np.abs(np.diff(channels["spindle_speed"], prepend=0)) > 0)
        at = next(i for i in range(90, len(t) - 40) if np.abs(still - i).min() > 15)
        return of_nut(channels, t) + 6.0 * (np.arange(len(t)) >= at)

    data = make_data(of_nut)
    tests = list(data.tests)
    broken = make_data(slipped).tests[2]
    tests[2] = broken
    found = diagnosis(replace(data, tests=tuple(tests)), spec)
    steps = [a for a in found.artefacts if a.test == broken.test]
    assert len(steps) == 1
    assert steps[0].size_um is not None
    assert abs(steps[0].size_um - 6.0) < 1.0
    assert found.candidates[0].effect == "feed_screw"


def test_what_the_model_has_is_no_candidate(spec: Model) -> None:
    found = diagnosis(make_data(of_nut), spec)
    assert "spindle_bearing:T_bearing" not in [c.id for c in found.candidates]
