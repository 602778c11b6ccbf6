"""The products that evidence is made of, against plain multivariate normal densities of all samples at once.

Offsets have a flat prior: the density is that of what no offset changes, A'y with A orthogonal to the offsets, and
half the logarithm of |Z'Z| besides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace
from functools import cache

import numpy as np
import pytest
from scipy.linalg import block_diag, null_space
from scipy.special import logsumexp
from scipy.stats import kstest, multivariate_normal

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question import discrepancy
from thermodata.diagnosis.question.directions import Weighted, log_evidence
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import Known, known, likeliest, others_of_each
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict.on_locked import _with_effects_as_open, foretell
from thermodata.diagnosis.weigh import evidence as weighing
from thermodata.diagnosis.weigh.beside import beside
from thermodata.diagnosis.weigh.evidence import (
    Columns,
    columns,
    each_left_out,
    each_of_all,
    explained,
    moments,
    of_each_series,
    weigh,
)
from thermodata.diagnosis.weigh.in_noise_of_best import likeliest_beside
from thermodata.diagnosis.weigh.invariance import spread_of_gain
from thermodata.diagnosis.weigh.null import best_of_chance, p_value
from thermodata.diagnosis.weigh.ranking import rank_in
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Bool1D, Float1D, Float2D, Gain, Param

from .hand_made import Parts, problem
from .lagged import Lagged

ROWS = 40
NOISE = Noise(0.3, 0.5, 900.0, 0.5)
# to powers of 3: different at all points, and far from each other
TAU = Param("tau", "min", 5, 1, 30, "")
TWO_GAINS = (Gain("here", "um/K", (0.1, 10.0), "any", ""), Gain("there", "um/K", (0.1, 0.5), "any", ""))


def walk(rng: np.random.Generator, count: int, n: int) -> Float2D:
    made = np.cumsum(rng.normal(size=(n, count)), axis=0)
    return np.asarray(made - made.mean(axis=0))


@cache
def small(tests: int = 4, n: int = ROWS, cause: float = 1.0) -> Problem:
    """A known effect with a time constant that may move, one that may act otherwise; a cause that is missing."""
    rng = np.random.default_rng(3)
    made = []
    for _ in range(tests):
        u = walk(rng, 2, n)
        base, slack = walk(rng, 2, n), 0.3 * walk(rng, 1, n)
        y = base @ [1.0, 0.3] + 0.2 * slack[:, 0] + cause * u[:, 0] + 0.5 * walk(rng, 1, n)[:, 0] / 3
        y += 0.3 * rng.normal(size=n)
        values = {"T_a": u[:, 0], "T_b": u[:, 1]}
        made.append(Parts(y - y.mean(), base=base, slack=slack, values=values))
    # a step in the second test: two offsets
    return problem(*made).split({("c", "t1"): [0.4 * n * 60.0]})


@cache
def asked(channel: str = "T_a") -> CandidateEffect:
    return CandidateEffect(Lagged(params=(TAU,), gains=TWO_GAINS), {"u": channel}, "feed_x", log_prior=-0.7)


def made(one: Problem, channel: str = "T_a") -> Columns:
    found = columns(one, asked(channel))
    assert found is not None
    return found


def offsets(one: Problem, tests: Sequence[int]) -> Float2D:
    parts = []
    for i in tests:
        segment = one.blocks[i].segment
        parts.append((segment[:, None] == np.unique(segment)[None]).astype(float))
    return np.asarray(block_diag(*parts))


def noise_of(one: Problem, tests: Sequence[int], noise: Noise = NOISE) -> Float2D:
    parts = []
    for i in tests:
        t = one.blocks[i].t_s
        slow = noise.slow**2 * np.exp(-np.abs(t[:, None] - t[None]) / noise.tau_s)
        parts.append(slow + noise.white**2 * np.eye(len(t)))
    return np.asarray(block_diag(*parts))


def stacked(one: Problem, tests: Sequence[int]) -> tuple[Float2D, Float1D]:
    x = np.vstack([np.hstack([one.blocks[i].base, one.blocks[i].slack]) for i in tests])
    return x, np.concatenate([one.blocks[i].response for i in tests])


def log_density(one: Problem, tests: Sequence[int], base: Known, more: Float2D | None = None) -> float:
    """Of the response of some tests. more: a further covariance of all its samples."""
    z = offsets(one, tests)
    free = null_space(z.T)
    x, y = stacked(one, tests)
    covariance = noise_of(one, tests) + (x / base.precision) @ x.T + (0.0 if more is None else more)
    density = multivariate_normal(np.zeros(free.shape[1]), free.T @ covariance @ free, allow_singular=False)
    return float(density.logpdf(free.T @ y) - 0.5 * np.linalg.slogdet(z.T @ z)[1])


def by_hand(one: Problem, tests: Sequence[int], base: Known, cols: Columns) -> Float2D:
    """log BF with the prior at each point and size, shape (points, sizes)."""
    alone = log_density(one, tests, base)
    found = np.zeros((len(cols.points), 5))
    for p in range(len(cols.points)):
        c = np.vstack([cols.whole[one.parts[i], p] for i in tests])
        for s, size in enumerate([0.03, 0.1, 0.3, 1.0, 3.0]):
            deviation = size * np.array([1.0, 1.0, 0.5, 0.5, 0.5, 0.5])  # faster and slower: half of it
            found[p, s] = log_density(one, tests, base, (c * deviation**2) @ c.T) - alone
    return found + cols.prior


def test_the_log_evidence_is_that_of_a_normal_density_without_offsets() -> None:
    one = small()
    base = known(one, NOISE)
    assert base.log_evidence == pytest.approx(log_density(one, range(4), base), abs=1e-6)
    without = replace(one, blocks=tuple(replace(b, base=b.base[:, :0], slack=b.slack[:, :0]) for b in one.blocks))
    bare = known(without, NOISE)
    assert bare.log_evidence == pytest.approx(log_density(without, range(4), bare), abs=1e-6)
    assert base.log_evidence > bare.log_evidence


def test_locked_tests_are_made_more_probable_by_the_difference_of_two_conditional_densities() -> None:
    """Those of the fourth test, given the first three, without and with a cause."""
    one, opened = small(), np.arange(3)
    open_tests = replace(one, blocks=one.blocks[:3], kept={})
    claim = rank_in(open_tests, [made(open_tests)], NOISE).ranked[0]
    found = foretell(one, 3, NOISE, [], [claim])
    without, among = known(one, NOISE), known(_with_effects_as_open(one, opened, NOISE, [claim])[0], NOISE)

    def conditional(base: Known) -> float:
        return log_density(base.problem, range(4), base) - log_density(base.problem, range(3), base)

    rows = len(one.blocks[3].response)
    assert found.gained * rows == pytest.approx(conditional(among) - conditional(without), abs=1e-6)
    assert found.gained > 0


@pytest.mark.parametrize("tests", [(0, 1, 2, 3), (0, 2, 3), (1,)])
def test_a_candidate_is_weighed_by_the_difference_of_two_densities(tests: tuple[int, ...]) -> None:
    one = small()
    base, cols = known(one, NOISE), made(small())
    found = weigh(base, cols, moments(base, cols).of(np.array(tests)), np.array(tests))
    expected = by_hand(one, tests, base, cols)
    np.testing.assert_allclose(found.log_bf, expected, atol=1e-6)
    assert found.total == pytest.approx(logsumexp(expected), abs=1e-6)
    assert found.best == np.unravel_index(expected.argmax(), expected.shape)


def test_each_of_many_series_is_weighed_as_one_at_a_time() -> None:
    one = small()
    base, cols = known(one, NOISE), made(small())
    rng = np.random.default_rng(0)
    series = np.column_stack([base.response, base.space.of(rng.normal(size=(one.rows, 3)))])
    found = of_each_series(base, cols, series, explained(base, series))
    for k in range(4):
        cross = np.stack([base.white[rows].T @ series[rows, k] for rows in one.parts])
        other = replace(base, both=np.column_stack([base.white, series[:, k]]), cross=cross)
        (products,) = each_of_all(other, [cols])
        assert found[k] == pytest.approx(weigh(other, cols, products, other.every).total, abs=1e-8)
    assert found[0] > found[1:].max() + 10.0


def posterior(one: Problem, tests: Sequence[int], base: Known, c: Float2D, width: Float1D) -> Float1D:
    """Coefficients of the known effects and of further columns, by generalised least squares with free offsets."""
    x, y = stacked(one, tests)
    z = offsets(one, tests)
    whole, inverse = np.hstack([x, c, z]), np.linalg.inv(noise_of(one, tests))
    price = np.diag(np.concatenate([base.precision, width**-2.0, np.zeros(z.shape[1])]))
    found = np.linalg.solve(whole.T @ inverse @ whole + price, whole.T @ inverse @ y)
    return np.asarray(found[: x.shape[1] + c.shape[1]])


def ranked() -> Scored:
    return rank_in(small(), [made(small())], NOISE).ranked[0]


def test_the_noise_beside_each_candidate_is_that_beside_it_alone() -> None:
    one = small()
    some = rank_in(one, [made(one), made(one, "T_b")], NOISE).ranked
    for found, candidate in zip(likeliest_beside(one, some, NOISE), some, strict=True):
        assert astuple(found) == pytest.approx(astuple(likeliest(beside(one, [candidate]), NOISE)), rel=1e-9)
    assert likeliest_beside(one, [], NOISE) == []


def test_leaving_a_test_out_by_moments_equals_refitting_without_it() -> None:
    """Whole; and the candidate alone, with what is known fitted beside it to all tests."""
    one, found = small(), ranked()
    base, cols = known(one, NOISE), made(small())
    whole, nothing = logsumexp(by_hand(one, range(4), base, cols)), np.zeros((4 * ROWS, 0))
    of_all = posterior(one, range(4), base, nothing, np.zeros(0))
    for i in range(4):
        others = [j for j in range(4) if j != i]
        log_bf = by_hand(one, others, base, cols)
        point, size = np.unravel_index(log_bf.argmax(), log_bf.shape)
        c = [cols.whole[rows, point] for rows in one.parts]
        width = np.array([0.03, 0.1, 0.3, 1.0, 3.0])[size] * np.array([1.0, 1.0, 0.5, 0.5, 0.5, 0.5])
        x, y = stacked(one, [i])
        alone = posterior(one, others, base, np.zeros((len(others) * ROWS, 0)), np.zeros(0))
        both = posterior(one, others, base, np.vstack([c[j] for j in others]), width)
        assert found.sse_before[i] == pytest.approx(np.sum((y - x @ alone) ** 2), rel=1e-6)
        assert found.sse_after[i] == pytest.approx(np.sum((y - np.hstack([x, c[i]]) @ both) ** 2), rel=1e-6)
        own = both[-c[i].shape[1] :]
        blocks = tuple(replace(b, response=b.response - a @ own) for b, a in zip(one.blocks, c, strict=True))
        beside = posterior(replace(one, blocks=blocks), range(4), base, nothing, np.zeros(0))
        assert found.own_before[i] == pytest.approx(np.sum((y - x @ of_all) ** 2), rel=1e-6)
        assert found.own_after[i] == pytest.approx(np.sum((y - c[i] @ own - x @ beside) ** 2), rel=1e-6)
        assert found.gained[i] == pytest.approx(whole - logsumexp(log_bf), abs=1e-6)
    assert found.evidence == pytest.approx(whole + 0.7, abs=1e-6), "the prior of a candidate is no evidence"
    assert found.drop > 0.3
    assert found.rows.tolist() == [ROWS] * 4


def test_the_model_alone_is_left_out_by_moments_too() -> None:
    one = small()
    base, errors = known(one, NOISE), []
    for i in range(4):
        others = [j for j in range(4) if j != i]
        x, y = stacked(one, [i])
        alone = posterior(one, others, base, np.zeros((len(others) * ROWS, 0)), np.zeros(0))
        errors.append(np.mean((y - x @ alone) ** 2))
    assert base.left_out == pytest.approx(np.sqrt(np.mean(errors)), rel=1e-6)


def test_the_shape_is_what_the_known_effects_cannot_do() -> None:
    one, found = small(), ranked()
    base = known(one, NOISE)
    assert np.linalg.norm(found.shape) == pytest.approx(1.0)
    x, own = base.white, found.columns.does(found.weighed)
    white = base.space.of(own[:, None])[:, 0]
    theta = np.linalg.solve(x.T @ x + np.diag(base.precision), x.T @ white)
    left = white - x @ theta
    np.testing.assert_allclose(found.shape, left / np.linalg.norm(left), atol=1e-9)
    np.testing.assert_allclose(found.size, [np.sqrt(np.mean(p**2)) for p in np.split(own, 4)])


# ---- one gain everywhere, or one a test


def contributions(factors: Sequence[float]) -> tuple[Problem, list[Float1D]]:
    """A problem whose response is what a driver does, times a factor of each test."""
    one = small(tests=len(factors), cause=0.0)
    u = [b.test.values["T_a"] - b.test.values["T_a"].mean() for b in one.blocks]
    blocks = tuple(replace(b, response=b.response + f * c) for b, f, c in zip(one.blocks, factors, u, strict=True))
    return replace(one, blocks=blocks), u


EVERY = np.ones(4, dtype=np.bool_)


def spread(one: Problem, own: Sequence[Float1D], acts: Bool1D = EVERY) -> float:
    base = known(one, NOISE)
    return spread_of_gain(base, base.space.of(np.concatenate(own)[:, None])[:, 0], acts)


def spread_by_hand(one: Problem, own: Sequence[Float1D], acts: Bool1D) -> float:
    """Each test in which it acts a factor, N(mean, spread^2), the mean free: as an offset of all these tests together.
    Where it rests, a free one of its own."""
    base, tests = known(one, NOISE), range(len(own))
    x, y = stacked(one, tests)
    alone = block_diag(*[c[:, None] for c in own])
    free = null_space(np.column_stack([offsets(one, tests), alone[:, acts].sum(axis=1), alone[:, ~acts]]).T)
    each = alone[:, acts] @ alone[:, acts].T
    spreads = np.array([0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5])
    log = []
    for s in spreads:
        covariance = noise_of(one, tests) + (x / base.precision) @ x.T + s**2 * each
        log.append(multivariate_normal(np.zeros(free.shape[1]), free.T @ covariance @ free).logpdf(free.T @ y))
    weight = np.exp(np.array(log) - max(log))
    return float(weight @ spreads / weight.sum())


@pytest.mark.parametrize("rests", [(), (3,), (0, 2)])
@pytest.mark.parametrize("factors", [(1.0, 1.0, 1.0, 1.0), (0.2, 1.0, 1.8, 1.0), (1.0, 0.0, 0.0, 1.5)])
def test_the_spread_of_the_gain_is_weighed_by_its_marginal_likelihood(
    factors: Sequence[float], rests: Sequence[int]
) -> None:
    """Of all tests, or of those in which it acts, whichever is less."""
    one, own = contributions(factors)
    acts = np.array([i not in rests for i in range(len(factors))])
    expected = min(spread_by_hand(one, own, EVERY), spread_by_hand(one, own, acts))
    assert spread(one, own, acts) == pytest.approx(expected, abs=1e-4)


def test_a_cause_has_one_gain_and_a_proxy_several() -> None:
    alike, own = contributions((1.0, 1.0, 1.0, 1.0))
    apart, _ = contributions((0.1, 1.0, 2.5, 0.2))
    assert spread(alike, own) < 0.3
    assert spread(apart, own) > 0.6


def test_where_it_rests_its_gain_is_not_asked() -> None:
    """A bearing that follows the air for a night, and what the air leaves over."""
    apart, own = contributions((1.0, 1.0, 1.0, 9.0))
    acts = np.array([True, True, True, False])
    assert spread(apart, own) > 0.6
    assert spread(apart, own, acts) < 0.3


@pytest.mark.parametrize(("second", "expected"), [(0.9e-3, True), (1.1e-3, False)])
def test_what_acts_in_one_test_only_may_have_any_gain(second: float, expected: bool) -> None:
    """From a millionth of the largest energy on, a test counts."""
    one, own = contributions((1.0, 1.0, 1.0, 1.0))
    base = known(one, NOISE)
    energy = np.sqrt(base.space.each(base.space.of(np.concatenate(own)[:, None])[:, 0] ** 2))
    parts = [own[0] / energy[0], second * own[1] / energy[1], 0 * own[2], 0 * own[3]]
    assert (spread(one, parts) == 1.0) is expected


# ---- chance


def drawn(one: Problem, base: Known, noise: Noise, count: int, seed: int) -> Float2D:
    """Responses of the model itself, sample by sample: its gains as fitted, other time constants and noise drawn."""
    rng = np.random.default_rng(seed)
    mean = base.mean(base.every)
    loose = np.where(base.precision >= 1.0, base.precision**-0.5, 0.0)
    theta = mean[:, None] + loose[:, None] * rng.normal(size=(len(mean), count))
    series = []
    for i in range(len(one.blocks)):
        x, _ = stacked(one, [i])
        y = x @ theta + rng.multivariate_normal(np.zeros(len(x)), noise_of(one, [i], noise), count).T
        series.append(y + rng.normal(0, 30.0, count))
    return base.space.of(np.vstack(series))


def best_of_each(base: Known, pool: Sequence[Columns], series: Float2D) -> Float1D:
    already = explained(base, series)
    return np.max([of_each_series(base, c, series, already) - c.candidate.log_prior for c in pool], axis=0)


def test_p_values_are_uniform_on_responses_in_which_nothing_is_missing() -> None:
    one = small(cause=0.0)
    base = known(one, NOISE)
    pool = [made(one), made(one, "T_b")]
    chance = best_of_chance(base, pool, seed=0)
    assert chance.shape == (199,)
    assert (np.diff(chance) >= 0).all()
    series = drawn(one, base, NOISE, 300, seed=1)
    best = best_of_each(base, pool, series)
    p = [p_value(float(b), chance) for b in best]
    assert kstest(p, "uniform").statistic < 0.13
    wrong = best_of_each(base, pool, 2.0 * series)
    assert kstest([p_value(float(b), chance) for b in wrong], "uniform").statistic > 0.2, "the test can fail"


def test_a_cause_is_beyond_all_chance() -> None:
    one = small()
    base, cols = known(one, NOISE), made(small())
    (products,) = each_of_all(base, [cols])
    evidence = weigh(base, cols, products, base.every).total - cols.candidate.log_prior
    assert p_value(evidence, best_of_chance(base, [cols])) == pytest.approx(1 / 200)
    np.testing.assert_array_equal(best_of_chance(base, [cols], 3), best_of_chance(base, [cols], 3))
    assert not np.array_equal(best_of_chance(base, [cols], 3), best_of_chance(base, [cols], 4))


@pytest.mark.parametrize(("as_well", "p"), [(0, 0.005), (1, 0.01), (199, 1.0)])
def test_chance_that_does_as_well_counts(as_well: int, p: float) -> None:
    chance = np.array([2.0] * as_well + [1.9] * (199 - as_well))
    assert p_value(2.0, chance) == pytest.approx(p)


def test_the_best_of_chance_is_against_all_that_was_tried() -> None:
    one = small(cause=0.0)
    base = known(one, NOISE)
    a, b = made(one), made(one, "T_b")
    both = best_of_chance(base, [a, b])
    assert (both >= best_of_chance(base, [a])).all()
    assert (both >= best_of_chance(base, [b])).all()
    assert both.mean() > best_of_chance(base, [a]).mean()


@pytest.mark.parametrize(("share", "moves"), [(0.99, True), (1.01, False)])
def test_chance_draws_how_the_known_effects_act_otherwise_and_not_their_gains(share: float, moves: bool) -> None:
    """What is as free as its own size, or freer, would be fitted again: it stays as fitted."""
    from thermodata.diagnosis.weigh.null import _drawn_responses

    one = small(cause=0.0)
    large = replace(one, blocks=tuple(replace(b, slack=1e6 * b.slack, base=1e6 * b.base) for b in one.blocks))
    base = known(large, replace(NOISE, share=share))
    fitted = base.white @ base.mean(base.every)
    away = np.abs(_drawn_responses(base, np.random.default_rng(0)) - fitted[:, None]).max()
    assert bool(away > 1e4) is moves


@pytest.mark.parametrize("at_s", [[], [10], [4, 21]])
def test_weighted_directions_give_the_evidence_of_the_covariance(at_s: list[int]) -> None:
    """Of tests of unequal length, with one free offset each or more, under several sizes of one memory and another."""
    rng = np.random.default_rng(3)
    parts = [Parts(rng.normal(size=n), base=rng.normal(size=(n, 2)), slack=rng.normal(size=(n, 1))) for n in (30, 17)]
    one = problem(*parts)
    one = one.split({one.blocks[0].test.key: [float(one.blocks[0].t_s[i]) + 1.0 for i in at_s]})
    weighted = Weighted(one)
    for noise in (Noise(0.3, 0.8, 900.0, 0.7), Noise(0.1, 3.0, 900.0, 0.7), Noise(0.3, 0.8, 90_000.0, 0.7)):
        expected = known(one, noise)
        gram, cross, energy, logdet, rows = weighted.products(noise)
        np.testing.assert_allclose(gram, expected.gram.sum(axis=0), rtol=1e-8)
        np.testing.assert_allclose(cross, expected.cross.sum(axis=0), rtol=1e-8)
        assert rows == 30 + 17 - 2 - len(at_s)
        found = log_evidence(gram, cross, energy, logdet, rows, expected.precision)
        assert found == pytest.approx(expected.log_evidence, rel=1e-9)


@pytest.mark.parametrize("room", [0, 1 << 30])
def test_what_is_kept_of_a_noise_changes_nothing(room: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(discrepancy, "KEPT_BYTES", room)
    one = replace(small(), kept={})
    base, cols = known(one, NOISE), made(small())
    first, again = moments(base, cols), moments(base, cols)
    white = base.space.of(cols.whole.reshape(one.rows, -1))
    assert bool(base.space.kept) is bool(room)
    for i, rows in enumerate(one.parts):
        expected = white[rows].T @ base.white[rows]
        assert np.allclose(first.known[i].reshape(expected.shape), expected, atol=1e-12)
    for name in ("own", "known", "response"):
        assert np.array_equal(getattr(first, name), getattr(again, name))


@pytest.mark.parametrize("near", [1, 2 * ROWS * 240, 1 << 30])
@pytest.mark.parametrize(("room", "at_once"), [(0, 1), (0, 1 << 30), (20_000, 30), (1 << 30, 1 << 30)])
def test_several_candidates_at_once_are_weighed_as_each_by_itself(
    room: int, at_once: int, near: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whitened in all tests at once, in some, or in each by itself."""
    monkeypatch.setattr(discrepancy, "KEPT_BYTES", room)
    monkeypatch.setattr(discrepancy, "NEAR", near)
    monkeypatch.setattr(weighing, "AT_ONCE", at_once)
    base, some = known(replace(small(), kept={}), NOISE), [made(small()) for _ in range(4)]
    some = [replace(one, whole=(i + 1.0) * one.whole) for i, one in enumerate(some)]
    moments(base, some[1])
    for _ in range(2):
        for one, found in zip(some, each_of_all(base, some), strict=True):
            alone = moments(known(replace(small(), kept={}), NOISE), one).of(base.every)
            for name in ("own", "known", "response"):
                expected = getattr(alone, name)
                np.testing.assert_allclose(getattr(found, name), expected, rtol=0, atol=1e-12 * np.abs(expected).max())
    assert list(each_of_all(base, [])) == []


