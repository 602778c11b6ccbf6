"""Bands: as wide as a prediction really spreads when the noise is drawn anew."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.modelling import fit_model
from thermodata.modelling.predictions.bands import bands
from thermodata.modelling.predictions.table import prediction_columns
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS

Spec = Callable[..., Model]
DRAWS = 24


def _redrawn(world: Dataset, seed: int) -> Dataset:
    rng = np.random.default_rng(seed)
    tests = tuple(
        replace(t, values={**t.values, "dZ": t.values["dZ"] + 0.6 * rng.standard_normal(len(t.t_s))})
        for t in world.tests
    )
    return replace(world, tests=tests)


def test_bands_are_as_wide_as_predictions_spread(world: Dataset, spec: Spec) -> None:
    small = replace(world, tests=tuple(t for t in world.tests)[:4])
    model = spec(*EFFECTS[:2], "ambient_frame", "centrifugal_shift", "coolant")
    unseen = world.tests[1]
    found: list[dict[str, Any]] = []
    for seed in range(DRAWS):
        response = fit_model(model, _redrawn(small, seed)).responses[0]
        said = bands(response, unseen)
        assert said.predicted is not None
        parts = {t.id: t.contribution(unseen) for t in response.terms}
        whole = np.sum(list(parts.values()), axis=0)
        start = response.offset_from(unseen)
        found.append(
            {"predicted": (whole - whole[start].mean(), said.predicted)}
            | {name: (y, said.contributions[name]) for name, y in parts.items()}
        )
    for name in found[0]:
        curves = np.array([f[name][0] for f in found])
        told = np.sqrt(np.mean([f[name][1] ** 2 for f in found], axis=0))
        real = curves.std(axis=0, ddof=1)
        counts = told > 0.2 * told.max()
        ratio = float(np.sqrt(np.mean(real[counts] ** 2) / np.mean(told[counts] ** 2)))
        assert 0.6 < ratio < 1.5, (name, ratio)


def test_no_band_where_nothing_was_fitted_or_nothing_is_known(world: Dataset, spec: Spec) -> None:
    fixed = spec(
        {"effect": "spindle_bearing", "drivers": {"temperature": "T_bearing"}, "fixed": {"gain": 1.5, "tau": 20}}
    )
    response = fit_model(fixed, world).responses[0]
    assert bands(response, world.tests[0]).predicted is None
    unsure = fit_model(spec("spindle_bearing"), world, uncertainty=False).responses[0]
    assert bands(unsure, world.tests[0]).predicted is None
    assert not [n for n in prediction_columns(unsure, world.tests[0]) if n.startswith("sd__")]


def test_the_band_is_narrow_where_the_offset_ties_it(world: Dataset, spec: Spec) -> None:
    response = fit_model(spec(*EFFECTS), world).responses[0]
    verified = next(t for t in world.tests if t.key not in response.calibrate and t.role == "verification")
    sd = bands(response, verified).predicted
    assert sd is not None
    start = response.offset_from(verified)
    assert sd[start].max() < 0.1 * sd.max()  # nothing has moved yet
    columns = prediction_columns(response, verified)
    assert columns["sd__predicted"] == pytest.approx(sd[verified.in_window], rel=1e-5)
