"""What `show` computes, against python-control: coefficients, poles, zeros, state space, step response, Bode."""

from __future__ import annotations

import control
import numpy as np
import pytest

from thermodata.effect.law import parse, with_parameters
from thermodata.effect.law_run import filtered
from thermodata.effect.linear import Filter, Mode, lag_filter, partial_fractions, partial_fractions_of_s
from thermodata.modelling.model_file.transfer.as_effect import GivenFunction
from thermodata.modelling.seen.linear_parts import CurvedError, paths
from thermodata.modelling.seen.residual_tests import against, autocorrelation, ljung_box
from thermodata.modelling.seen.state_space import system_of

SAME = 1e-9
STEP = 60.0

# direct + lags, by (gain, tau [s]): what an engineer writes down for the continuous system
LAGS = {
    "one lag": (0.0, [(2.5, 1200.0)]),
    "direct and lag": (0.8, [(1.7, 2700.0)]),
    "two lags of the papers": (0.0, [(12.0, 1200.0), (25.0, 10800.0)]),
    "skin": (0.0, [(3.0, 900.0), (-3.0, 14400.0)]),
    "three": (-0.5, [(1.0, 300.0), (2.0, 3600.0), (-4.0, 40000.0)]),
}


def ours(direct: float, lags: list[tuple[float, float]]) -> Filter:
    total = Filter(direct=direct)
    for gain, tau in lags:
        total = total + lag_filter(tau).scaled(gain)
    return total


def theirs(direct: float, lags: list[tuple[float, float]]) -> object:
    """The continuous system, sampled by python-control for inputs that run straight."""
    system = control.ss([], [], [], [[direct]])
    for gain, tau in lags:
        system = system + control.ss([[-1 / tau]], [[1 / tau]], [[gain]], [[0.0]])
    return control.sample_system(system, STEP, method="foh")


@pytest.mark.parametrize("name", LAGS)
def test_it_says_what_python_control_says(name: str) -> None:
    mine, other = system_of(ours(*LAGS[name]), STEP), theirs(*LAGS[name])
    size = abs(float(control.dcgain(other)))
    assert abs(mine.at_rest - float(control.dcgain(other))) <= SAME * max(1.0, size)
    assert _same(mine.poles, control.poles(other))
    assert _same(mine.zeros, control.zeros(other))
    transfer = control.tf(other)
    num, den = (np.ravel(transfer.num[0][0]), np.ravel(transfer.den[0][0]))
    assert np.allclose(mine.a, num / den[0], rtol=0, atol=SAME)
    assert np.allclose(mine.b, den / den[0], rtol=0, atol=SAME)
    t = np.arange(600) * STEP
    assert np.abs(mine.step_response(600) - control.step_response(other, t).outputs).max() <= SAME * max(1.0, size)
    omega = 2 * np.pi * np.geomspace(1e-7, 0.49 / STEP, 200)
    answer = control.frequency_response(other, omega).complex
    assert np.abs(mine.frequency_response(omega) - answer).max() <= SAME * max(1.0, size)
    space = control.ss(mine.A, mine.B, mine.C, mine.D, STEP)
    assert np.abs(control.step_response(space, t).outputs - mine.step_response(600)).max() <= SAME * max(1.0, size)


def _same(mine: np.ndarray, other: np.ndarray) -> bool:
    a, b = np.sort_complex(np.asarray(mine, complex)), np.sort_complex(np.asarray(other, complex))
    return len(a) == len(b) and (len(a) == 0 or bool(np.abs(a - b).max() <= SAME))


@pytest.mark.parametrize(
    ("num", "den"),
    [
        ([0.164570549, -0.316986250, 0.152416605], [1, -1.990646559, 0.990647498]),
        ([2.350162704, -4.699029841, 2.348867151], [1, -1.644497476, 0.291495051, 0.353002514]),
        (
            [2.990867540, -4.119547491, -0.728143820, 1.856823770],
            [1, -0.68971093, -0.984937403, 0.046436696, 0.628211792],
        ),
        ([-1.039701172, 1.022109354, -1.091116374, 1.108640174], [1, -0.999974317]),
    ],
    ids=["two lags", "negative pole", "complex poles", "more zeros than poles"],
)
def test_a_printed_function_is_the_same_in_parts(num: list[float], den: list[float]) -> None:
    """At its own samples: coefficients come back, and python-control's answers are ours."""
    mine = system_of(partial_fractions(np.array(num), np.array(den), 1.0), 1.0)
    n = max(len(num), len(den))
    other = control.tf(np.pad(num, (0, n - len(num))), np.pad(den, (0, n - len(den))), 1.0)
    # python-control filters by the polynomial: over some hundred samples that has its digits
    t = np.arange(300.0)
    assert np.allclose(mine.step_response(300), control.step_response(other, t).outputs, rtol=0, atol=1e-8)
    omega = np.geomspace(1e-3, 3.0, 60)
    assert np.allclose(mine.frequency_response(omega), control.frequency_response(other, omega).complex, atol=1e-7)
    assert np.allclose(mine.a[: len(num)], num, atol=SAME)
    assert np.allclose(mine.b[: len(den)], den, atol=SAME)


def test_a_function_of_s_is_the_same_in_parts() -> None:
    num, den = [0.0162, 10.74, 5.368], [0.002098, 2.379, 1.0]
    by = partial_fractions_of_s(np.array(num), np.array(den), 60.0)
    other = control.sample_system(control.tf(num[::-1], den[::-1]), 1.0, method="foh")
    mine = system_of(by, 60.0)
    assert np.allclose(mine.step_response(200), control.step_response(other, np.arange(200.0)).outputs, atol=1e-8)
    assert abs(mine.at_rest - num[0] / den[0]) < SAME


