"""A difference of two temperatures is claimed where what they differ by acts, and not what they share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.weigh.difference import is_difference, with_sides
from thermodata.effect import effect as find_effect
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import STEP_S, N, base, make_data
from .hand_made import columns_of

SIDES = {
    "T_front": ChannelInfo("T_front", "temperature", "degC", at="column.front"),
    "T_rear": ChannelInfo("T_rear", "temperature", "degC", at="column.rear"),
}


def candidate(effect: str, **drivers: str) -> CandidateEffect:
    found = find_effect(effect)
    return CandidateEffect(found, drivers, found.family)


def test_only_what_two_temperatures_differ_by_has_sides_and_only_where_both_are_asked_themselves() -> None:
    bend = candidate("column_bending", warm_side="T_rear", cold_side="T_front")
    alone = [candidate("lag", u=name) for name in ("T_rear", "T_front")]
    pool = [columns_of(c, [np.ones(4)]) for c in (bend, *alone)]
    assert [s.candidate.id for s in with_sides(pool)[0].sides] == ["lag:T_rear", "lag:T_front"]
    assert [c.sides for c in with_sides(pool)[1:]] == [(), ()]
    assert with_sides(pool[:2])[0].sides == ()
    assert not is_difference(candidate("coolant_heat", temperature="T_tank", state="pump"))
    assert not is_difference(candidate("spindle_bearing", temperature="T_rear"))


def with_column(test: TestData, seed: int, *, bends: bool) -> TestData:
    """A column whose sides follow the hall; the rear is warmed from time to time where it bends."""
    rng = np.random.default_rng([30, seed])
    hall = test.values["T_hall"] - test.values["T_hall"][0]
    heat = np.repeat(rng.choice([0.0, 4.0], 6), N // 6) * bends
    body = {n: lag(hall, tau, STEP_S) for n, tau in (("T_front", 5400.0), ("T_rear", 7200.0))}
    body["T_rear"] = body["T_rear"] + lag(heat, 5400, STEP_S)
    differ = body["T_rear"] - body["T_front"]
    moved = 4.0 * differ if bends else 3.0 * (body["T_rear"] + body["T_front"])
    read = {n: 21.0 + v + rng.normal(0, 0.02, N) for n, v in body.items()}
    values = {**test.values, **read, "dZ": test.values["dZ"] + lag(moved, 1200, STEP_S)}
    valid = {**test.valid, **{n: np.ones(N, bool) for n in read}}
    return replace(test, values=values, valid=valid, channels={**test.channels, **SIDES})


def of_a_column(*, bends: bool) -> Diagnosis:
    """The hall itself is not logged, so the column is all that tells of it."""
    made = make_data(without=("T_hall",))
    tests = tuple(with_column(t, i, bends=bends) for i, t in enumerate(made.tests))
    tests = tuple(replace(t, channels={n: c for n, c in t.channels.items() if n != "T_hall"}) for t in tests)
    data = Dataset(STEP_S, tests, {**made.channels, **SIDES})
    return answer(fit_model(base(), data, uncertainty=False), data, effects(), "m").diagnosis


def test_a_column_that_bends_is_claimed() -> None:
    claimed = [c.effect for c in of_a_column(bends=True).candidates if c.claimed]
    assert claimed == ["column_bending"]


def test_one_that_grows_on_both_sides_alike_does_not_bend() -> None:
    assert "column_bending" not in [c.effect for c in of_a_column(bends=False).candidates if c.claimed]
