"""The band of a prediction: it holds what was measured in tests that no fit has seen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from thermodata.modelling import fit_model
from thermodata.modelling.compare.ahead import Ahead, UnseenError, ahead, values_worth
from thermodata.modelling.predictions.predict import Predicted, predict
from thermodata.plugin import Float1D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import EFFECTS

Spec = Callable[..., Model]


def _gap(p: Predicted, test: TestData) -> Float1D:
    """Measured minus predicted, from the first samples."""
    gap = test.values["dZ"] - p.predicted
    return gap - gap[test.t_s < test.zero_s].mean()


@pytest.mark.parametrize("lacks", [0, 1, 2])
def test_a_band_holds_the_tests_that_were_locked(world: Dataset, spec: Spec, lacks: int) -> None:
    fitted = fit_model(spec(*EFFECTS[: len(EFFECTS) - lacks]), world)
    band = ahead(fitted, world)
    locked = [world.test(*key) for key in fitted.roles.locked]
    assert locked
    for p in (band.of(p) for p in predict(fitted, world)[0]):
        if (p.campaign, p.test) in fitted.roles.locked:
            assert p.half is not None
            inside = np.abs(_gap(p, world.test(p.campaign, p.test))) <= p.half
            assert inside.mean() > 0.9
            assert p.half.max() < 20 * band.left["dZ"].rms


def test_the_calibration_of_the_probe_widens_band_and_gains_by_one_factor(world: Dataset, spec: Spec) -> None:
    unsure = replace(
        world,
        tests=tuple(
            replace(t, channels={n: replace(c, scale_pct=2.0 if n == "dZ" else None) for n, c in t.channels.items()})
            for t in world.tests
        ),
    )
    exact, scaled = (fit_model(spec(*EFFECTS), data) for data in (world, unsure))
    name = "spindle_bearing.gain"
    before, after = (m.parameters()[name] for m in (exact, scaled))
    assert after.value == before.value
    assert None not in (before.high, after.high)
    assert after.high - after.value == pytest.approx(  # type: ignore[operator]
        np.hypot(before.high - before.value, 1.96 * 0.02 * before.value)  # type: ignore[operator]
    )
    tau = "spindle_bearing.tau"
    assert scaled.parameters()[tau] == exact.parameters()[tau], "no scale moves a time constant"
    narrow, wide = (
        next(p for p in map(ahead(m, d).of, predict(m, d)[0]) if p.half is not None)
        for m, d in ((exact, world), (scaled, unsure))
    )
    assert narrow.half is not None
    assert wide.half == pytest.approx(np.hypot(narrow.half, 1.96 * 0.02 * narrow.predicted))


def test_what_is_left_grows_beyond_what_was_predicted_in_the_tests() -> None:
    left = UnseenError("um", 0.5, 50.0, ("a", "b", "c", "d"), True, 4.0)
    assert left.times == pytest.approx(2.776, abs=1e-3)
    assert left.half(np.array([0.0, -50.0, 100.0])) == pytest.approx(left.times * np.array([0.5, 0.5, 1.0]))


def test_no_band_where_nothing_says_how_sure_the_model_is(world: Dataset, spec: Spec) -> None:
    fitted = fit_model(spec(*EFFECTS), world)
    (p, *_), _ = predict(fitted, world)
    assert ahead(fitted, world).of(p).half is not None
    kept = ahead(fitted, world, kept=True)
    assert kept.why_not is not None
    assert kept.of(p).half is None
    known = Ahead({"dZ": UnseenError("um", 0.5, 50.0, ("a", "b"), True, 2.0)}, {}, ("m1",))
    assert known.of(replace(p, machine="m1")).half is not None
    assert known.of(replace(p, machine="m2")).half is None
    unsure = predict(fit_model(spec(*EFFECTS), world, uncertainty=False), world)[0][0]
    assert known.of(unsure).half is None


def verifying(world: Dataset, *keys: str, **change: str) -> Dataset:
    """The world with these tests verifying, changed, and the others for calibration but for the locked ones."""
    tests = [
        replace(t, role="verification", **change) if t.test in keys else t  # type: ignore[arg-type]
        for t in world.tests
    ]
    return replace(world, tests=tuple(tests))


def test_the_reach_is_that_of_all_open_tests(world: Dataset, spec: Spec) -> None:
    """Verification tests in which the machine hardly moves made a band of 200 um where it does."""
    data = verifying(world, "t4", "t5", "t6")
    fitted = fit_model(spec(*EFFECTS), data)
    most = max(float(np.abs(r.predict(t)).max()) for r in fitted.responses for t in fitted.tests(data))
    assert ahead(fitted, data).left["dZ"].reach == pytest.approx(most, rel=0.05)


def test_tests_of_another_machine_say_nothing_of_this_one(world: Dataset, spec: Spec) -> None:
    here = replace(world, tests=tuple(replace(t, machine="A") for t in world.tests))
    other = verifying(here, "t4", "t5", "t6", machine="B")
    fitted = fit_model(spec(*EFFECTS), other)
    left = ahead(fitted, other).left["dZ"]
    assert left.refitted, "none of this machine verifies"
    assert not {"t4", "t5", "t6"} & {name.rpartition("/")[2] for name in left.tests}


def test_a_test_that_makes_all_of_what_is_left_counts_by_its_own_values() -> None:
    rng = np.random.default_rng(0)

    def worth(sizes: list[float]) -> float:
        gaps = [size * rng.standard_normal(400) for size in sizes]
        squares, values = np.array([np.mean(g**2) for g in gaps]), np.full(len(gaps), 10.0)
        return values_worth(squares, values)

    assert worth([1.0, 1.0, 1.0]) == pytest.approx(30.0, rel=0.1)
    assert worth([10.0, 0.1, 0.1]) == pytest.approx(10.0, rel=0.01)
