"""Why a test is not fitted to: only what is ruled out there is said to be so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.errors import UsageError
from thermodata.modelling import fit_model
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import Spec


def skipped(data: Dataset, spec: Spec, driver: str) -> str:
    fitted = fit_model(spec({"effect": "lag", "drivers": {"u": driver}}), data, uncertainty=False)
    return "; ".join(fitted.skipped)


def with_shifted(data: Dataset, without: str | None = None) -> Dataset:
    """The first test has T_nut off by one number, and lacks a channel."""

    def changed(test: TestData) -> TestData:
        channels = {**test.channels, "T_nut": replace(test.channels["T_nut"], shifted=True)}
        return replace(test, channels=channels, values={n: v for n, v in test.values.items() if n != without})

    return replace(data, tests=(changed(data.tests[0]), *data.tests[1:]))


def test_a_shifted_sensor_is_not_blamed_for_a_channel_that_is_not_logged(world: Dataset, spec: Spec) -> None:
    said = skipped(with_shifted(world, without="T_hall"), spec, "T_nut - T_hall")
    assert "no driver for lag" in said
    assert "T_nut" not in said


@pytest.mark.parametrize(
    ("driver", "lost"),
    [
        ("T_nut", False),
        ("T_nut - T_hall", False),
        ("0.5 * T_nut + 0.3 * T_hall", False),
        ("T_nut * speed", True),
        ("T_nut * T_nut", True),
        ("T_nut > 25", True),
        ("T_nut > 500", True),
        ("T_hall * speed", False),
    ],
)
def test_a_shifted_sensor_loses_a_test_where_its_constant_stays(
    world: Dataset, spec: Spec, driver: str, lost: bool
) -> None:
    said = skipped(with_shifted(world), spec, driver)
    assert ("'T_nut' is flagged 'offset' there, so the fit lost this test" in said) is lost


@pytest.mark.parametrize(
    ("gone", "told"), [("dZ", "a probe in volts has no displacement"), ("T_nut", "take the effect")]
)
def test_what_to_give_is_of_what_all_tests_lack(world: Dataset, spec: Spec, gone: str, told: str) -> None:
    fitted = {t.test for t in world.tests if t.role == "calibration"}
    tests = tuple(
        replace(t, values={n: v for n, v in t.values.items() if n != gone or t.test not in fitted}) for t in world.tests
    )
    with pytest.raises(UsageError) as refused:
        fit_model(spec("feed_screw"), replace(world, tests=tests))
    assert told in str(refused.value.hint)
