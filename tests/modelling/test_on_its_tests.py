"""The band of a prediction is of the tests that the model was fitted to, whatever was ingested since."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import thermodata
from thermodata.modelling import run
from thermodata.modelling.named import newest_model, of_which_version
from thermodata.notebook.stale import NoBandWarning, StaleModelWarning
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.forget import forget
from thermodata.view.grid.dataset import Dataset
from thermodata.view.lists.models import model_rows

from .conftest import EFFECTS, Spec, Stored


def test_tests_that_came_since_take_no_band_away(stored: Stored, world: Dataset, spec: Spec, tmp_path: Path) -> None:
    store = stored(world, tmp_path)
    forget(store, "c", "t0")
    model = run.fit(store, spec(*EFFECTS)).model
    opened = thermodata.open(store.path)
    before = {p.test: p.half for p in opened.model(model).predict("campaign:c")}
    assert before["t5"] is not None
    ingest(store, tmp_path / "campaign.yaml")
    assert not find_model(store, model).stale
    with warnings.catch_warnings():
        warnings.simplefilter("error", NoBandWarning)
        after = {p.test: p.half for p in opened.model(model).predict("campaign:c")}
    assert after.keys() - before.keys() == {"t0"}
    for test, half in before.items():
        np.testing.assert_allclose(after[test], half, rtol=1e-3)
    assert after["t0"] is not None


def test_a_band_that_is_lost_is_warned_of_in_python(stored: Stored, world: Dataset, spec: Spec, tmp_path: Path) -> None:
    store, path = stored(world, tmp_path, fits=[spec(*EFFECTS)]), tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("role: verification", "role: calibration"))
    assert ingest(store, path).stale == [newest_model(store)]
    with pytest.warns(NoBandWarning, match="the data changed"), pytest.warns(StaleModelWarning):
        made = thermodata.open(store.path).model().predict("campaign:c")
    assert all(p.half is None for p in made)


def test_a_name_of_two_fits_of_one_version_says_which_is_taken(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    forget(store, "c", "t0")
    before = run.fit(store, spec(*EFFECTS)).model
    ingest(store, tmp_path / "campaign.yaml")
    now = run.fit(store, spec(*EFFECTS)).model
    assert [(m.model, m.tests) for m in model_rows(store)] == [(now, 5), (before, 4)]
    told = f"'base': {now}, the newest of that name; {before} is version 1 too, of 4 tests, where it is of 5"
    assert of_which_version(store, "base") == told
    assert of_which_version(store, now) is None
