"""A probe that logs in mm is a displacement, asked, however far its values go; a laser's error codes are no reading."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import Values, values_of

WIDE = values_of(np.linspace(-40.0, 40.0, 60))
SMALL = values_of(np.linspace(0.1, 0.2, 60))


@pytest.mark.parametrize("name", ["Taster Nest +Z", "probe.z", "Palpeur Z", "Tastatore Z", "S1 nid Z", "Sonda Z"])
@pytest.mark.parametrize("values", [WIDE, SMALL, None])
def test_a_probe_is_asked_whatever_its_range(name: str, values: Values | None) -> None:
    found = guess(name, "mm", "float64", values)
    assert (found.quantity, found.axis, found.at) == ("displacement", "Z", "tcp")
    assert "quantity: displacement, or the position of the axis?" in found.questions


@pytest.mark.parametrize("name", ["Z", "Spindle Z", "Bett Z"])
def test_what_names_no_probe_is_a_position_where_it_goes_far(name: str) -> None:
    assert guess(name, "mm", "float64", WIDE).quantity == "position"


@pytest.mark.parametrize("code", [-99999.99999, 99.9999, 9999.999, -9999.0])
def test_rows_of_nines_that_a_laser_writes_stay_out_of_the_range(code: float) -> None:
    found = values_of(np.concatenate([np.linspace(0.1, 0.2, 300), np.full(100, code)]))
    assert found is not None
    assert (found.low, found.high) == (0.1, 0.2)


def test_a_row_of_nines_among_others_is_a_reading() -> None:
    found = values_of(np.linspace(0.0, 99.99, 300))
    assert found is not None
    assert found.high == 99.99
