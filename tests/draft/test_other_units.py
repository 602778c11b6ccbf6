"""One file in another unit is asked by its name."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.other_units import unit_question
from thermodata.draft.values import values_of


@pytest.mark.parametrize(
    ("quantity", "scales", "asked_of"),
    [
        ("temperature", [(1.0, 22.0), (1.0, 24.0), (1.0, 295.0)], "t2"),
        ("temperature", [(1.0, 295.0), (1.0, 296.0)], None),
        ("temperature", [(1.0, 22.0), (1.0, 80.0)], None),
        ("displacement", [(1.0, 0.0), (0.7, 3.0), (1e-3, 0.0)], "t2"),
        ("displacement", [(1.0, 0.0), (0.2, 3.0), (5.0, 0.0)], None),
        ("rotational_speed", [(1.0, 0.0), (1e-3, 0.0)], None),
    ],
)
def test_a_file_in_another_unit_is_asked(
    quantity: str, scales: list[tuple[float, float]], asked_of: str | None
) -> None:
    noise = np.random.default_rng(1).normal(size=300) + np.linspace(0.0, 20.0, 300)
    asked = unit_question(quantity, {f"t{i}": values_of(level + k * noise) for i, (k, level) in enumerate(scales)})
    assert (asked is None) == (asked_of is None)
    assert asked is None or asked.startswith(f"unit: in {asked_of} values ")