@pytest.mark.parametrize("cycle_s", [2.0, 5.0])
def test_poles_that_only_their_samples_know_run_at_multiples(cycle_s: float) -> None:
    num, den = [2.350162704, -4.699029841, 2.348867151], [1, -1.644497476, 0.291495051, 0.353002514]
    by = partial_fractions(np.array(num), np.array(den), 1.0)
    coarse = np.arange(0, 2001, int(cycle_s))
    rng = np.random.default_rng(2)
    slow = np.cumsum(rng.normal(0, 0.05, len(coarse)))
    slow -= slow[0]
    fine = np.interp(np.arange(2001), coarse, slow)
    truth = GivenFunction(num, den, 1.0).simulate(np.arange(2001.0), fine)
    assert np.abs(filtered(slow, by, cycle_s) - truth[:: int(cycle_s)]).max() < 1e-6
    from thermodata.errors import UsageError

    with pytest.raises(UsageError, match="only its own samples know"):
        filtered(slow, by, 0.5)


def test_poles_that_coincide_are_refused() -> None:
    from thermodata.errors import UsageError

    with pytest.raises(UsageError, match="coincide"):
        partial_fractions(np.array([1.0, 0.0]), np.array([1.0, -1.8, 0.81]), 1.0)


def test_a_law_falls_apart_into_paths() -> None:
    p = {"fast": 15.0, "slow": 240.0, "k": 1.0}
    node = with_parameters("2 * (lag(T, fast) - lag(T, slow)) + 0.5 * n ** 2", p, {"fast": "min", "slow": "min"})
    found = paths(node)
    assert [path.by.at_rest for path in found] == [0.0, 0.5]
    assert [m.tau_s for m in found[0].by.modes] == pytest.approx([900.0, 14400.0])
    switched = paths(with_parameters("lag(T, where(abs(n) > 1, fast, slow))", p, {"fast": "min", "slow": "min"}))
    assert [path.holds for path in switched] == ["|n| > 1", "not |n| > 1"]
    scaled = paths(with_parameters("lag(T, fast) * x / 1000", p, {"fast": "min"}))
    assert [(path.by.at_rest, path.times) for path in scaled] == [(0.001, parse("x"))]
    with pytest.raises(CurvedError):
        paths(with_parameters("abs(lag(T, fast))", p, {}))


def test_a_delay_is_a_shift_register() -> None:
    by = Filter(direct=1.0, late=((150.0, 2.0),), modes=(Mode(3.0, s=-1 / 600),))
    system = system_of(by, 60.0)
    assert system.at_rest == 6.0
    assert np.allclose(system.step_response(200), filtered(np.r_[0.0, np.ones(200)], by, 60.0)[1:])


# ---- the residual


def test_the_autocorrelation_of_a_record_without_gaps_is_the_known_one() -> None:
    rng = np.random.default_rng(0)
    x = np.convolve(rng.normal(size=600), np.ones(5) / 5, "valid")
    centred = x - x.mean()
    wanted = [float(centred[k:] @ centred[: len(x) - k] / (centred @ centred)) for k in range(21)]
    assert np.allclose(autocorrelation([x], 20), wanted)


def test_gaps_and_tests_do_not_make_a_residual_look_white() -> None:
    rng = np.random.default_rng(1)
    whole = [np.convolve(rng.normal(size=2000), 0.8 ** np.arange(40), "valid") for _ in range(3)]
    holes = [np.where(rng.uniform(size=len(x)) < 0.5, np.nan, x) for x in whole]
    assert np.abs(autocorrelation(whole, 10) - 0.8 ** np.arange(11)).max() < 0.06
    assert np.abs(autocorrelation(holes, 10) - 0.8 ** np.arange(11)).max() < 0.08


def test_ljung_box_alarms_on_what_is_not_white_and_seldom_on_what_is() -> None:
    rng = np.random.default_rng(2)
    white = [ljung_box(autocorrelation([rng.normal(size=500)], 20), 500, 20).p_value for _ in range(400)]
    assert 0.02 < np.mean(np.array(white) < 0.05) < 0.09
    remembering = np.convolve(rng.normal(size=540), 0.5 ** np.arange(20), "valid")
    assert ljung_box(autocorrelation([remembering], 20), len(remembering), 20).p_value < 1e-6
    # Q by hand, for a short series
    r = np.array([1.0, 0.5, -0.25])
    assert ljung_box(r, 10, 2).q == pytest.approx(10 * 12 * (0.25 / 9 + 0.0625 / 8))


def test_a_residual_that_goes_with_a_state_shows_its_slope() -> None:
    rng = np.random.default_rng(3)
    states = [np.cumsum(rng.normal(size=400)) + 20 for _ in range(3)]
    residuals = [0.3 * (x - x.mean()) + rng.normal(0, 0.2, 400) for x in states]
    residuals[1][100:200] = np.nan
    found = against("T after 20 min", "K", states, residuals)
    assert found.slope == pytest.approx(0.3, abs=0.01)
    assert found.correlation > 0.9
    assert np.all(np.diff(found.means) > 0)
    assert abs(against("other", "K", [rng.normal(size=400)] * 3, residuals).correlation) < 0.15
