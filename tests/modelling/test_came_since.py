"""Verification tests that came after the choice of a version's effects are new to it (versions/came_since.py)."""

from __future__ import annotations

from pathlib import Path

import yaml

from thermodata.modelling import run
from thermodata.modelling.add import add
from thermodata.modelling.named import fit_named
from thermodata.modelling.remove import remove
from thermodata.schema.result import FitResult
from thermodata.store import Store
from thermodata.store.catalogue.models import find_model
from thermodata.store.ingest.run import ingest
from thermodata.view.dataset import Dataset

from .conftest import Spec
from .test_run import stored

FRESH = "c/t6 took no part in the choice of the effects: not fitted, it stays a verification test"


def roles(result: FitResult) -> dict[str, str]:
    return {s.test: s.role for s in result.scores if s.phase == "all" and s.role.startswith("verification")}


def with_tests(store: Store, path: Path, *without: str) -> None:
    campaign = yaml.safe_load(path.read_text())
    campaign["tests"] = [t for t in campaign["tests"] if t["id"] not in without]
    other = path.with_name("other.yaml")
    other.write_text(yaml.safe_dump(campaign))
    ingest(store, other)


def test_a_refit_fits_no_verification_test_that_came_after_the_choice(
    world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store, path = stored(world, tmp_path), tmp_path / "campaign.yaml"
    with_tests(store, path, "t6")
    first = run.fit(store, spec("ambient_frame", "coolant"))
    chosen = add(store, first.model, "spindle_bearing:T_bearing", plain=True)
    assert roles(chosen) == {"t5": "verification (in-sample)"}
    assert fit_named(store, chosen.model).model == chosen.model
    with_tests(store, path)
    again = fit_named(store, chosen.model)
    assert roles(again) == {"t5": "verification (in-sample)", "t6": "verification"}
    assert again.parameters == chosen.parameters, "nothing of what was fitted has changed"
    assert FRESH in again.notes
    assert roles(run.compare(store, [again.model])[0]) == roles(again)
    less = remove(store, again.model, "coolant")
    assert (roles(less), FRESH in less.notes) == (roles(again), True)
    # a choice that is made now is made with it
    more = add(store, again.model, "feed_screw:T_nut", plain=True)
    assert set(roles(more).values()) == {"verification (in-sample)"}


def test_a_test_that_took_part_does_so_again_once_it_is_back(world: Dataset, spec: Spec, tmp_path: Path) -> None:
    store, path = stored(world, tmp_path), tmp_path / "campaign.yaml"
    chosen = add(store, run.fit(store, spec("ambient_frame")).model, "spindle_bearing:T_bearing", plain=True)
    with_tests(store, path, "t6")
    less = fit_named(store, chosen.model)
    assert roles(less) == {"t5": "verification (in-sample)"}
    with_tests(store, path)
    back = fit_named(store, less.model)
    assert roles(back) == roles(chosen)
    assert find_model(store, back.model).result.notes == []
