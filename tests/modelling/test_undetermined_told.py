"""A diagnosis of a stored model tells what its fit leaves open."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.diagnosis.run import diagnose
from thermodata.effect.lag import lag
from thermodata.view.grid.dataset import Dataset

from .conftest import STEP, Change, Spec, Stored


def test_a_diagnosis_names_what_the_stored_fit_leaves_open(
    stored: Stored, world: Dataset, spec: Spec, changed: Change, tmp_path: Path
) -> None:
    data = world
    for test in world.tests[:-1]:
        nut, rest = test.values["T_nut"], 21 + np.random.default_rng(1).normal(0, 0.02, len(test.t_s))
        without = test.values["dZ"] - 2.0 * lag(nut - nut[0], 5400, STEP)
        data = changed(data, test.test, T_nut=rest, dZ=without)
    model = spec("spindle_bearing", "feed_screw", "ambient_frame", "centrifugal_shift", "coolant")
    found = diagnose(stored(data, tmp_path, fits=[model]), "base")
    assert [one.effect for one in found.undetermined] == ["feed_screw"]
    assert found.undetermined[0].elsewhere == "t7"
