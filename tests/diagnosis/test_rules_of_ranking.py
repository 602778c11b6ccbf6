"""How evidence is weighed against chance, and which priors it has (diagnosis/rank.py and whiten.py)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from thermodata.diagnosis import rank as ranking
from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.diagnosis.cross_validation import Drop, Engine, Priors
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.rank import _no_larger_than, _order, rank
from thermodata.diagnosis.whiten import fit_ar, surrogates, whiten
from thermodata.plugin import Float1D, Float2D, Param
from thermodata.view.dataset import ChannelInfo

from .hand_made import Parts, PlainEffect, problem, scored

# ---- chance


def chances(drop: float, white_drop: float, top_raw: Sequence[float], top_white: Sequence[float]) -> float:
    one = scored(drop=drop, white_drop=white_drop)
    return _order([one], np.asarray(top_raw, dtype=float), np.asarray(top_white, dtype=float))[0].p_value


def tops(better: int, of: int = 199, drop: float = 0.5) -> list[float]:
    """The best of all candidates on each surrogate: as many are better."""
    return [drop + 0.1] * better + [drop - 0.1] * (of - better)


@pytest.mark.parametrize(("raw", "white", "p_value"), [(0, 199, 0.01), (1, 199, 0.02), (2, 199, 0.03), (199, 1, 0.02)])
def test_the_better_of_two_looks_counts_doubled(raw: int, white: int, p_value: float) -> None:
    assert chances(0.5, 0.5, tops(raw), tops(white)) == pytest.approx(p_value)


def test_chance_is_at_most_certain_and_never_nothing() -> None:
    assert chances(0.5, 0.5, tops(199), tops(199)) == 1.0
    assert chances(0.5, 0.5, tops(0), tops(0)) == pytest.approx(2 / 200)


def test_a_surrogate_that_does_as_well_counts_against_it() -> None:
    assert chances(0.5, 0.5, [0.5, *tops(0, 198)], tops(199)) == pytest.approx(2 * 2 / 200)


def test_the_order_is_the_sum_of_both_ranks_and_the_measured_one_breaks_ties() -> None:
    evidence = {"a": (0.9, 0.1), "b": (0.8, 0.9), "c": (0.7, 0.8), "d": (0.6, 0.7)}
    made = [scored(n, drop=d, white_drop=w) for n, (d, w) in evidence.items()]
    found = _order(made, np.zeros(9), np.zeros(9))
    assert [s.candidate.effect.name for s in found] == ["b", "a", "c", "d"]
    assert [s.candidate.effect.name for s in _order(made[::-1], np.zeros(9), np.zeros(9))] == ["b", "a", "c", "d"]
    assert _order([], np.zeros(9), np.zeros(9)) == []


def test_surrogates_are_as_large_as_the_residual_and_start_from_its_mean() -> None:
    x = np.random.default_rng(0).normal(3.0, 2.0, 101)
    made = surrogates(x, 20, np.random.default_rng(1))
    assert made.shape == (101, 20)
    np.testing.assert_allclose(np.sqrt(np.mean(made**2, axis=0)), x.std(), rtol=1e-9)
    np.testing.assert_allclose(made.mean(axis=0), 0.0, atol=1e-9)


def test_whitening_by_three_samples_of_the_past() -> None:
    rng = np.random.default_rng(0)
    x = np.zeros(20_000)
    e = rng.normal(size=20_000)
    for i in range(3, 20_000):
        x[i] = 0.5 * x[i - 1] + 0.2 * x[i - 2] + 0.2 * x[i - 3] + e[i]
    assert fit_ar([x]) == pytest.approx([0.5, 0.2, 0.2], abs=0.03)
    assert fit_ar([x[:6]]).tolist() == [0.0, 0.0, 0.0], "what is as short as twice the past says nothing"
    assert fit_ar([x[:7]]).any()
    white = whiten(np.arange(1.0, 7.0)[:, None], np.array([0.5, 0.2, 0.2]))
    assert white[:3, 0].tolist() == [0.0, 0.0, 0.0]
    assert white[3, 0] == pytest.approx(4.0 - 0.5 * 3.0 - 0.2 * 2.0 - 0.2 * 1.0)


def test_a_contribution_is_at_most_three_times_as_large_as_the_response() -> None:
    columns = [[np.array([[0.1, 2.0], [-0.4, 0.0]])], [np.array([[0.2, -0.5], [0.0, 0.0]])]]
    wide = Priors(np.full(2, 1e9), np.full(2, -np.inf), np.full(2, np.inf))
    found = _no_larger_than(wide, columns, 2.0)
    assert found.upper.tolist() == pytest.approx([15.0, 3.0])
    assert found.lower.tolist() == pytest.approx([-15.0, -3.0])
    assert found.spread.tolist() == pytest.approx([15.0, 3.0])
    narrow = Priors(np.full(2, 1.0), np.full(2, 0.0), np.full(2, 2.0))
    kept = _no_larger_than(narrow, columns, 2.0)
    assert (kept.spread.tolist(), kept.lower.tolist(), kept.upper.tolist()) == ([1, 1], [0, 0], [2, 2])


# ---- what rank hands to it

T_A = ChannelInfo("T_a", "temperature", "degC", at="axis.x.nut")


def driven(rng: np.random.Generator, n: int = 150) -> Parts:
    u = np.cumsum(rng.normal(size=n))
    u -= u[0]
    y = 2.0 * (u - u.mean()) + 0.01 * rng.normal(size=n)
    base, slack = rng.normal(size=(n, 2)), rng.normal(size=(n, 1))
    return Parts(y, base=base, slack=slack, values={"T_a": u, "T_still": np.ones(n)}, channels={"T_a": T_A})


def asked(name: str = "screw", channel: str = "T_a", params: tuple[Param, ...] = ()) -> CandidateEffect:
    return CandidateEffect(PlainEffect(name, params=params), {"u": channel}, "feed_x")


def four(count: int = 4) -> Problem:
    rng = np.random.default_rng(0)
    return problem(*(driven(rng) for _ in range(count)))


def test_a_cause_is_found_with_its_gain_and_the_least_chance_there_is() -> None:
    (found,) = rank(four(), [asked()])
    assert found.gain == pytest.approx([2.0], rel=0.1)
    assert found.drop > 0.99
    assert found.p_value == pytest.approx(0.01), "199 surrogates, two looks"
    assert np.linalg.norm(found.shape) == pytest.approx(1.0)
    assert found.size == pytest.approx(np.sqrt(np.mean(np.concatenate(four().response_blocks) ** 2)), rel=0.1)


def test_a_driver_that_never_moves_is_not_ranked() -> None:
    assert [s.candidate.id for s in rank(four(), [asked("still", "T_still"), asked()])] == ["screw:T_a"]


def test_beside_a_first_effect_a_second_one_is_asked_for() -> None:
    """The first is then one of the known effects: it may grow, and act faster and slower at a price."""
    task = four()
    (found,) = rank(task, [asked(params=(Param("tau", "min", 30, 1, 360, ""),))])
    more = task.with_effect(found)
    for old, new in zip(task.blocks, more.blocks, strict=True):
        assert (new.base.shape[1], new.slack.shape[1]) == (old.base.shape[1] + 1, old.slack.shape[1] + 2)
        u = new.test.values["T_a"]
        np.testing.assert_allclose(new.base[:, -1], found.gain * (u - u.mean()))
        np.testing.assert_array_equal(new.residual, old.residual)
    left = rank(more, [asked("again"), asked("other")])
    assert all(s.sse_before.sum() < 0.01 * found.sse_before.sum() for s in left)


@pytest.mark.parametrize(("tests", "ranked"), [(1, 0), (2, 1)])
def test_leaving_one_test_out_needs_two(tests: int, ranked: int) -> None:
    assert len(rank(four(tests), [asked()])) == ranked
    assert rank(four(), []) == []


class Recorded(Engine):
    """Keeps what an engine is made of and asked for."""

    made: list[Recorded] = []
    priors: list[Priors] = []

    def __init__(self, base: Sequence[Float2D], residuals: Sequence[Float2D], noise_var: float, price: Float1D) -> None:
        super().__init__(base, residuals, noise_var, price)
        self.asked_price = price
        Recorded.made.append(self)

    def score(self, grid: Sequence[Sequence[Float2D]], priors: Priors) -> Drop:
        Recorded.priors.append(priors)
        return super().score(grid, priors)


def test_prices_and_priors_are_those_that_were_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    """A known effect may move by its own size, half of it with another time constant; 30 independent samples."""
    monkeypatch.setattr(ranking, "Engine", Recorded)
    Recorded.made, Recorded.priors = [], []
    task = four()
    rank(task, [asked(params=(Param("tau", "min", 30, 1, 360, ""),))])
    raw, white = Recorded.made
    assert raw.asked_price.tolist() == white.asked_price.tolist() == [1.0, 1.0, 4.0]
    whole = np.concatenate([b.residual for b in task.blocks])
    assert raw.noise_var == pytest.approx(30.0 * np.mean(whole**2))
    assert white.noise_var == pytest.approx(30.0 * np.mean(np.concatenate([r[:, 0] for r in white.residuals]) ** 2))
    assert white.noise_var < 0.1 * raw.noise_var
    assert {r.shape[1] for r in raw.residuals} == {200}
    for number, one in enumerate(task.blocks):
        np.testing.assert_array_equal(raw.residuals[number][:, 0], one.residual)
    rough, *full = Recorded.priors
    assert len(rough.spread) == 1
    assert [p.spread[1:].tolist() for p in full] == [[0.5, 0.5]] * 2
    assert [np.isinf(p.lower[1:]).all() and np.isinf(p.upper[1:]).all() for p in full] == [True, True]
