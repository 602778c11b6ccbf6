"""What diagnose can't tell apart is said where both are added (modelling/add.py)."""

from __future__ import annotations

from pathlib import Path

from thermodata.modelling import run
from thermodata.modelling.add import add
from thermodata.store.catalogue.models.findings import save_diagnosis
from thermodata.view.grid.dataset import Dataset

from ..answers import candidate, diagnosis
from .conftest import Spec, Stored


def test_two_that_the_tests_can_not_tell_apart_are_said_to_be_one(
    world: Dataset, spec: Spec, stored: Stored, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    parent = run.fit(store, spec("spindle_bearing", name="parent")).model
    both = ("feed_screw:T_nut", "lag:T_nut")
    rows = [candidate(both[0], claimed=True, equivalent=[both[1]]), candidate(both[1], rank=2)]
    save_diagnosis(store, parent, diagnosis(*rows, model=parent))
    (said,) = [note for note in add(store, parent, *both, plain=True).notes if "both added" in note]
    assert said.startswith(f"{both[0]} and {both[1]} are both added, and these tests can't tell them apart")
    assert not [note for note in add(store, parent, both[0], plain=True).notes if "both added" in note]
