"""A driver that cycles before the log begins brings its lag into the test in step."""

from __future__ import annotations

import numpy as np

from thermodata.effect.lag import lag
from thermodata.modelling.inputs.lead import with_lead
from thermodata.plugin import Drivers

STEP_S = 60.0
TAU_S = 1500.0


def drivers(values: np.ndarray) -> Drivers:
    t_s = np.arange(len(values)) * STEP_S
    return Drivers(t_s, {"u": values}, {"u": np.ones(len(values), bool)}, {})


def cycle(n: int, first: int = 0) -> np.ndarray:
    k = np.arange(first, first + n)
    return 2.0 * np.abs((k % 25) / 12.5 - 1.0) - 1.0 + 0.001 * np.sin(7.0 * k)


def test_a_lag_of_a_cycling_driver_starts_where_it_would_be() -> None:
    whole = cycle(2000)
    truth = lag(whole, TAU_S, STEP_S)[1007:]
    led, lead = with_lead(drivers(whole[1007:]))
    assert lead > 0
    assert len(led.t_s) == len(led.values["u"]) == len(led.valid["u"]) == lead + len(truth)
    with_cycle = lag(led.values["u"], TAU_S, STEP_S)[lead:]
    without = lag(whole[1007:], TAU_S, STEP_S)
    assert np.abs(with_cycle - truth).max() < 0.1 * np.abs(without - truth).max()


def test_a_driver_that_heats_up_from_rest_has_no_lead() -> None:
    heating = 10.0 * (1 - np.exp(-np.arange(600) / 60.0))
    made, lead = with_lead(drivers(heating))
    assert lead == 0
    np.testing.assert_array_equal(made.values["u"], heating)


def test_what_does_not_cycle_was_at_rest_before() -> None:
    both = Drivers(
        np.arange(600) * STEP_S,
        {"a": cycle(600, 6), "n": np.full(600, 3000.0)},
        {"a": np.ones(600, bool), "n": np.ones(600, bool)},
        {},
    )
    led, lead = with_lead(both)
    assert lead > 0
    assert not led.values["n"][:lead].any()
    assert (led.values["n"][lead:] == 3000.0).all()
