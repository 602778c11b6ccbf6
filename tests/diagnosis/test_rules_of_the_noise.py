"""Which noise is searched for, and which priors there are: discrepancy.py, known.py, evidence.py."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.chain import MANY, WIDE, Chain, chain_of
from thermodata.diagnosis.question.discrepancy import Noise, Whitened, ascend, bounds_of, left_over
from thermodata.diagnosis.question.known import known, likeliest, likeliest_of
from thermodata.diagnosis.question.problem import Problem, freed, start_directions
from thermodata.diagnosis.weigh.evidence import columns
from thermodata.plugin import Float1D, Gain, Param

from .hand_made import Parts, PlainEffect, problem
from .lagged import Lagged

STEP = 300.0


def slow(rng: np.random.Generator, n: int, tau_s: float) -> Float1D:
    """A unit Ornstein-Uhlenbeck process."""
    a = np.exp(-STEP / tau_s)
    x = np.empty(n)
    x[0] = rng.normal()
    for i in range(1, n):
        x[i] = a * x[i - 1] + np.sqrt(1 - a**2) * rng.normal()
    return x


def of_noise(white: float, size: float, tau_s: float = 7200.0, tests: int = 4, n: int = 150) -> Problem:
    rng = np.random.default_rng(2)
    made = [white * rng.normal(size=n) + size * slow(rng, n, tau_s) for _ in range(tests)]
    return problem(*(Parts(y - y.mean()) for y in made), noise=white, step_s=STEP)


@pytest.mark.parametrize(("white", "size", "tau_s"), [(0.3, 1.0, 7200.0), (1.0, 1.5, 3600.0)])
def test_noise_is_found_again_where_it_is_known(white: float, size: float, tau_s: float) -> None:
    found = likeliest(of_noise(white, size, tau_s))
    assert found.white == pytest.approx(white, rel=0.3)
    assert found.slow == pytest.approx(size, rel=0.5)
    assert tau_s / 2.5 < found.tau_s < tau_s * 2.5


def test_white_noise_is_a_tenth_of_what_the_model_leaves_at_least() -> None:
    smooth = of_noise(0.0, 1.0, 36000.0)
    assert likeliest(smooth).white == pytest.approx(0.1 * left_over(smooth))
    noisy = of_noise(0.3, 1.0, 36000.0)
    assert likeliest(noisy).white > 0.15 * left_over(noisy)


def test_the_bounds_of_the_search() -> None:
    """In shares of what the model leaves; ten minutes to four days; a share of 3 % to 300 %."""
    short = problem(Parts(np.tile([2.0, -2.0], 50)), noise=0.1)
    one = replace(short, blocks=tuple(replace(b, t_s=np.linspace(0.0, 28_800.0, 100)) for b in short.blocks))
    first, bounds = bounds_of(one)
    assert (first.white, first.slow, first.tau_s, first.share) == pytest.approx((0.1, 2.0, 7200.0, 0.5))
    np.testing.assert_allclose(np.exp(bounds[0]), [0.002, 2.0])
    np.testing.assert_allclose(np.exp(bounds[1:]), [[0.02, 8.0], [600.0, 345600.0], [0.03, 3.0]])
    loud, wide = bounds_of(replace(one, noise=3.0))
    assert (loud.white, np.exp(wide[0, 1])) == pytest.approx((3.0, 6.0)), "the noise lies within"
    assert bounds_of(replace(one, noise=float("nan")))[0].white == pytest.approx(0.04)


def test_a_short_test_has_a_slow_noise_of_its_own_scale() -> None:
    """A twentieth of the longest test where that is under ten minutes; the search begins at a quarter of it."""
    one = problem(Parts(np.tile([2.0, -2.0], 50)), noise=0.1)
    brief = replace(one, blocks=tuple(replace(b, t_s=np.linspace(0.0, 200.0, 100)) for b in one.blocks))
    first, bounds = bounds_of(brief)
    assert (first.tau_s, np.exp(bounds[2, 0])) == pytest.approx((50.0, 10.0))


def test_the_search_climbs_to_the_largest_value_within_bounds() -> None:
    bounds = np.array([[-5.0, 5.0]] * 3 + [[-5.0, 1.0]])
    top = np.array([1.0, -2.0, 0.5, 3.0])
    found = ascend(lambda x: -float(np.sum((x - top) ** 2)), np.zeros(4), bounds)
    np.testing.assert_allclose(found, [1.0, -2.0, 0.5, 1.0], atol=0.15)
    outside = ascend(lambda x: 0.0, np.full(4, 9.0), bounds)
    np.testing.assert_array_equal(outside, [5.0, 5.0, 5.0, 1.0])


def test_the_search_ends() -> None:
    asked: list[float] = []

    def rising(x: Float1D) -> float:
        asked.append(float(x.sum()))
        return float(x.sum())

    ascend(rising, np.zeros(4), np.array([[0.0, 1e9]] * 4), most=20)
    assert 20 <= len(asked) <= 30


@pytest.mark.parametrize(("rows", "thinned"), [(1044, []), (1056, [2]), (1740, [2]), (1760, [3])])
def test_the_noise_is_searched_in_some_seven_hundred_rows(
    monkeypatch: pytest.MonkeyPatch, rows: int, thinned: list[int]
) -> None:
    """Every second one from one and a half times as many on."""
    asked: list[int] = []
    thin = Problem.thinned
    monkeypatch.setattr(Problem, "thinned", lambda self, every: asked.append(every) or thin(self, every))
    monkeypatch.setattr("thermodata.diagnosis.question.known.ascend", lambda goal, x, bounds: x)
    likeliest(of_noise(0.3, 1.0, n=rows // 4))
    assert asked == thinned


def test_a_thinned_problem_keeps_every_second_row_of_what_is_long_enough() -> None:
    long, short = np.arange(20.0), np.arange(19.0)
    thin = problem(Parts(long, base=long[:, None], slack=long[:, None]), Parts(short)).thinned(2)
    a, b = thin.blocks
    for values in (a.residual, a.response, a.base[:, 0], a.slack[:, 0], a.t_s / 60.0):
        np.testing.assert_array_equal(values, np.arange(0.0, 20.0, 2.0))
    assert len(a.segment) == 10
    np.testing.assert_array_equal(b.residual, short)


def test_the_search_begins_where_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thermodata.diagnosis.question.known.ascend", lambda goal, x, bounds: x)
    start = Noise(0.5, 0.7, 3000.0, 0.2)
    found = likeliest(of_noise(0.3, 1.0), start)
    assert (found.white, found.slow, found.tau_s, found.share) == pytest.approx((0.5, 0.7, 3000.0, 0.2))


@pytest.mark.parametrize("n", [40, 70])  # tests side by side in one stack, and one by one
def test_the_noise_beside_each_part_is_that_of_a_problem_with_this_part_alone(n: int) -> None:
    """What is known in common, and one of two candidates."""
    rng = np.random.default_rng(4)
    whole, alone = [], ([], [])
    for _ in range(5):
        both = np.column_stack([np.cumsum(rng.normal(size=n)) for _ in range(3)])
        spare = rng.normal(size=(n, 2))
        y = both @ [1.0, 2.0, 0.0] + 0.3 * rng.normal(size=n)
        whole.append(Parts(y, base=both, slack=spare))
        for i in (0, 1):
            alone[i].append(Parts(y, base=both[:, [0, 1 + i]], slack=spare[:, [i]]))
    parts = [np.array([0, 1, 3]), np.array([0, 2, 4])]
    found = likeliest_of(problem(*whole, noise=0.3, step_s=STEP), parts)
    for own, expected in zip(found, alone, strict=True):
        one = likeliest(problem(*expected, noise=0.3, step_s=STEP))
        assert (own.white, own.slow, own.tau_s, own.share) == pytest.approx(
            (one.white, one.slow, one.tau_s, one.share), rel=1e-6
        )
    assert found[0].slow < 0.5 * found[1].slow, "beside what is there little is left"


@pytest.mark.parametrize(
    "noise", [Noise(0.3, 1.0, 7200.0, 0.5), Noise(0.01, 40.0, 3e5, 0.5), Noise(5.0, 0.05, 600.0, 1.0)]
)
@pytest.mark.parametrize("many", [3, WIDE - 1, WIDE])
def test_a_chain_is_the_factor_of_the_covariance(noise: Noise, many: int) -> None:
    """Of two tests, which share no slow noise, at uneven times, two of them equal; of few columns, and of so many that
    samples are taken one by one."""
    rng = np.random.default_rng(3)
    tests = [np.cumsum(rng.uniform(10.0, 900.0, rows)) for rows in (50, 30)]
    tests[0][41] = tests[0][40]
    slow = [noise.slow**2 * np.exp(-np.abs(t[:, None] - t[None]) / noise.tau_s) for t in tests]
    covariance = block_diag(*slow) + noise.white**2 * np.eye(80)
    chain, columns = chain_of(tests, noise.white, noise.slow, noise.tau_s), rng.normal(size=(80, many))
    np.testing.assert_allclose(
        chain.halved(columns), np.linalg.solve(np.linalg.cholesky(covariance), columns), rtol=1e-6
    )
    assert chain.logdet == pytest.approx(np.linalg.slogdet(covariance)[1])
    assert chain.halved(np.empty((80, 0))).shape == (80, 0)


@pytest.mark.parametrize("sizes", [[20] * 12, [int(9 + i % 7) for i in range(12)], [20] * MANY, [2, 60, *[4] * 20]])
@pytest.mark.parametrize("many", [3, 60, WIDE - 1])
def test_tests_beside_each_other_give_what_each_gives_alone(sizes: list[int], many: int) -> None:
    """To the last digit, for no test knows of another; tests of very different length are taken one by one."""
    rng = np.random.default_rng(4)
    tests = [np.cumsum(rng.uniform(10.0, 900.0, rows)) for rows in sizes]
    chain, columns = chain_of(tests, 0.3, 1.0, 7200.0), rng.normal(size=(sum(sizes), many))
    found, ends = chain.halved(columns), np.cumsum([0, *sizes])
    alone = [chain.part(i, i).halved(columns[ends[i] : ends[i + 1]]) for i in range(len(sizes))]
    assert np.array_equal(found, np.concatenate(alone))
    assert found.flags.f_contiguous, "products are taken as of what LAPACK gives, to the last digit"


def test_few_columns_of_many_tests_are_taken_sample_by_sample(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    beside = Chain._test_beside_test
    monkeypatch.setattr(Chain, "_test_beside_test", lambda self, c: [asked.append(len(self.sizes)), beside(self, c)][1])
    for sizes in ([20] * 12, [20] * (MANY - 1), [400, *[4] * 12]):
        chain = chain_of([60.0 * np.arange(rows) for rows in sizes], 0.3, 1.0, 7200.0)
        chain.halved(np.ones((sum(sizes), 60)))
    assert asked == [12]


def test_whitened_noise_is_white_and_offsets_are_gone() -> None:
    noise = Noise(0.3, 1.0, 7200.0, 0.5)
    one = of_noise(0.3, 1.0, tests=6)
    space = Whitened(one, noise)
    residual = np.concatenate([b.residual for b in one.blocks])[:, None]
    white = space.of(residual)[:, 0]
    assert white.std() == pytest.approx(1.0, abs=0.1)
    assert abs(np.corrcoef(white[1:], white[:-1])[0, 1]) < 0.1
    assert space.rows == 6 * 149
    np.testing.assert_allclose(space.of(np.repeat(np.arange(6.0), 150)[:, None]), 0.0, atol=1e-9)
    np.testing.assert_allclose(space.projected(space.of(residual)), space.of(residual))


# ---- a warm start


def started(one: Problem, state: str) -> Problem:
    """The same with the state in which its tests began."""
    blocks = (replace(b, test=replace(b.test, start_state=state)) for b in one.blocks)
    return replace(one, blocks=tuple(blocks), kept={})


def fading(one: Problem, tau_s: float, size: float) -> Problem:
    """With what fades from the start of each test added to its response."""
    moved = (size * np.exp(-(b.t_s - b.test.t_s[0]) / tau_s) for b in one.blocks)
    return replace(
        one,
        blocks=tuple(replace(b, response=b.response + m - m.mean()) for b, m in zip(one.blocks, moved, strict=True)),
        kept={},
    )


@pytest.mark.parametrize("tau_s", [600.0, 5000.0, 12_000.0])
def test_what_fades_from_a_warm_start_explains_nothing_and_costs_nothing(tau_s: float) -> None:
    """A decay between those that are freed is within 2 % of their sum."""
    quiet = of_noise(0.3, 1.0, tests=3)
    noise = Noise(0.3, 1.0, 7200.0, 0.5)
    warm = known(started(quiet, "warm"), noise).log_evidence
    assert known(started(fading(quiet, tau_s, 10.0), "warm"), noise).log_evidence == pytest.approx(warm, abs=1.0)
    assert known(fading(quiet, tau_s, 10.0), noise).log_evidence < known(quiet, noise).log_evidence - 20
    space = Whitened(started(quiet, "warm"), noise)
    assert space.rows == 3 * (150 - 6)


def test_the_search_of_the_noise_knows_warm_starts_too() -> None:
    quiet = started(of_noise(0.3, 1.0, tests=3), "warm")
    loud = started(fading(of_noise(0.3, 1.0, tests=3), 3000.0, 30.0), "warm")
    found, expected = likeliest(loud), likeliest(quiet)
    assert found.slow == pytest.approx(expected.slow, rel=0.3)
    assert likeliest(started(loud, "balance")).slow > 2 * expected.slow


def test_a_test_is_freed_of_its_start_and_its_offsets() -> None:
    """Compressed and split alike; one at balance of its offsets alone."""
    one = fading(of_noise(0.01, 0.0, tests=1, n=200), 3750.0, 10.0)
    for state, left in (("balance", 1.0), ("warm", 0.02)):
        block = started(one, state).blocks[0]
        free = freed(block.response[:, None] + 5.0, block.test, block.t_s, block.segment)[:, 0]
        assert free.std() <= left * block.response.std() + 1e-12
        assert bool(free.std() > 0.5 * block.response.std()) is (state == "balance")
    split = started(one, "warm").split({one.blocks[0].test.key: [float(one.blocks[0].t_s[99]) + 1.0]}).blocks[0]
    for part in (0, 1):
        assert abs(split.response[split.segment == part].mean()) < 1e-9
    assert split.response.std() < 0.02 * one.blocks[0].response.std()


def test_a_test_of_a_few_samples_keeps_its_start() -> None:
    one = started(fading(of_noise(0.01, 0.0, tests=1, n=6), 3750.0, 10.0), "warm").blocks[0]
    assert start_directions(one.test, one.t_s, one.segment).shape == (6, 0)


# ---- priors


@pytest.mark.parametrize(("own", "deviation"), [(1.0, 2.0), (0.51, 2.0), (0.49, 1 / 0.49), (0.1, 10.0), (5.0, 2.0)])
def test_a_known_gain_may_double_or_be_as_large_as_the_response(own: float, deviation: float) -> None:
    wave = np.tile([1.0, -1.0], 20)
    one = problem(*[Parts(wave, base=own * wave[:, None], slack=wave[:, None])] * 2)
    found = known(one, Noise(0.1, 0.1, 600.0, 0.25))
    assert found.precision**-0.5 == pytest.approx([deviation, 0.25])


def test_an_effect_that_does_nothing_has_a_prior_too() -> None:
    one = problem(*[Parts(np.tile([1.0, -1.0], 20), base=np.zeros((40, 1)))] * 2)
    assert np.isfinite(known(one, Noise(0.1, 0.1, 600.0, 0.25)).log_evidence)


def two(effect: PlainEffect, log_prior: float = 0.0) -> tuple[Problem, CandidateEffect]:
    rng = np.random.default_rng(0)
    parts = []
    for _ in range(2):
        u = np.cumsum(rng.normal(size=60))
        parts.append(Parts(np.tile([2.0, -2.0], 30), values={"T_a": u, "T_still": np.ones(60)}))
    return problem(*parts), CandidateEffect(effect, {"u": "T_a"}, "feed_x", log_prior=log_prior)


def test_a_coefficient_of_1_is_as_large_as_the_response_and_half_of_it_acts_otherwise() -> None:
    one, asked = two(Lagged(params=(Param("tau", "min", 5, 1, 30, ""),)))
    found = columns(one, asked)
    assert found is not None
    assert found.width.tolist() == [1.0, 0.5, 0.5]
    assert found.gains == 1
    for p in range(len(found.points)):
        assert np.sqrt(np.mean(found.whole[:, p, :1] ** 2)) == pytest.approx(2.0)


@pytest.mark.parametrize("times", [0.02, 0.5, 3.0])
def test_a_gain_beyond_what_is_plausible_costs_a_quarter_of_its_squared_logarithm(times: float) -> None:
    """Ten times costs 1.3. times: how large a gain is plausible, as a multiple of that of a coefficient of 1."""
    one, asked = two(PlainEffect())
    plain = columns(one, asked)
    assert plain is not None
    gain = Gain("gain", "um/K", (0.0, times * float(plain.scale[0, 0])), "any", "")
    found = columns(*two(PlainEffect(gains=(gain,)), log_prior=-3.0))
    assert found is not None
    over = np.maximum(np.array([0.03, 0.1, 0.3, 1.0, 3.0]) / times, 1.0)
    np.testing.assert_allclose(found.prior[0], -3.0 - np.log(5) - 0.25 * np.log(over) ** 2)


@pytest.mark.parametrize(("log_prior", "beyond"), [(0.0, -3.0), (-0.7, -3.0), (-4.0, -4.0)])
def test_a_time_constant_beyond_its_bounds_is_as_likely_as_a_lag_without_a_name(
    log_prior: float, beyond: float
) -> None:
    """What lies within loses nothing by it."""
    tau = Param("tau", "min", 30, 10, 120, "")
    gains = (Gain("gain", "um/K", (0.0, np.inf), "any", ""),)
    plain = columns(*two(Lagged(params=(tau,), gains=gains), log_prior))
    found = columns(*two(Lagged(params=(replace(tau, reach=(1, 360)),), gains=gains), log_prior))
    assert plain is not None
    assert found is not None
    usual = [10 <= p["tau"] <= 120 for p in found.points]
    assert 0 < sum(usual) < len(usual)
    np.testing.assert_allclose(found.prior[usual], plain.prior[0, 0])
    np.testing.assert_allclose(found.prior[np.logical_not(usual)], plain.prior[0, 0] - log_prior + beyond)


def test_a_driver_that_never_moves_is_not_weighed() -> None:
    one, asked = two(PlainEffect())
    assert columns(one, replace(asked, binding={"u": "T_still"})) is None
    assert columns(one, asked) is not None
