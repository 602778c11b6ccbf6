"""What rankings share, and sums that a batch makes at once: the same numbers as one by one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.basis import basis
from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.diagnosis.chance import chance
from thermodata.diagnosis.cross_validation import Engine, Priors, _of_the_others
from thermodata.diagnosis.investigate import base_columns, remembered_base
from thermodata.diagnosis.problem import Problem
from thermodata.modelling.fit import fit_model
from thermodata.plugin import Drivers, Float2D, Param
from thermodata.schema.model import EffectSpec, Model

from .conftest import make_data
from .hand_made import Parts, PlainEffect, problem

FREE = Priors(np.full(1, np.inf), np.full(1, -np.inf), np.full(1, np.inf))
TAU = Param("tau", "min", 30, 1, 360, "")
EXPONENT = Param("exponent", "1", 1.5, 1.0, 2.5, "")


@dataclass(frozen=True)
class Scaled(PlainEffect):
    """The driver over the time constant; an exponent changes nothing."""

    params: tuple[Param, ...] = (TAU, EXPONENT)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return (drivers.values["u"] / p["tau"])[:, None]


def task(count: int = 3) -> Problem:
    rng = np.random.default_rng(0)
    return problem(
        *(Parts(rng.normal(size=120), values={"T_a": np.cumsum(rng.normal(size=120))}) for _ in range(count))
    )


def test_sums_over_the_others_lose_nothing_where_one_test_has_nearly_all() -> None:
    values = np.array([[1.0], [1e20], [3.0], [5.0]])
    assert _of_the_others(values)[1, 0] == 9.0
    assert _of_the_others(values)[0, 0] == 1e20
    np.testing.assert_array_equal(_of_the_others(values[:2])[:, 0], [1e20, 1.0])


def test_a_score_without_surrogates_is_that_of_the_residuals() -> None:
    rng = np.random.default_rng(0)
    base = [rng.normal(size=(100, 2)) for _ in range(4)]
    engine = Engine(base, [rng.normal(size=(100, 5)) for _ in range(4)], 1.0, np.ones(2))
    grid = [[rng.normal(size=(100, 1)) for _ in range(4)] for _ in range(3)]
    whole, alone = engine.score(grid, FREE), engine.without_surrogates().score(grid, FREE)
    assert alone.after.shape == (4, 1)
    np.testing.assert_allclose(alone.after[:, 0], whole.after[:, 0], rtol=1e-12)
    np.testing.assert_allclose(alone.gains, whole.gains, rtol=1e-12)
    assert alone.best == whole.best


def test_a_point_that_changes_nothing_is_not_ranked_again() -> None:
    found = basis(task(), CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x"))
    assert len(found.points) == 5, "five time constants, four exponents"
    assert {p["exponent"] for p in found.points} == {1.0}, "the first of those alike"
    assert found.middle == 2
    assert [o.shape for o in found.others] == [(120, 5, 2, 1)] * 3


def test_columns_and_chance_are_kept_beside_a_second_effect_and_not_with_other_offsets() -> None:
    one, candidate = task(), CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x")
    made, series = basis(one, candidate), chance(one, 9, 0)
    assert basis(one, candidate) is made
    assert chance(one, 9, 0) is series
    assert chance(one, 9, 1) is not series
    assert basis(one, CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x")) is not made
    cut = one.split({("c", "t0"): [3000.0]})
    assert basis(cut, candidate) is not made
    assert chance(cut, 9, 0) is not series


def test_a_changed_copy_of_a_test_has_its_own_columns_and_leaves_those_of_the_test_alone(spec: Model) -> None:
    two = spec.model_copy(
        update={"effects": [*spec.effects, EffectSpec(effect="ambient_frame", drivers={"temperature": "T_hall"})]}
    )
    data = make_data(lambda c, t: 2.0 * (c["T_hall"] - c["T_hall"][0]), tests=4)
    (response,) = fit_model(two, data, uncertainty=False).responses
    test = data.tests[0]
    moved = replace(test, values={**test.values, "T_hall": np.roll(test.values["T_hall"], 5)})
    base = remembered_base(response)
    for asked in (test, moved, test, data.tests[1], moved):
        np.testing.assert_array_equal(base(asked), base_columns(response, asked))
    assert not np.array_equal(base(test), base(moved))
    np.testing.assert_array_equal(base(test)[:, :2], base(moved)[:, :2])
