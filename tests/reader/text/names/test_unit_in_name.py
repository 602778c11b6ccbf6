"""A name that says another unit than its file: both sides, and spellings of one unit."""

from __future__ import annotations

import pytest

from thermodata.reader.text.names.unit_in_name import other_unit


@pytest.mark.parametrize(
    ("name", "unit", "own"),
    [
        ("dZ [mm]", "µm", "mm"),
        ("Z2_mm", "um", "mm"),
        ("Log/n [1/s]", "1/min", "1/s"),
        ("T_Lager [°C]", "K", "°C"),
        ("T_Lager_degC", "°F", "degC"),
        ("T (C)", "°F", "C"),
        ("dX（mm）", "um", "mm"),
        ("Eddy_Z [V]", "µm", "V"),
        ("Sonde_um", "V", "um"),
        ("dZ [µm]", "um", None),
        ("dZ_um", "μm", None),
        ("n [U/min]", "rpm", None),
        ("n [1/min]", "U/min", None),
        ("f [1/s]", "Hz", None),
        ("T [Grad C]", "degC", None),
        ("T [°]", "°C", None),
        ("Strom (A)", "V", None),  # a phase
        ("T_Motor (min)", "°C", None),
        ("dZ [10 nm]", "mm", None),  # a range, or a count
        ("dZ [mm]", None, None),
        ("dZ [mm]", "1", None),
        ("dZ", "mm", None),
        ("Zustand [Ein]", "mm", None),
    ],
)
def test_the_unit_of_a_name_that_contradicts_its_file(name: str, unit: str | None, own: str | None) -> None:
    assert other_unit(name, unit) == own


def test_a_kelvin_of_a_difference_is_a_degree() -> None:
    assert other_unit("dT [K]", "°C", difference=True) is None
    assert other_unit("dT [K]", "°F", difference=True) == "K"
