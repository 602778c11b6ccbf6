"""An effect of the model with heating and cooling apart, as a candidate (weigh/by_phase.py)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.weigh.by_phase import heating_and_cooling_apart, named_apart
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.errors import UsageError
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.acting import acting, moved_while
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.versions.candidate import phases_id, phases_of, with_candidate, with_phases
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import STEP_S, base, make_data

ID = "phases:spindle_bearing,heating,cooling"
COOLS = (-1.2, 9000.0)  # gain [um/K] and time constant [s] of cooling; heating has -3 and 3000
BOTH = ("heating", "cooling")


def parted(data: Dataset) -> Dataset:
    """The spindle's part of dZ in `make_data`, with another function in cooling and none before the first work."""
    return replace(data, tests=tuple(_parted(t) for t in data.tests))


def _parted(test: TestData) -> TestData:
    heating, cooling = (acting(test, [phase]) for phase in BOTH)
    assert heating is not None
    assert cooling is not None
    u = test.values["T_bearing"] - test.values["T_bearing"][0]
    one = lag(-3.0 * u, 3000.0, STEP_S)
    two = moved_while(one[:, None], heating) + moved_while(lag(COOLS[0] * u, COOLS[1], STEP_S)[:, None], cooling)
    return replace(test, values={**test.values, "dZ": test.values["dZ"] - one + two[:, 0]})


def silent(test: TestData) -> TestData:
    """A test in which nothing tells when the machine works."""
    return replace(test, channels={n: c for n, c in test.channels.items() if n != "spindle_speed"})


def diagnosis(data: Dataset, spec: Model) -> Diagnosis:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis


def response_of(data: Dataset, spec: Model) -> FittedResponse:
    return fit_model(spec, data, uncertainty=False).responses[0]


def asked(data: Dataset, spec: Model, every: Sequence[TestData] | None = None) -> list[str]:
    among = [t for t in data.tests if t.role != "locked"]
    return [c.id for c in heating_and_cooling_apart(response_of(data, spec), among, every or data.tests)]


def with_one(spec: Model, **effect: Any) -> Model:
    return spec.model_copy(update={"effects": [EffectSpec(**effect)]})


@pytest.mark.parametrize(
    "effect",
    [
        {"effect": "spindle_bearing"},
        {"effect": "lag", "id": "spindle_bearing", "drivers": {"u": "T_bearing"}},
        {"effect": "transfer_function", "id": "spindle_bearing", "drivers": {"u": "T_bearing"}, "orders": (2, 1)},
    ],
    ids=["by its name", "as a lag", "as a transfer function"],
)
def test_another_function_in_cooling_is_offered_and_foretells_the_left_out_tests(effect: dict[str, Any]) -> None:
    data, spec = parted(make_data()), with_one(base(), **effect)
    found = diagnosis(data, spec)
    head = found.candidates[0]
    assert found.verdict == "refine"
    assert (head.id, head.phases, head.refinement, head.claimed) == (ID, list(BOTH), True, False)
    assert not any(c.claimed for c in found.candidates)
    assert "acts by another function in cooling than in heating (tau about" in head.why
    assert head.rmse_um_before is not None
    assert head.rmse_um_after is not None
    assert head.rmse_um_after < 0.5 * head.rmse_um_before
    again = fit_model(with_candidate(spec, head.id, data.channels), data, uncertainty=False)
    heating, cooling = again.responses[0].terms
    assert (heating.id, cooling.id) == ("spindle_bearing_heating", "spindle_bearing_cooling")
    assert [sum(t.gains.values()) for t in (heating, cooling)] == pytest.approx([-3.0, COOLS[0]], rel=0.1)
    assert [t.params["tau"] * 60 for t in (heating, cooling)] == pytest.approx([3000.0, COOLS[1]], rel=0.1)
    assert diagnosis(data, again.spec).verdict == "none"


def test_one_function_for_both_is_not_parted(spec: Model) -> None:
    found = diagnosis(make_data(), spec)
    assert found.verdict == "none"
    assert not any(c.refinement for c in found.candidates)


