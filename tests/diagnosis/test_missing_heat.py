"""A heat that nobody logged is found again where it is known: missing_heat.py, one_way.py."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.unlogged import missing_heat as module
from thermodata.diagnosis.unlogged.missing_heat import MissingHeat, counted, missing_heat
from thermodata.diagnosis.unlogged.one_way import Normal, solve
from thermodata.diagnosis.unlogged.source_steps import box_columns
from thermodata.effect.lag import lag
from thermodata.plugin import Float1D

from .hand_made import STEP_S, Parts, problem

ROWS = 480  # 8 h of 60 s


def square(rng: np.random.Generator, low: float = 0.0) -> Float1D:
    """A source that is off half of the time, each level held for 40 to 100 min."""
    levels = rng.choice([low, low, low + 8.0, low + 14.0], 20)
    return np.asarray(np.repeat(levels, rng.integers(40, 100, 20))[:ROWS], dtype=np.float64)


def sources(seed: int, tests: int = 6, low: float = 0.0) -> list[Float1D]:
    rng = np.random.default_rng(seed)
    return [square(rng, low) for _ in range(tests)]


def left_by(source: list[Float1D], tau_s: float, sign: int = 1, noise: float = 0.1) -> Problem:
    rng = np.random.default_rng(99)
    made = [sign * lag(q, tau_s, STEP_S) + noise * rng.standard_normal(len(q)) for q in source]
    return problem(*(Parts(d - d.mean()) for d in made), noise=noise)


def found_in(asked: Problem) -> MissingHeat:
    heat = missing_heat(asked)
    assert heat is not None
    return heat


@cache
def heat_of(tau_s: float, sign: int, /) -> MissingHeat:
    """What is found of the same sources: several tests look at it."""
    return found_in(left_by(sources(1), tau_s, sign))


def beside(heat: MissingHeat, source: list[Float1D]) -> tuple[Float1D, Float1D]:
    """The estimated and the true source at the middle of each step, all tests in a row."""
    true = [
        np.interp(c.from_s + c.step_s * (np.arange(len(c.source)) + 0.5), np.arange(ROWS) * STEP_S, q)
        for c, q in zip(heat.courses, source, strict=True)
    ]
    return np.concatenate([c.source for c in heat.courses]), np.concatenate(true)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("tau_s", [1200.0, 2400.0, 7200.0])
def test_a_square_wave_through_a_lag_is_found_again(tau_s: float, sign: int) -> None:
    source, heat = sources(1), heat_of(tau_s, sign)
    assert heat.sign == sign
    assert heat.agreed == 1.0
    assert heat.tau_s == pytest.approx(tau_s, rel=0.1), "within half a point of the grid"
    assert heat.tau_range_s[0] <= heat.tau_s <= heat.tau_range_s[1] < 1.8 * tau_s
    estimated, true = beside(heat, source)
    assert np.corrcoef(estimated, true)[0, 1] > 0.97
    assert np.mean(np.abs(estimated - true)) < 0.6
    assert heat.explained > 0.999
    assert heat.predicted > 0.98


def test_what_was_left_out_does_not_count_as_predicted() -> None:
    """A source that turns on and off within the parts that are left out is explained where it is seen alone."""
    rng = np.random.default_rng(3)
    source = [np.repeat(rng.choice([0.0, 9.0], ROWS // 12), 12) for _ in range(6)]
    heat = found_in(left_by(source, 1200.0))
    assert heat.explained > 0.99
    assert 0.6 < heat.predicted < 0.9


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_a_source_is_never_negative(seed: int) -> None:
    heat = found_in(left_by(sources(seed), 2400.0, noise=0.5))
    assert heat.sign
    assert min(float(c.source.min()) for c in heat.courses) >= 0.0


def test_the_contribution_is_the_source_through_the_lag_from_its_mean() -> None:
    heat = heat_of(2400.0, -1)
    for course in heat.courses:
        middle = course.from_s + course.step_s * (np.arange(len(course.source)) + 0.5)
        edges = course.from_s + course.step_s * np.arange(len(course.source) + 1)
        gone = -box_columns(middle, edges, heat.tau_s) @ course.source
        assert np.ptp(course.contribution - gone) < 1e-9
        assert abs(course.contribution.mean()) < 0.2
        assert np.sqrt(np.mean((course.contribution - course.residual) ** 2)) < 0.3


@pytest.mark.parametrize(("small", "count"), [(0.026, 4), (0.024, 1)])
def test_a_change_over_a_twentieth_of_the_typical_one_is_a_parameter(small: float, count: int) -> None:
    """The typical one, of one change of 1 among four, is 0.5; steps that a test has not have none."""
    changes, there = np.zeros((2, 4)), np.array([[True] * 4, [False] * 4])
    changes[0] = (small, 1.0, small, small)
    assert counted(changes, there).tolist() == [count, 0]


def test_a_residual_that_does_not_move_gives_nothing() -> None:
    assert missing_heat(problem(*[Parts(np.zeros(ROWS))] * 4)) is None
    assert missing_heat(problem()) is None


@pytest.mark.parametrize("size", [0.1, 1.0])
def test_white_noise_gives_nothing(size: float) -> None:
    rng = np.random.default_rng(5)
    assert missing_heat(problem(*(Parts(size * rng.standard_normal(ROWS)) for _ in range(4)), noise=0.1)) is None


def test_a_source_that_noise_hides_is_not_told() -> None:
    assert heat_of(2400.0, 1)
    assert missing_heat(left_by(sources(1), 2400.0, noise=30.0)) is None


def test_a_source_that_goes_both_ways_has_no_direction() -> None:
    """From 0 to 14 it heats; from -7 to 7 it is a temperature, and neither sign explains it alone."""
    assert heat_of(2400.0, 1).sign
    assert not found_in(left_by(sources(1, low=-7.0), 2400.0)).sign


def test_a_drift_has_no_direction() -> None:
    rng = np.random.default_rng(0)
    walks = [0.1 * np.cumsum(rng.standard_normal(ROWS)) for _ in range(6)]
    heat = found_in(problem(*(Parts(w - w.mean()) for w in walks), noise=0.1))
    assert heat.sign == 0


@pytest.mark.parametrize(("side", "told"), [(0.55, True), (50.0, False)])
def test_a_direction_is_told_where_the_other_explains_much_less(
    side: float, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "ONE_SIDED", side)
    assert bool(found_in(left_by(sources(1), 2400.0)).sign) is told


def test_what_one_lag_leaves_of_a_distributed_body_does_not_choose_the_time_constant(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two thirds act with 80 min and one third with 13 min: without the floor small steps imitate the slow part."""
    source = sources(1)
    rng = np.random.default_rng(9)
    made = [(2 * lag(q, 4800.0, STEP_S) + lag(q, 800.0, STEP_S)) / 3 + 0.02 * rng.standard_normal(ROWS) for q in source]
    asked = problem(*(Parts(d - d.mean()) for d in made), noise=0.02)
    with_floor = found_in(asked).tau_s
    monkeypatch.setattr(module, "LEAVES", 0.0)
    assert with_floor > 1.3 * found_in(asked).tau_s
    assert 2000.0 < with_floor < 4900.0


