"""A model of the store whose data changed: its parameters stay those of its fit, and what changed is said."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from thermodata.cli.app import cli
from thermodata.errors import UsageError
from thermodata.modelling import comparing, run
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.named import fit_named, newest_model
from thermodata.modelling.versions.as_kept import as_kept
from thermodata.modelling.versions.result import make_result
from thermodata.report.collected.history import history_rows
from thermodata.report.text.fit import history_text
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.files.model import Model
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import load_diagnosis, save_diagnosis
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.catalogue.models.looks import open_in
from thermodata.store.catalogue.models.stale import came_after_line, stale_line
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.forget import forget
from thermodata.store.trace.lineage import trace
from thermodata.view.grid.dataset import Dataset
from thermodata.view.lists.events import about_test

from .conftest import EFFECTS, Spec, Stored

GROUPED = {"effect": "spindle_bearing", "gain_by": "test"}


def function(**more: Any) -> list[dict[str, Any]]:
    return [{"effect": "transfer_function", "drivers": {"u": "T_bearing"}, **more}]


@pytest.mark.parametrize(
    "effects",
    [
        EFFECTS,
        [GROUPED, *EFFECTS[1:]],
        [{**GROUPED, "one_gain": True}, *EFFECTS[1:]],
        function(method="varpro"),
        function(method="oe", orders=[2, 2]),
        function(method="arx", orders=[2, 2], delay=1),
    ],
    ids=["named", "gain_by", "one_gain", "varpro", "oe", "arx"],
)
def test_what_a_result_holds_predicts_as_the_fit_did(world: Dataset, spec: Spec, effects: list[dict[str, Any]]) -> None:
    fitted = fit_model(spec(*effects), world)
    kept = as_kept(fitted.spec, make_result(fitted, world, "m"), world)
    for test in fitted.tests(world):
        one, other = fitted.responses[0], kept.responses[0]
        if one.can_predict(test):
            np.testing.assert_allclose(other.residual(test), one.residual(test), rtol=1e-9, atol=1e-9)
    assert {*kept.parameters()} <= {*fitted.parameters()}, "what drives nothing here is no parameter of it"


@pytest.fixture
def edited(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> tuple[Store, str, Callable[[str, str], list[str]]]:
    """A store with a model, and an edit of its campaign file."""
    store = stored(world, tmp_path, fits=[spec(*EFFECTS)])
    model = newest_model(store)
    path = tmp_path / "campaign.yaml"

    def edit(old: str, new: str) -> list[str]:
        assert old in path.read_text()
        path.write_text(path.read_text().replace(old, new))
        return ingest(store, path).stale

    return store, model, edit


def test_a_stale_model_keeps_its_parameters_and_says_so(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], tmp_path: Path
) -> None:
    store, model, edit = edited
    was = find_model(store, model).result
    assert stale_line(store, model) is None
    assert edit("role: verification", "role: calibration") == [model]
    assert run.load(store, model).fitted.parameters()["spindle_bearing.gain"].value == pytest.approx(
        was.parameters["spindle_bearing.gain"].value, rel=1e-12
    )
    assert comparing.compare(store, [model]) == [was]
    line = stale_line(store, model)
    assert line is not None
    assert model in line
    assert "role of" in line
    assert f"thermodata fit {model}" in line
    for words in (
        ["show", model],
        ["compare", model, "--json"],
        ["portability", model],
        ["predict", model, "campaign:c"],
    ):
        said = CliRunner().invoke(cli, ["--store", str(store.path), *words])
        assert said.stderr.count("stale:") == 1, words
        assert said.exit_code in (0, 3), said.output
    again = run.fit(store, Model.model_validate(find_model(store, model).spec)).model
    assert again != model
    assert stale_line(store, again) is None


def test_a_model_that_a_reader_made_stale_names_the_reader(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.raw import streams

    store, model, edit = edited
    with store.reader() as con:
        (was,) = {v for (v,) in con.execute("select reader_version from source").fetchall()}
    monkeypatch.setattr(streams.registry, "distribution_version", lambda name: "99.1")
    assert edit("id: c\n", "id: c \n") == [model]
    line = str(stale_line(store, model))
    assert f"reader table {was} -> 99.1 of " in line
    assert "(data" not in line
    assert "calibration" not in line


@pytest.mark.parametrize("target", ["st", "json"])
def test_a_program_names_the_data_that_its_model_was_fitted_to(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], tmp_path: Path, target: str
) -> None:
    store, model, edit = edited
    out = tmp_path / "out"

    def written() -> str:
        words = ["model", "export", model, "--to", target, "--cycle", "60 s", "--out", str(out), "--force"]
        said = CliRunner().invoke(cli, ["--store", str(store.path), *words])
        assert said.exit_code == 0, said.output
        return next(out.glob("*")).read_text()

    fitted_to = find_model(store, model).data_version[:16]
    before = written()
    assert fitted_to in before
    assert "stale" not in before
    edit("role: verification", "role: calibration")
    after = written()
    assert fitted_to in after
    assert run.load_data(store, find_model(store, model).spec).data_version[:16] not in after
    assert "changed since it was fitted (role of" in after
    assert ("exponent" in after) == ("exponent" in before)


def test_advice_on_a_model_that_was_fitted_again_names_that_fit(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], spec: Spec
) -> None:
    store, model, edit = edited
    fewer = run.fit(store, spec(*EFFECTS[:1])).model
    edit("role: verification", "role: calibration")
    with pytest.raises(UsageError, match=f"thermodata fit {fewer}; thermodata fit {model}"):
        comparing.compare_against(store, [fewer], model)
    now = fit_named(store, model).model
    with pytest.raises(UsageError) as refused:
        comparing.compare_against(store, [fewer], model)
    assert f"thermodata fit {fewer};" in str(refused.value), "only what is left to do"
    assert f"fit {model}" not in str(refused.value)
    of_fewer = fit_named(store, fewer).model
    with pytest.raises(UsageError, match=f"thermodata compare {of_fewer} --against {now}"):
        comparing.compare_against(store, [fewer], model)
    assert comparing.compare_against(store, [of_fewer], now)
    assert f"{now} is it" in str(stale_line(store, model))
    assert "thermodata fit" not in str(stale_line(store, model))


def test_a_model_whose_data_are_set_back_is_as_it_was_fitted(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], tmp_path: Path
) -> None:
    store, model, edit = edited
    was = comparing.compare(store, [model])
    assert edit("role: verification", "role: none") == [model]
    assert edit("kind: spectrum", "kind: mixed") == []
    assert "description of " in str(stale_line(store, model))
    edit("kind: mixed", "kind: spectrum")
    line = str(stale_line(store, model))
    assert "role of " in line
    assert "description" not in line, "what was set back differs no more"
    assert edit("role: none", "role: verification") == []
    assert stale_line(store, model) is None
    assert not run.load(store, model).kept
    assert comparing.compare(store, [model]) == was
    raw = tmp_path / "raw" / "t0.csv"
    text = raw.read_text()
    for now, differs in ((text.replace("0.1", "0.3"), True), (text, False)):
        raw.write_text(now)
        ingest(store, tmp_path / "campaign.yaml")
        assert find_model(store, model).stale == differs


def test_a_test_that_came_back_is_without_its_results_until_the_model_is_fitted_again(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], tmp_path: Path
) -> None:
    store, model, _ = edited
    assert forget(store, "c", "t0")["stale"] == [model]
    assert "gone: t0" in str(stale_line(store, model))
    assert stale_line(store, model[:6]) == stale_line(store, model), "by a prefix, too"
    ingest(store, tmp_path / "campaign.yaml")
    assert "gone for a while: t0" in str(stale_line(store, model))
    assert run.fit(store, find_model(store, model).spec).model == model
    assert stale_line(store, model) is None


def test_a_history_says_which_tests_its_errors_are_without(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], tmp_path: Path
) -> None:
    store, model, edit = edited
    assert [row["gone"] for row in history_rows(store, model)] == [[]]
    assert "forgotten" not in history_text(history_rows(store, model))
    edit("kind: spectrum", "kind: mixed")
    assert [row["gone"] for row in history_rows(store, model)] == [[]], "stale, and with all its errors"
    forget(store, "c", "t0")
    said = f"c/t0 was forgotten after the fit of {model}: errors are without it"
    assert history_text(history_rows(store, model)).startswith(said)
    ingest(store, tmp_path / "campaign.yaml")
    (row,) = history_rows(store, model)
    assert row["gone"] == ["c/t0"], "back, and its errors are not"
    assert history_text([row]).startswith(said)
    (again,) = history_rows(store, fit_named(store, model).model)
    assert again["gone"] == []


def test_what_was_found_out_on_other_data_goes_where_they_are_set_back(
    edited: tuple[Store, str, Callable[[str, str], list[str]]],
) -> None:
    store, model, edit = edited
    found = {"model": model, "response": "dZ", "verdict": "none", "noise_um": 0.1, "rmse_um": 1.0, "explainable": 0.0}
    before, meanwhile = (
        Diagnosis.model_validate({**found, "next_test": told, "weak_spots": [], "candidates": [], "artefacts": []})
        for told in ("before", "meanwhile")
    )
    save_diagnosis(store, model, before)
    edit("role: verification", "role: none")
    edit("role: none", "role: verification")
    assert load_diagnosis(store, model) == before
    edit("role: verification", "role: none")
    save_diagnosis(store, model, meanwhile)
    edit("kind: spectrum", "kind: mixed")
    assert load_diagnosis(store, model) == meanwhile
    edit("kind: mixed", "kind: spectrum")
    edit("role: none", "role: verification")
    assert load_diagnosis(store, model) is None


def test_a_test_that_was_open_when_a_model_was_fitted_is_no_new_one_once_it_is_locked(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], world: Dataset
) -> None:
    store, model, edit = edited
    assert open_in(store, ["c"]) == {}
    edit("role: verification", "role: locked")
    was = [t.test for t in world.tests if t.role == "verification"]
    assert open_in(store, ["c"]) == {("c", name): [f"base {model}"] for name in was}
    assert about_test(store, "c", was[0]).open_in == (f"base {model}",)
    # and what is locked now stays shut in the model that saw it
    assert {run.load(store, model).fitted.roles.role(("c", name)) for name in was} == {"locked"}


def test_a_test_that_is_new_leaves_a_model_as_it_was_fitted(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], world: Dataset, tmp_path: Path
) -> None:
    store, model, edit = edited
    was = find_model(store, model).result
    name = next(t.test for t in world.tests if t.role == "calibration")
    (tmp_path / "raw" / "later.csv").write_text((tmp_path / "raw" / f"{name}.csv").read_text().replace("0.1", "0.3"))
    edit("tests:\n", "tests:\n- {id: later, kind: spectrum, role: calibration}\n")
    now = comparing.compare(store, [model])[0]
    assert now.parameters == was.parameters
    assert {s.role for s in now.scores if s.test == "later"} == {"verification"}


def later(store: Store, edit: Callable[[str, str], list[str]], folder: Path) -> None:
    """One more test, which leaves all models as they were fitted."""
    raw = folder / "raw"
    (raw / "later.csv").write_text((raw / "t0.csv").read_text().replace("0.1", "0.3"))
    assert edit("tests:\n", "tests:\n- {id: later, kind: spectrum, role: verification}\n") == []


def roles(store: Store, model: str) -> dict[str, str]:
    return {s.test: s.role for s in comparing.compare(store, [model])[0].scores if s.phase == "all"}


def test_a_test_more_leaves_the_roles_of_a_model_file(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    """What it locks stays shut, and what it does not use is not scored."""
    store, _, edit = edited
    verified = [t.test for t in world.tests if t.role == "verification"]
    shut = run.fit(store, spec(*EFFECTS, name="shut", locked=verified)).model
    few = run.fit(store, spec(*EFFECTS, name="few", calibrate_on=["t0", "t1"], verify_on=["t2"])).model
    was = roles(store, shut), roles(store, few)
    assert not set(verified) & set(was[0])
    later(store, edit, tmp_path)
    assert roles(store, shut) == {**was[0], "later": "verification"}
    assert roles(store, few) == was[1]
    assert run.load(store, shut).kept


def test_a_test_more_leaves_a_model_inside_of_a_model(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], spec: Spec, tmp_path: Path
) -> None:
    store, _, edit = edited
    run.fit(store, spec("ambient_frame", name="frame"))
    outer = run.fit(store, spec({"effect": "model", "name": "frame"}, "spindle_bearing", name="outer")).model
    was = comparing.compare(store, [outer])[0]
    later(store, edit, tmp_path)
    now = comparing.compare(store, [outer])[0]
    assert now.parameters == was.parameters
    assert {s.test: s.rmse_um for s in now.scores if s.test != "later"} == pytest.approx(
        {s.test: s.rmse_um for s in was.scores}
    )


def test_a_test_more_leaves_the_checks_of_each_response(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], spec: Spec, tmp_path: Path
) -> None:
    store, _, edit = edited
    both = [{"channel": "dZ"}, {"channel": "T_nut"}]
    model = run.fit(store, spec("ambient_frame", "spindle_bearing", name="two", response=both)).model

    def names() -> list[str]:
        return [c.name for c in comparing.compare(store, [model])[0].checks]

    was = names()
    assert any(n.partition(":")[2].startswith("dZ") for n in was)
    later(store, edit, tmp_path)
    assert names() == was


def test_the_scores_of_a_stale_model_stand_beside_no_weak_spots_of_other_data(
    edited: tuple[Store, str, Callable[[str, str], list[str]]],
) -> None:
    store, model, edit = edited
    edit("role: verification", "role: calibration")
    said = CliRunner().invoke(cli, ["--store", str(store.path), "compare", model, "--json"])
    assert json.loads(said.stdout)["weak_spots"] == {}


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("unit: um", "unit: mm", "(units or signals of "),
        ("kind: spectrum", "kind: mixed", "(description of "),
        ("role: verification", "role: calibration", "(role of "),
    ],
)
def test_what_changed_is_said_by_its_name(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], old: str, new: str, told: str
) -> None:
    store, model, edit = edited
    assert edit(old, new) == [model]
    assert told in str(stale_line(store, model))


def test_a_calibration_test_that_came_after_a_fit_is_told(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], tmp_path: Path
) -> None:
    store, model, _ = edited
    forget(store, "c", "t0")
    without = fit_named(store, model).model
    assert without != model
    assert f"{without} is it" in str(stale_line(store, model)), "of all that is there"
    assert came_after_line(store, find_model(store, without)) is None
    ingest(store, tmp_path / "campaign.yaml")
    line = str(stale_line(store, model))
    assert f"thermodata fit {model}" in line, "no fit is of the data as they are now"
    assert without not in line
    told = f"t0 is a calibration test that base {without} was not fitted to; thermodata fit {without} takes it in"
    assert came_after_line(store, find_model(store, without)) == told
    assert trace(store, without)["not_fitted_to"] == ["c/t0"]
    said = CliRunner().invoke(cli, ["--store", str(store.path), "compare", without])
    assert told in said.stderr
    now = fit_named(store, without).model
    assert now == model, "of the same data as at first"
    assert stale_line(store, model) is None
    assert f"{now} is fitted to it too" in str(came_after_line(store, find_model(store, without)))
    assert came_after_line(store, find_model(store, now)) is None
    assert trace(store, now)["not_fitted_to"] == []


def test_a_channel_that_is_called_otherwise_now_is_the_same_signal(
    edited: tuple[Store, str, Callable[[str, str], list[str]]], spec: Spec
) -> None:
    store, by_place, edit = edited
    of_file = spec({"effect": "spindle_bearing", "drivers": {"temperature": "T_bearing"}}, *EFFECTS[1:])
    model = run.fit(store, of_file).model
    was = run.load(store, model).fitted.parameters()
    assert edit("\n  T_bearing:", "\n  T_sp_vorn:") == [by_place, model]
    line = str(stale_line(store, model))
    assert "channel names of" in line
    assert "T_bearing is called T_sp_vorn now" in line
    assert "calibration of" not in line
    assert "units" not in line
    kept = run.load(store, model)
    assert kept.fitted.parameters()["spindle_bearing.gain"].value == was["spindle_bearing.gain"].value
    again = find_model(store, fit_named(store, model).model)
    assert "T_bearing is called T_sp_vorn now" in again.result.notes
    assert again.result.parameters["spindle_bearing.gain"].value == pytest.approx(was["spindle_bearing.gain"].value)
    assert f"{again.model} is it" in str(stale_line(store, model))
    with pytest.raises(UsageError, match="try: 'T_sp_vorn': the same signal is called that now"):
        run.fit(store, of_file)
    edit("\n  T_sp_vorn:", "\n  T_bearing:")
    assert stale_line(store, model) is None
