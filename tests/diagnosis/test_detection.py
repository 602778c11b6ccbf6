"""How large an effect must be to be claimed (claims/detection.py)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.claims.detection import Limit, of_each_effect
from thermodata.diagnosis.claims.probability import CLAIMED, probability, sharpness_asked
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.diagnosis import DetectionLimit, Diagnosis
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import STEP_S, base, make_data
from .hand_made import scored

SCREW = "feed_screw:T_nut_X"
Add = Callable[[dict[str, Any], np.ndarray], np.ndarray]


def diagnosed(data: Dataset) -> Diagnosis:
    return answer(fit_model(base(), data, uncertainty=False), data, effects(), "m").diagnosis


def limit(found: Diagnosis, name: str = SCREW) -> DetectionLimit:
    return next(one for one in found.limits if one.id == name)


def slow(u: dict[str, Any], t: np.ndarray) -> np.ndarray:
    """Slow noise that every test has: without any, all is seen."""
    rng = np.random.default_rng(int(1000 * u["T_bearing"][5]))
    return np.asarray(lag(rng.normal(0, 12.0, len(t)), 3600, STEP_S))


def screw(size: float) -> Add:
    """Beside slow noise a screw of some RMS, in every test."""

    def add(u: dict[str, Any], t: np.ndarray) -> np.ndarray:
        shape = lag(u["T_nut_X"] - u["T_nut_X"][0], 2400, STEP_S)
        return slow(u, t) + size * shape / max(float(shape.std()), 1e-9)

    return add


def test_what_heads_the_list_is_not_said_to_be_hidden() -> None:
    """It is selected, and hides itself: that a known effect does nearly all of it would contradict the list."""
    found = diagnosed(make_data(screw(3.5)))
    assert (found.verdict, found.candidates[0].id) == ("unknown", SCREW)
    assert found.limits, "others are told"
    assert SCREW not in [one.id for one in found.limits]


def test_what_exceeds_its_limit_is_claimed_and_what_does_not_is_not() -> None:
    nothing = diagnosed(make_data(slow))
    assert nothing.verdict != "effect"
    least = limit(nothing).least_um
    assert least is not None
    for times, claimed in ((0.5, False), (2.0, True)):
        found = diagnosed(make_data(screw(times * least)))
        assert [c.id for c in found.candidates if c.claimed] == ([SCREW] if claimed else []), times
        assert bool(found.limits) is not claimed, "told where nothing is claimed"


def following(test: TestData) -> TestData:
    """The nut as warm as the bearing, but for noise."""
    noise = np.random.default_rng(len(test.test)).normal(0, 0.02, len(test.t_s))
    return replace(test, values={**test.values, "T_nut_X": test.values["T_bearing"] + noise})


def test_what_moves_with_a_known_effect_hides_behind_it() -> None:
    apart = make_data(slow)
    together = replace(apart, tests=tuple(following(t) for t in apart.tests))
    found = diagnosed(together)
    alone, hidden = limit(diagnosed(apart)), limit(found)
    assert (alone.seen > 0.5, alone.behind) == (True, None)
    assert (hidden.seen < 0.1, hidden.behind, hidden.large) == (True, "spindle_bearing", True)
    if found.verdict in ("none", "refine"):
        assert "which spindle_bearing would hide: a test in which" in (found.next_test or "")
    assert hidden.least_um is None or hidden.least_um > 3 * (alone.least_um or 0)


def test_the_limits_are_of_names_that_the_model_lacks() -> None:
    found = diagnosed(make_data(slow))
    assert {one.effect for one in found.limits}.isdisjoint({"lag", "spindle_bearing", "control_compensation"})
    sizes = [np.inf if one.least_um is None else one.least_um for one in found.limits]
    assert sizes == sorted(sizes, reverse=True)


@pytest.mark.parametrize("fall", [0.0, 0.5])
def test_the_sharpness_that_a_claim_asks_makes_it_as_probable(fall: float) -> None:
    one = scored(evidence=1000 * sharpness_asked(fall, scored().candidate), after=1 - fall)
    assert probability(one) == pytest.approx(CLAIMED)


def test_of_each_effect_the_sensor_that_shows_it_best_is_told_and_advised() -> None:
    """As `could_hide` tells them: another sensor of the same effect hides no more."""
    near, far, other = (
        Limit(scored(name, family="feed_x", channels=(channel,)).candidate, least, 0.1, 0)
        for name, channel, least in (("screw", "T_nut_X", 2.0), ("screw", "feed_X", 9.0), ("motor", "T_motor_X", 4.0))
    )
    assert of_each_effect([far, other, near]) == [other, near]
