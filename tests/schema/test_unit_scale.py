from __future__ import annotations

import pytest

from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.scale import scaled_unit, with_power_of_ten
from thermodata.schema.units.unit import is_unit


@pytest.mark.parametrize(
    ("written", "target", "factor", "offset"),
    [
        ("10^3/min", "rpm", 1000.0, 0.0),
        ("10³/min", "rpm", 1000.0, 0.0),
        ("10^3 1/min", "rpm", 1000.0, 0.0),
        ("1000/min", "rpm", 1000.0, 0.0),
        ("1e3 rpm", "rpm", 1000.0, 0.0),
        ("1/10 °C", "degC", 0.1, 0.0),
        ("1/10 °C", "K", 0.1, 273.15),
        ("0,1 µm", "um", 0.1, 0.0),
        ("10^-3 mm", "um", 1.0, 0.0),
        ("1/min", "rpm", 1.0, 0.0),
    ],
)
def test_a_power_or_a_fraction_before_a_unit_scales_it(written: str, target: str, factor: float, offset: float) -> None:
    assert is_unit(written)
    assert linear_conversion(written, target) == pytest.approx((factor, offset))


def test_a_value_in_a_scaled_target_is_divided() -> None:
    assert linear_conversion("rpm", "10^3/min") == pytest.approx((0.001, 0.0))


@pytest.mark.parametrize("written", ["100 um", "10 V", "°C*10", "x1000 rpm", "1/10", "10^3", "0,15 um"])
def test_a_range_and_a_factor_of_unknown_sense_scale_nothing(written: str) -> None:
    assert scaled_unit(written) == (1.0, written)


def test_a_factor_behind_a_unit_is_no_unit() -> None:
    assert not is_unit("°C*10")


@pytest.mark.parametrize(
    ("factor", "unit"),
    [
        (0.1, "0.1 um"),
        (0.01, "0.01 um"),
        (10.0, "10^1 um"),
        (1000.0, "10^3 um"),
        (0.5, None),
        (1.0, None),
        (-1.0, None),
    ],
)
def test_a_power_of_ten_is_written_into_a_unit(factor: float, unit: str | None) -> None:
    assert with_power_of_ten(factor, "um") == unit
    if unit is not None:
        assert scaled_unit(unit) == (pytest.approx(factor), "um")
