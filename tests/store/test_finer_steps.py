"""A declared resolution is held against the steps that the readings take."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

pytestmark = pytest.mark.usefixtures("installed_readers")
SAID = "its sensor is declared to read in steps of"


def notes(folder: Path, values: np.ndarray, resolution: str | None, unit: str = "degC") -> str:
    rows = [f"{10 * i},{x:.4f}" for i, x in enumerate(values)]
    (folder / "one.csv").write_text("\n".join([f"time [s],T1 [{unit}]", *rows, ""]))
    sensor = {} if resolution is None else {"sensor": {"resolution": resolution}}
    campaign = {
        "schema": "thermodata/campaign/1",
        "id": "steps",
        "sources": {"log": {"reader": "table", "files": "{test}.csv"}},
        "channels": {"T1": {"source": "log", "signal": "T1", "quantity": "temperature", **sensor}},
        "tests": [{"id": "one"}],
    }
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    return "\n".join(ingest(Store(folder / "store", create=True), folder / "campaign.yaml").notes)


def in_steps(of: float) -> np.ndarray:
    course = 20 + 8 * (1 - np.exp(-np.arange(600) / 150)) + np.random.default_rng(1).normal(0, of, 600)
    return np.round(course / of) * of


@pytest.mark.parametrize(("steps", "said"), [(0.01, True), (0.05, True), (0.1, False), (0.5, False)])
def test_steps_finer_than_half_the_declared_ones_are_told(tmp_path: Path, steps: float, said: bool) -> None:
    assert (SAID in notes(tmp_path, in_steps(steps), "0.2 K")) == said


def test_the_step_is_told_in_the_unit_of_the_channel(tmp_path: Path) -> None:
    fahrenheit = in_steps(0.1) * 1.8 + 32
    assert f"{SAID} 0.5 degC, and it was read in steps of 0.1 degC" in notes(tmp_path, fahrenheit, "0.9 degF", "degF")


@pytest.mark.parametrize("resolution", [None, "0.2 K"])
def test_nothing_is_told_of_what_is_not_declared_or_stands_still(tmp_path: Path, resolution: str | None) -> None:
    assert SAID not in notes(tmp_path, np.full(600, 20.0) if resolution else in_steps(0.01), resolution)
