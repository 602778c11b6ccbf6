"""Units of the gains that `show` prints: the response's over what drives it."""

from __future__ import annotations

import pytest

from thermodata.effect import law
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.seen.as_system import see
from thermodata.modelling.seen.drive_unit import over_unit, powers_of
from thermodata.view.grid.dataset import Dataset

from .conftest import Spec

UNITS = {"T": "K", "T2": "K", "on": "1", "n": "rpm", "v": "mm/min", "p": "kW"}


@pytest.mark.parametrize(
    ("drive", "said"),
    [
        ("T", "um/K"),
        ("on", "um"),
        ("T * on", "um/K"),
        ("on * (T - T2)", "um/K"),
        ("T - 20", "um/K"),
        ("abs(T - T2) / 2", "um/K"),
        ("where(n > 100, T, 0)", "um/K"),
        ("lag(T, 60) - T", "um/K"),
        ("T / T2", "um"),
        ("n ** 2", "um/rpm^2"),
        ("n * n", "um/rpm^2"),
        ("T * v", "um/(K mm/min)"),
        ("v", "um/(mm/min)"),
        ("v ** 1.4", "um/((mm/min)^1.4)"),
        ("v ** 0.99999999", "um/(mm/min)"),  # as a fit has it
        ("T + n", "um"),
    ],
)
def test_a_gain_has_the_unit_of_the_response_over_that_of_its_drive(drive: str, said: str) -> None:
    assert over_unit("um", powers_of(law.parse(drive), UNITS)) == said


def test_a_path_of_a_product_has_it_too_and_its_state(world: Dataset, spec: Spec) -> None:
    effect = {"effect": "coolant_heat", "drivers": {"temperature": "T_bearing", "state": "coolant_on"}}
    (one,) = see(fit_model(spec(effect), world), world)
    assert [path.unit for path in one.paths] == ["um/K"]
    assert {state.unit for state in one.states} == {"K"}


@pytest.mark.parametrize(
    ("effect", "said", "state"),
    [
        ({"effect": "spindle_friction", "drivers": {"speed": "speed"}}, "um", "1"),
        ({"effect": "centrifugal_shift"}, "um", "1"),
        ({"effect": "lag", "drivers": {"u": "speed"}}, "um/rpm", "rpm"),
        ({"effect": "lag", "drivers": {"u": "speed / 1000"}}, "um/rpm", "rpm"),
    ],
)
def test_a_gain_at_a_reference_has_the_unit_of_the_response(
    world: Dataset, spec: Spec, effect: dict[str, object], said: str, state: str
) -> None:
    fitted = fit_model(spec(effect), world)
    (one,) = see(fitted, world)
    assert [path.unit for path in one.paths] == [said]
    assert {s.unit for s in one.states} == {state}