def test_what_it_does_is_taken_back_outside_of_heating_and_done_anew_in_cooling(spec: Model) -> None:
    data = make_data()
    response = response_of(data, spec)
    (found,) = heating_and_cooling_apart(response, data.tests, data.tests)
    test, (term,) = data.tests[0], response.terms
    heating, cooling = (acting(test, [phase]) for phase in BOTH)
    assert heating is not None
    assert cooling is not None
    slow = {"tau": 2 * term.params["tau"]}
    columns = found.in_test(test)(slow)
    assert columns.shape == (len(test.t_s), 2)
    np.testing.assert_allclose(columns[:, 0], moved_while(term.contribution(test)[:, None], ~heating)[:, 0])
    np.testing.assert_allclose(columns[:, 1], moved_while(term.bound.columns(test, slow), cooling)[:, 0])
    assert not found.in_test(silent(test))(slow).any()


@pytest.mark.parametrize(
    "effect",
    [
        {"effect": "spindle_bearing", "phases": ["heating"]},
        {"effect": "spindle_bearing", "fixed": {"gain": -3.0}},
        {"effect": "spindle_bearing", "calibrate_on": ["t0", "t1"]},
        {"effect": "ambient_frame", "drivers": {"temperature": "T_hall"}},
        {"effect": "spindle_heating_cooling", "drivers": {"temperature": "T_bearing", "speed": "spindle_speed"}},
        {"effect": "lag", "drivers": {"u": "spindle_speed"}},
    ],
    ids=["has phases", "is fixed", "identified first", "air", "is a switch", "no temperature"],
)
def test_what_has_phases_or_none_is_not_asked(effect: dict[str, Any], spec: Model) -> None:
    data = make_data()
    assert asked(data, spec) == [ID]
    assert asked(data, with_one(spec, **effect)) == []


def test_every_test_must_tell_its_phases_and_two_must_cool(spec: Model) -> None:
    data = make_data()
    assert asked(data, spec, [*data.tests[:-1], silent(data.tests[-1])]) == []
    response = response_of(data, spec)
    resting = [replace(t, values={**t.values, "spindle_speed": np.zeros(len(t.t_s))}) for t in data.tests]
    cool = [t for t in data.tests if (where := acting(t, ["cooling"])) is not None and where.any()]
    for count, there in ((1, 0), (2, 1)):
        among = [*cool[:count], *resting[count:]]
        assert len(heating_and_cooling_apart(response, among, data.tests)) == there


def test_an_id_says_effect_and_phases() -> None:
    assert phases_id("one", BOTH) == "phases:one,heating,cooling"
    assert phases_of("phases:one, heating,cooling") == ("one", BOTH)
    assert phases_of("gain_by:one,tool") is None


def test_an_effect_is_written_once_for_each_phase_where_it_stood(spec: Model) -> None:
    more = EffectSpec(effect="lag", drivers={"u": "T_tank"})
    wide = spec.model_copy(update={"effects": [*spec.effects, more]})
    grown = with_phases(wide, "spindle_bearing", BOTH)
    assert [(e.effect, e.id, e.phases) for e in grown.effects] == [
        ("spindle_bearing", "spindle_bearing_heating", ["heating"]),
        ("spindle_bearing", "spindle_bearing_cooling", ["cooling"]),
        ("lag", None, None),
    ]
    assert grown.in_sample
    for term, phases, said in (
        ("spindle_bering", BOTH, "spindle_bearing"),
        ("spindle_bearing", ("heating",), "two phases or more"),
        ("spindle_bearing", ("heating", "heating"), "two phases or more"),
    ):
        with pytest.raises(UsageError, match=said):
            with_phases(wide, term, phases)
    with pytest.raises(UsageError, match="some phases only already"):
        with_phases(grown, "spindle_bearing_heating", BOTH)


def test_what_a_user_names_must_be_there(spec: Model) -> None:
    response = response_of(make_data(), spec)
    assert named_apart(response, "spindle_bearing", BOTH).id == ID
    with pytest.raises(UsageError, match="spindle_bering"):
        named_apart(response, "spindle_bering", BOTH)
    with pytest.raises(UsageError, match="heating,cooling"):
        named_apart(response, "spindle_bearing", ("rough", "finish"))
