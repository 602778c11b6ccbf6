"""A factor or a sign that stands in a name is asked: nobody can tell whether the values have it."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("-dZ [um]", "the name says '-': is that in the values? their sign is kept as it stands in the file"),
        ("dX*(-1) [um]", "the name says '*(-1)': is that in the values? their sign is kept as it stands"),
        (
            "dY x10 [um]",
            'x10\': is that in the values? then unit: "0.1 um", instead_of: um takes it out; "10^1 um"',
        ),
        (
            "T_front*10 [°C]",
            "'*10': is that in the values? then unit: \"0.1 °C\", instead_of: °C takes it out",
        ),
        ("dZ*0,5 [um]", "the name says '*0,5': is that in the values? values are read as they stand"),
        ("dZ [um]", ""),
        ("Weg X10 [um]", ""),  # the tenth probe of an axis
        ("d x1 [um]", ""),
        ("T-front [°C]", ""),
    ],
)
def test_a_factor_in_a_name_is_asked(name: str, asked: str) -> None:
    found = guess(name, name.partition("[")[2].rstrip("]"), "float64", values_of(np.linspace(20.0, 31.0, 50)))
    said = "; ".join(found.questions)
    assert asked in said if asked else "the name says" not in said


@pytest.mark.parametrize(
    ("name", "way"),
    [
        ("dX_tenths_um", 'then unit: "0.1 um", instead_of: um'),
        ("T_vorn_zehntel_degC", 'then unit: "0.1 degC", instead_of: degC'),
        ("dZ hundertstel mm", 'then unit: "0.01 mm", instead_of: mm'),
        ("dX_lengths_um", None),
        ("dZ_decimator_um", None),
    ],
)
def test_a_word_for_a_share_of_the_unit_is_asked(name: str, way: str | None) -> None:
    asked = " ".join(guess(name, None, "float64", values_of(np.linspace(20.0, 31.0, 300))).questions)
    assert way in asked if way else "the name says" not in asked