def test_the_columns_of_three_noises_are_kept_and_no_more() -> None:
    one = replace(small(), kept={})
    noises = [replace(NOISE, white=NOISE.white * k) for k in (1.0, 2.0, 3.0, 4.0)]
    spaces = [known(one, n).space for n in noises]
    for k in (3, 2, 1):
        assert known(one, noises[k]).space is spaces[k]
    assert known(one, noises[0]).space is not spaces[0]


def test_all_tests_left_out_at_once_say_what_each_left_out_says() -> None:
    base, cols = known(small(), NOISE), made(small())
    products = moments(base, cols)
    found = each_left_out(base, cols, products)
    assert len(found.total) == len(base.every)
    for i in base.every:
        others = np.delete(base.every, i)
        by_itself, of_others = weigh(base, cols, products.of(others), others), products.of(others).known
        assert found.total[i] == pytest.approx(by_itself.total, rel=1e-10)
        assert found.point[i] == by_itself.best[0]
        np.testing.assert_allclose(found.coefficients[i], by_itself.coefficients, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(found.toward[i], by_itself.coefficients @ of_others[found.point[i]], rtol=1e-9)
        np.testing.assert_allclose(base.of_others.mean[i], base.mean(others), rtol=1e-9)


def test_the_others_of_each_lose_no_digits_beside_one_that_is_large() -> None:
    parts = np.array([1.0, 1e20, 2.0, 3.0])
    assert others_of_each(parts).tolist() == [1e20, 6.0, 1e20, 1e20]


def test_what_is_kept_of_the_known_effects_is_of_their_own_response() -> None:
    base = known(small(), NOISE)
    first = base.mean(base.every)
    assert base.mean(base.every) is first
    np.testing.assert_allclose(replace(base, cross=2 * base.cross).mean(base.every), 2 * first, rtol=1e-12)
