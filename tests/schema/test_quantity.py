"""Units as labs write them, and their conversion."""

from __future__ import annotations

from typing import Any

import pytest

from thermodata.errors import UsageError
from thermodata.schema.units.conversion import delta_factor, linear_conversion
from thermodata.schema.units.quantity import CANONICAL_UNIT, QUANTITIES, canonical
from thermodata.schema.units.time_of_parts import time_of_parts
from thermodata.schema.units.unit import AT_HAND, compound_unit, is_unit, normal_unit
from thermodata.schema.units.value import split_value, value_in


@pytest.mark.parametrize(
    ("written", "target", "factor", "offset"),
    [
        ("1/min", "rpm", 1, 0),
        ("U/min", "rpm", 1, 0),
        ("min-1", "rpm", 1, 0),
        ("min⁻¹", "rpm", 1, 0),
        ("ot/min", "rpm", 1, 0),
        ("RPM", "rpm", 1, 0),
        ("1/s", "rpm", 60, 0),
        ("Hz", "rpm", 60, 0),
        ("1/ min", "rpm", 1, 0),
        ("Deg C", "degC", 1, 0),
        ("Grd C", "degC", 1, 0),
        ("°C", "degC", 1, 0),
        ("C", "degC", 1, 0),
        ("[degC]", "degC", 1, 0),
        ("K", "degC", 1, -273.15),
        ("degF", "degC", 5 / 9, -160 / 9),
        ("µm", "um", 1, 0),
        ("μm", "um", 1, 0),
        ("mm", "um", 1000, 0),
        ("nm", "um", 1e-3, 0),
        ("Nm", "N m", 1, 0),
        ("N·m", "N m", 1, 0),
        ("W", "kW", 1e-3, 0),
        ("KW", "kW", 1, 0),
        ("mm/min", "m/min", 1e-3, 0),
        ("mm/s", "m/min", 0.06, 0),
        ("% RH", "%", 1, 0),
        ("Volts", "V", 1, 0),
        ("mV", "V", 1e-3, 0),
        ("mA", "A", 1e-3, 0),
        ("um/m", "urad", 1, 0),
        ("mm/m", "urad", 1e3, 0),
        ("mrad", "urad", 1e3, 0),
        ("mbar", "bar", 1e-3, 0),
        ("l/h", "l/min", 1 / 60, 0),
        ("W/m²", "W/m2", 1, 0),
    ],
)
def test_conversions(written: str, target: str, factor: float, offset: float) -> None:
    assert linear_conversion(written, target) == pytest.approx((factor, offset), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("written", "target"),
    [("V", "um"), ("degC", "um"), ("rpm", "m/min"), ("furlongs per nonsense", "um"), ("um", "degC"), ("m", "m/min")],
)
def test_units_of_another_kind_are_refused(written: str, target: str) -> None:
    with pytest.raises(UsageError, match="does not convert"):
        linear_conversion(written, target)


def test_every_quantity_has_a_canonical_unit_that_is_one() -> None:
    assert set(CANONICAL_UNIT) == set(QUANTITIES)
    for quantity in QUANTITIES:
        assert linear_conversion(canonical(quantity), canonical(quantity)) == (1.0, 0.0)
        assert canonical(quantity) == "1" or is_unit(canonical(quantity))


def test_an_unknown_quantity_names_the_nearest() -> None:
    with pytest.raises(UsageError, match="temperature"):
        canonical("temprature")


def test_differences_have_no_zero_point() -> None:
    assert delta_factor("K", "degC") == pytest.approx(1.0)
    assert delta_factor("degF", "K") == pytest.approx(5 / 9)


def test_compound_units() -> None:
    assert linear_conversion(compound_unit("um", "/", "mm"), "urad")[0] == pytest.approx(1000.0)
    assert compound_unit("mm", "/", "mm") == ""
    assert linear_conversion(compound_unit("um/K", "*", "degC"), "um")[0] == pytest.approx(1.0)
    assert linear_conversion(compound_unit("", "/", "s"), "rpm")[0] > 0


def test_what_is_a_unit() -> None:
    assert [is_unit(u) for u in ("mm", "m/min", "°C", "1/min", "x", "mm/x", "", "speed")] == [
        True,
        True,
        True,
        True,
        False,
        False,
        False,
        False,
    ]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("9000 rpm", (9000.0, "rpm")),
        ("-3.2 s", (-3.2, "s")),
        ("1,5 mm", (1.5, "mm")),
        ("1e3um", (1000.0, "um")),
        (5, (5.0, "")),
        ("210", (210.0, "")),
        ("6000 1/min", (6000.0, "1/min")),
    ],
)
def test_values_split_from_their_units(text: str | int, wanted: tuple[float, str]) -> None:
    assert split_value(text) == wanted


@pytest.mark.parametrize("text", ["", "rpm", True, None, "--3 s", "nan s"])
def test_what_has_no_number_is_refused(text: object) -> None:
    with pytest.raises(UsageError):
        split_value(text)  # type: ignore[arg-type]


def test_a_value_needs_its_unit_unless_it_is_zero() -> None:
    assert value_in("10 min", "s") == 600.0
    assert value_in("61365 h 1 s", "s") == 61365 * 3600 + 1
    assert value_in("-1 d 2 h 30 min", "s") == -(26.5 * 3600)
    assert value_in("12 min50.5s", "s") == 770.5
    assert value_in(0, "s") == 0.0
    with pytest.raises(UsageError, match="without a unit"):
        value_in(10, "s")


def test_units_at_hand_are_units_of_pint() -> None:
    import pint

    registry: Any = pint.UnitRegistry()
    for unit in sorted(AT_HAND):
        assert normal_unit(unit) in AT_HAND
        registry.parse_units(unit)
        assert is_unit(unit)
    assert not any(is_unit(word) for word in ("", "  ", "x", "hour12", "speed"))


@pytest.mark.parametrize("blanks", ["1" + " " * 5000 + "x", " " * 5000 + "1 h 1 s", "1 h" + " " * 5000 + "x"])
def test_a_time_of_many_blanks_is_answered_at_once(blanks: str) -> None:
    """A pattern whose parts may all be missing tried every way to share the blanks out: 200 took for ever."""
    assert time_of_parts(blanks) == (3601.0 if blanks.endswith("s") else None)
