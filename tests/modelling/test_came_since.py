"""Verification tests that came after the choice of a version's effects are new to it (versions/came_since.py)."""

from __future__ import annotations

from pathlib import Path

import yaml

from thermodata.modelling import comparing, run
from thermodata.modelling.add import add
from thermodata.modelling.named import fit_named
from thermodata.modelling.remove import remove
from thermodata.report.collected.collect import collect
from thermodata.report.page.page import render
from thermodata.schema.answers.candidate import Candidate, LeftOut
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.result import FitResult
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import save_diagnosis
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.dataset import Dataset
from thermodata.view.grid.load import data_version

from ..answers import candidate, diagnosis
from .conftest import Spec, Stored

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
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
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
    assert roles(comparing.compare(store, [again.model])[0]) == roles(again)
    less = remove(store, again.model, "coolant")
    assert (roles(less), FRESH in less.notes) == (roles(again), True)
    # a choice that is made now is made with it
    more = add(store, again.model, "feed_screw:T_nut", plain=True)
    assert set(roles(more).values()) == {"verification (in-sample)"}


def test_a_test_that_took_part_does_so_again_once_it_is_back(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store, path = stored(world, tmp_path), tmp_path / "campaign.yaml"
    chosen = add(store, run.fit(store, spec("ambient_frame")).model, "spindle_bearing:T_bearing", plain=True)
    with_tests(store, path, "t6")
    less = fit_named(store, chosen.model)
    assert roles(less) == {"t5": "verification (in-sample)"}
    with_tests(store, path)
    back = fit_named(store, less.model)
    assert roles(back) == roles(chosen)
    assert find_model(store, back.model).result.notes == []


def test_a_verification_test_that_came_after_the_diagnosis_is_said_to_be_fitted(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store, path = stored(world, tmp_path), tmp_path / "campaign.yaml"
    with_tests(store, path, "t6")
    first = run.fit(store, spec("ambient_frame", "coolant"))
    asked = [s.test for s in first.scores if s.role in ("calibration", "verification") and s.phase == "all"]
    found = candidate_on("spindle_bearing:T_bearing", asked)
    kept = diagnosis_of(first.model, found, find_model(store, first.model).data_version)
    save_diagnosis(store, first.model, kept)
    said = "c/t6 came after the diagnosis that this is chosen by; it is fitted all the same (in-sample)"
    assert not any(said in note for note in add(store, first.model, 1, plain=True).notes)
    with_tests(store, path)
    chosen = add(store, first.model, 1, plain=True)
    assert roles(chosen)["t6"] == "verification (in-sample)"
    assert any(said in note for note in chosen.notes)
    # what the user names is chosen now
    own = add(store, first.model, "feed_screw:T_nut", plain=True)
    assert not any(said in note for note in own.notes)
    # and so is what is chosen by a diagnosis that was asked of it
    again = diagnosis_of(first.model, candidate_on(found.id, [*asked, "t6"]), "another")
    save_diagnosis(store, first.model, again)
    assert not any(said in note for note in add(store, first.model, 1, plain=True).notes)


def test_a_report_says_at_its_top_what_is_older_than_the_data(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store, path = stored(world, tmp_path), tmp_path / "campaign.yaml"
    with_tests(store, path, "t6")
    first = run.fit(store, spec("ambient_frame", "coolant"))
    kept = diagnosis_of(
        first.model, candidate_on("spindle_bearing:T_bearing", ["t5"]), find_model(store, first.model).data_version
    )
    save_diagnosis(store, first.model, kept)
    chosen = add(store, first.model, 1, plain=True)
    assert (collect(store, first.model).older, collect(store, chosen.model).older) == ((), ())
    with_tests(store, path)
    tests, asked = collect(store, first.model).older
    assert "not those that there were when this model was fitted" in tests
    assert "Everything here but the diagnosis is of a fit to the tests that there are now" in tests
    assert asked.startswith("The diagnosis is older than the data")
    alert = f'<div class="alert">{asked}.</div>'
    page = render(collect(store, first.model))
    assert alert in page
    assert page.index(alert) < page.index("<h2>Errors")
    # of what led to a version
    assert (
        collect(store, chosen.model)
        .older[-1]
        .startswith(f"What was missing before is told by the diagnosis of an earlier version, {first.model}")
    )
    # asked anew it is as old as the data
    save_diagnosis(store, first.model, kept.model_copy(update={"data_version": data_version(store, ["c"])}))
    (tests,) = collect(store, first.model).older
    assert "Everything here is of a fit" in tests


def candidate_on(name: str, tests: list[str]) -> Candidate:
    left = [
        LeftOut(campaign="c", test=t, from_s=0.0, to_s=1.0, acts=True, rmse_um_before=5.0, rmse_um_after=3.0)
        for t in tests
    ]
    return candidate(name, claimed=True, left_out=left)


def diagnosis_of(model: str, found: Candidate, data_version: str) -> Diagnosis:
    return diagnosis(found, model=model, data_version=data_version)
