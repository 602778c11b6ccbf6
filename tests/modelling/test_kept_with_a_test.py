"""What is made of a test alone is made once, whoever asks; a changed copy of a test begins anew."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.effect import effect
from thermodata.modelling import fit_model
from thermodata.modelling.inputs import lead
from thermodata.modelling.inputs.drivers import make_drivers
from thermodata.modelling.least_squares.coarse import coarser
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS, Spec, make_test


def test_a_driver_is_made_once_and_anew_of_a_changed_copy() -> None:
    test = make_test(1, "calibration")
    lagged, named = (make_drivers(test, effect(n), {r: "T_nut"}) for n, r in (("lag", "u"), ("feed_screw", "nut")))
    assert np.shares_memory(lagged.values["u"], named.values["nut"])
    warmer = replace(test, values={**test.values, "T_nut": 2 * test.values["T_nut"]})
    found = make_drivers(warmer, effect("lag"), {"u": "T_nut"}).values["u"]
    np.testing.assert_allclose(found, 2 * lagged.values["u"])


def test_a_coarse_test_is_made_once() -> None:
    test = make_test(1, "calibration")
    assert coarser(test, 5) is coarser(test, 5)
    assert len(coarser(test, 4).t_s) == len(test.t_s) // 4


def test_a_further_fit_to_the_same_samples_asks_for_no_column_again(
    world: Dataset, spec: Spec, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []
    one, several = lead.guarded_basis, lead.guarded_bases

    def counted(*of: Any) -> Any:
        asked.append(of)
        return one(*of)

    def counted_of_each(effect: Any, of: Any, points: Any) -> Any:
        asked.extend((effect, drivers, point) for drivers in of for point in points)
        return several(effect, of, points)

    def fitted(data: Dataset, *effects: str) -> tuple[dict[str, float], int]:
        asked.clear()
        found = fit_model(spec(*effects), data, uncertainty=False).parameters()
        return {n: p.value for n, p in found.items()}, len(asked)

    monkeypatch.setattr(lead, "guarded_basis", counted)
    monkeypatch.setattr(lead, "guarded_bases", counted_of_each)
    data = replace(world, tests=tuple(replace(t) for t in world.tests))
    alone, _ = fitted(data, *EFFECTS[:1])
    first, many = fitted(replace(data, tests=tuple(replace(t) for t in data.tests)), *EFFECTS)
    after, fewer = fitted(data, *EFFECTS)
    again, least = fitted(data, *EFFECTS)
    assert least < fewer < many
    assert first == after == again
    assert fitted(data, *EFFECTS[:1])[0] == alone
