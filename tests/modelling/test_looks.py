"""How often the lock was opened: for each answer that is new, and for no other."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.diagnosis.choice import confirm_choice
from thermodata.diagnosis.locked.confirm import rmse
from thermodata.diagnosis.run import diagnose
from thermodata.modelling import run
from thermodata.modelling.named import newest_model
from thermodata.report.collected.collect import collect
from thermodata.report.page.page import locked_note
from thermodata.store.catalogue.models.looks import count_locked_look, locked_looks
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS, Spec, Stored


def test_each_response_of_a_model_is_a_look_of_its_own(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    both = [{"channel": "dZ"}, {"channel": "T_nut"}]
    model = run.fit(store, spec("ambient_frame", name="two", response=both)).model
    looks = [confirm_choice(store, model, "lag:T_bearing", of)[0].looks for of in ("dZ", "T_nut", "T_nut")]
    assert looks == [1, 2, 2]


def test_what_was_opened_with_another_is_new_by_itself(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path, fits=[spec("ambient_frame")])
    model = newest_model(store)
    locked = [t.key for t in world.tests if t.role == "locked"]
    count_locked_look(store, model, locked, "confirming lag:T_bearing, feed_screw:T_nut")
    assert confirm_choice(store, model, "lag:T_bearing")[0].looks == 2
    count_locked_look(store, model, locked, "confirming feed_screw:T_nut")
    assert confirm_choice(store, model, "feed_screw:T_nut")[0].looks == 3, "that look stands there already"


def test_what_no_locked_test_has_the_channel_of_is_answered_twice(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    locked = [t.test for t in world.tests if t.role == "locked"]
    store = stored(world, tmp_path, dict.fromkeys(locked, "T_nut"))
    model = run.fit(store, spec("ambient_frame", "spindle_bearing")).model
    first, known = confirm_choice(store, model, "feed_screw:T_nut")
    assert (first.tests, first.looks, known) == ([], 1, False)
    assert confirm_choice(store, model, "feed_screw:T_nut") == (first, True)


def test_a_report_counts_the_looks_of_all_models_as_confirm_does(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    first, other = (run.fit(store, spec("ambient_frame", name=name)).model for name in ("first", "other"))
    assert locked_note(collect(store, other)) == "Locked tests: none was opened."
    looks = [confirm_choice(store, model, "lag:T_bearing")[0].looks for model in (first, other)]
    assert (looks, collect(store, other).looks, collect(store, first).looks) == ([1, 2], {"c/t7": 2}, {"c/t7": 2})


def test_errors_that_were_shown_are_no_look_when_a_word_of_a_test_changed(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store, path = stored(world, tmp_path, fits=[spec("ambient_frame")]), tmp_path / "campaign.yaml"
    model = newest_model(store)
    first, _ = confirm_choice(store, model, "lag:T_bearing")
    path.write_text(path.read_text().replace("kind: spectrum", "kind: mixed"))
    assert model in ingest(store, path).stale
    again, known = confirm_choice(store, model, "lag:T_bearing")
    assert (again.tests, known) == (first.tests, False)
    assert (first.looks, again.looks) == (1, 1)
    raw = tmp_path / "raw" / "t0.csv"
    raw.write_text(raw.read_text().replace("0.1", "0.3"))
    ingest(store, path)
    other, _ = confirm_choice(store, model, "lag:T_bearing")
    assert other.tests != first.tests
    assert other.looks == 2, "other errors are a look"


def test_a_diagnosis_that_tells_the_same_is_no_look(stored: Stored, world: Dataset, spec: Spec, tmp_path: Path) -> None:
    store, path = stored(world, tmp_path, fits=[spec("ambient_frame")]), tmp_path / "campaign.yaml"
    model = newest_model(store)
    claims = [c for c in diagnose(store, model).candidates if c.claimed]
    assert claims
    path.write_text(path.read_text().replace("kind: spectrum", "kind: mixed"))
    ingest(store, path)
    assert [c.id for c in diagnose(store, model).candidates if c.claimed] == [c.id for c in claims]
    assert locked_looks(store, "c", "t7") == 1


def test_what_a_diagnosis_of_a_stale_model_opened_for_one_claim_is_no_look_for_it(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store, path = stored(world, tmp_path), tmp_path / "campaign.yaml"
    model = run.fit(store, spec(*(e for e in EFFECTS if e != "feed_screw"))).model
    path.write_text(path.read_text().replace("kind: spectrum", "kind: mixed"))
    ingest(store, path)
    (claim,) = [c.id for c in diagnose(store, model).candidates if c.claimed]
    assert locked_looks(store, "c", "t7") == 1
    assert confirm_choice(store, model, claim)[0].looks == 1


def test_a_choice_is_told_from_the_model_as_it_is_fitted(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    """It is fitted to one test, and judged beside its refit to all open ones."""
    store = stored(world, tmp_path)
    fitted = run.fit(store, spec("ambient_frame", "spindle_bearing", calibrate_on=["t0"], verify_on=["t1", "t2", "t3"]))
    found, _ = confirm_choice(store, fitted.model, "feed_screw:T_nut")
    loaded = run.load(store, fitted.model)
    own = rmse(loaded.fitted.responses[0], loaded.fitted.tests(loaded.data, "locked"))
    assert found.locked_rmse_um_fitted == pytest.approx(own)
    assert [t.rmse_um_fitted for t in found.tests] == [found.locked_rmse_um_fitted]
    assert found.locked_rmse_um_before != pytest.approx(found.locked_rmse_um_fitted, rel=0.1)
    again, known = confirm_choice(store, fitted.model, "feed_screw:T_nut")
    assert (again, known) == (found, True)
    whole = run.fit(store, spec("ambient_frame", "spindle_bearing", name="whole", in_sample=True))
    assert confirm_choice(store, whole.model, "feed_screw:T_nut")[0].locked_rmse_um_fitted is None