def test_what_the_known_effects_took_of_the_missing_heat_is_given_back() -> None:
    """The fit of the base took half of what was missing, for its driver works at about the same hours."""
    source = sources(1)
    missing = [lag(q, 2400.0, STEP_S) for q in source]
    rng = np.random.default_rng(3)
    drivers = [np.where(rng.random(ROWS // 40) < 0.5, q[::40] > 0, rng.random(ROWS // 40) < 0.5) for q in source]
    base = [12.0 * lag(np.repeat(d.astype(float), 40), 1500.0, STEP_S) for d in drivers]
    free = [(m - m.mean(), (b - b.mean())) for m, b in zip(missing, base, strict=True)]
    taken = sum(m @ b for m, b in free) / sum(b @ b for _, b in free)
    assert taken > 0.3
    parts = [Parts(m - taken * b + 0.1 * rng.standard_normal(ROWS), base=b[:, None]) for m, b in free]
    heat = found_in(problem(*parts, noise=0.1))

    def alike(courses: list[Float1D]) -> float:
        true = np.concatenate([m for m, _ in free])
        return float(np.corrcoef(np.concatenate([c - c.mean() for c in courses]), true)[0, 1])

    rows = np.arange(ROWS) * STEP_S
    middles = [c.from_s + c.step_s * (np.arange(len(c.source)) + 0.5) for c in heat.courses]
    estimated = [np.interp(rows, m, c.contribution) for m, c in zip(middles, heat.courses, strict=True)]
    left = alike([p.residual for p in parts])
    assert left < 0.95
    assert alike(estimated) > left + 0.5 * (1 - left)


def test_a_small_known_effect_does_not_become_the_missing_one() -> None:
    """A known effect at its bound, a fiftieth of what is missing, has by chance the same course."""
    missing = [lag(q, 2400.0, STEP_S) for q in sources(1)]
    rng = np.random.default_rng(3)
    parts = [
        Parts(m - m.mean() + 0.1 * rng.standard_normal(ROWS), base=0.02 * (m - m.mean())[:, None]) for m in missing
    ]
    heat = found_in(problem(*parts, noise=0.1))
    for course, m in zip(heat.courses, missing, strict=True):
        assert course.contribution.std() == pytest.approx(m.std(), rel=0.1)


def test_parts_of_one_test_have_one_source_and_their_own_offsets() -> None:
    whole = left_by(sources(1, tests=2), 2400.0)
    parts = []
    for block in whole.blocks:
        for half, lift in ((slice(0, 240), 30.0), (slice(240, ROWS), -12.0)):
            parts.append(
                replace(
                    block,
                    t_s=block.t_s[half],
                    residual=block.residual[half] - block.residual[half].mean() + lift,
                    response=block.response[half],
                    base=block.base[half],
                    slack=block.slack[half],
                    segment=block.segment[half],
                )
            )
    heat = found_in(replace(whole, blocks=tuple(parts)))
    assert [c.test.test for c in heat.courses] == ["t0", "t1"]
    assert [c.from_s for c in heat.courses] == [0.0, 0.0]
    estimated, true = beside(heat, sources(1, tests=2))
    assert np.corrcoef(estimated, true)[0, 1] > 0.95


def test_a_hole_is_no_measurement_of_zero() -> None:
    source = sources(1)
    whole = left_by(source, 2400.0)
    seen = np.r_[0:200, 290:ROWS]
    blocks = tuple(
        replace(
            b,
            t_s=b.t_s[seen],
            residual=b.residual[seen] - b.residual[seen].mean(),
            response=b.response[seen],
            base=b.base[seen],
            slack=b.slack[seen],
            segment=b.segment[seen],
        )
        for b in whole.blocks
    )
    heat = found_in(replace(whole, blocks=blocks))
    assert heat.tau_s == pytest.approx(2400.0, rel=0.5)
    assert all(np.isnan(c.residual).sum() >= 5 for c in heat.courses)
    assert all(np.isfinite(c.contribution).all() for c in heat.courses)


def test_long_and_many_tests_keep_to_the_most_steps() -> None:
    heat = found_in(left_by([np.repeat(sources(1, 1)[0], 6)], 7200.0))
    assert 60 <= len(heat.courses[0].source) <= 65


# ---- the solver


def normal_of(seed: int, tests: int = 3, n: int = 12, k: int = 2) -> tuple[Normal, list[tuple[np.ndarray, ...]]]:
    rng = np.random.default_rng(seed)
    own = [(rng.random((30, n)), rng.standard_normal((30, k)), rng.standard_normal(30) * 3) for _ in range(tests)]
    return (
        Normal(
            np.stack([a.T @ a for a, _, _ in own]),
            np.stack([a.T @ x for a, x, _ in own]),
            np.stack([a.T @ r for a, _, r in own]),
            sum((x.T @ x for _, x, _ in own), 0.3 * np.eye(k)),
            sum((x.T @ r for _, x, r in own), np.zeros(k)),
            np.ones((tests, n), dtype=np.bool_),
        ),
        own,
    )


@pytest.mark.parametrize("one_way", [True, False])
@pytest.mark.parametrize("seed", range(5))
def test_the_solver_finds_what_bounded_least_squares_finds(seed: int, one_way: bool) -> None:
    normal, own = normal_of(seed)
    tests, n, k = normal.cross.shape
    penalty = np.stack([0.2 * np.eye(n)] * tests)
    found = solve(normal, penalty, one_way=one_way)
    rows = [
        np.hstack([*(a if i == j else np.zeros_like(a) for j in range(tests)), x]) for i, (a, x, _) in enumerate(own)
    ]
    prior = np.diag(np.sqrt([0.2] * tests * n + [0.3] * k))
    lower = [0.0 if one_way else -np.inf] * tests * n + [-np.inf] * k
    goal = np.concatenate([*(r for _, _, r in own), np.zeros(tests * n + k)])
    right = lsq_linear(np.vstack([*rows, prior]), goal, (lower, np.inf), tol=1e-12, lsmr_tol="auto").x
    assert np.concatenate([found.source.ravel(), found.known]) == pytest.approx(right, abs=1e-4)
    assert bool((found.source == 0).any()) is one_way
