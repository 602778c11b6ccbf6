"""From a store and back: fit, look again, add an effect, carry over. The logs are plain CSV files."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from thermodata.cli.look.query import sql_command
from thermodata.errors import StoreError, UsageError
from thermodata.modelling import comparing, run
from thermodata.modelling.add import add, chosen_id
from thermodata.modelling.named import fit_named
from thermodata.modelling.on_locked import locked_errors
from thermodata.modelling.remove import remove
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.modelling.versions.same_tests import SAME_TESTS
from thermodata.modelling.versions.with_claims import adds_what_was_offered
from thermodata.report.collected.collect import collect
from thermodata.report.collected.history import history_rows
from thermodata.report.page.error_rows import error_rows
from thermodata.report.page.headline import sentences
from thermodata.report.text.added import before_after_text
from thermodata.report.text.fit import history_text
from thermodata.report.words.numbers import pooled
from thermodata.schema.files.model import EffectSpec
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import save_diagnosis
from thermodata.store.catalogue.models.fits import find_model, model_chain
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.dataset import Dataset

from ..answers import candidate, diagnosis
from .conftest import EFFECTS, TRUTH, Spec, Stored


@pytest.fixture(scope="module")
def store(stored: Stored, world: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Store:
    return stored(world, tmp_path_factory.mktemp("campaign"))


def test_a_fit_is_kept_with_its_scores_and_contributions(store: Store, spec: Spec) -> None:
    result = run.fit(store, spec(*EFFECTS))
    for name, truth in TRUTH.items():
        assert result.parameters[name].value == pytest.approx(truth, rel=0.05), name
    assert find_model(store, result.model).result == result
    assert run.fit(store, spec(*EFFECTS)).model == result.model
    with store.reader() as con:
        rows = con.execute(
            "select test, count(*), avg(abs(residual)) from residual where model = ? and valid "
            "group by test order by test",
            [result.model],
        ).fetchall()
        roles = con.execute("select distinct role from score where model = ? order by 1", [result.model]).fetchall()
    assert [r[0] for r in rows] == [f"t{k}" for k in range(7)]
    assert all(n == 721 and error < 0.6 for _, n, error in rows)
    assert roles == [("calibration",), ("verification",)]
    again = run.load(store, result.model[:8])
    assert again.identity == result.model
    assert again.fitted.parameters()["coolant.tau"].value == pytest.approx(result.parameters["coolant.tau"].value)


def test_a_fit_tells_the_rows_of_a_prediction_file_that_have_no_value(store: Store, spec: Spec, tmp_path: Path) -> None:
    rows = [f"t{k},{t},{'nan' if t == 600 else t / 100}" for k in range(7) for t in range(0, 43201, 600)]
    (tmp_path / "theirs.csv").write_text("\n".join(["test,t_s,predicted", *rows]))
    result = run.fit(store, spec({"effect": "prediction", "file": "theirs.csv"}, name="theirs"), base=tmp_path)
    assert any(note.startswith("theirs.csv: 7 of 511 rows have no predicted value") for note in result.notes)


def test_a_fit_tells_the_tests_of_a_prediction_file_that_the_campaigns_lack(
    store: Store, spec: Spec, tmp_path: Path
) -> None:
    def notes(*strange: str) -> list[str]:
        names = [*(f"t{k}" for k in range(7)), *strange]
        rows = [f"{name},{t},{t / 100}" for name in names for t in range(0, 43201, 600)]
        (tmp_path / "theirs.csv").write_text("\n".join(["test,t_s,predicted", *rows]))
        model = spec({"effect": "prediction", "file": "theirs.csv"}, name="theirs")
        return [n for n in run.fit(store, model, base=tmp_path).notes if n.startswith("theirs.csv")]

    assert notes() == []
    assert notes("c/t10", "old") == [
        "theirs.csv: 'c/t10', 'old' are no tests with data of the model's campaigns, and nothing of it is used; "
        "did you mean 'c/t1'?"
    ]


def test_a_file_of_other_tests_is_told_with_the_tests_that_it_has(store: Store, spec: Spec, tmp_path: Path) -> None:
    (tmp_path / "theirs.csv").write_text("test,t_s,predicted\nDAY1,0,0\nDAY1,43200,5\n")
    model = spec({"effect": "prediction", "file": "theirs.csv"}, name="theirs")
    with pytest.raises(UsageError) as refused:
        run.fit(store, model, base=tmp_path)
    assert "c/t0: no driver for prediction: theirs.csv is of 'DAY1'" in str(refused.value)


def test_adding_the_missing_effect_makes_the_error_fall(store: Store, spec: Spec) -> None:
    parent = run.fit(store, spec(*(e for e in EFFECTS if e != "feed_screw"), name="short"))
    grown = add(store, "short", "feed_screw:T_nut")
    assert grown.parent == parent.model
    assert grown.before is not None
    before = {s.test: s.rmse_um for s in grown.before if s.phase == "all"}
    after = {s.test: s.rmse_um for s in grown.scores if s.phase == "all"}
    assert set(before) == set(after) == {f"t{k}" for k in range(7)}
    for test, value in after.items():
        old = before[test]
        assert value is not None
        assert old is not None
        assert value < 0.5 * old
    assert {s.role for s in grown.scores} == {"calibration", "verification (in-sample)"}
    with store.reader() as con:  # the question for errors of verification that the help shows has all versions
        (asked,) = re.findall(r'thermodata sql "(from score [^"]*)"', sql_command.help or "")
        found = con.execute(f"select model, count(*) from ({asked}) where phase = 'all' group by model").fetchall()
    assert {(parent.model, 2), (grown.model, 2)} <= set(found)
    assert [m.model for m in model_chain(store, grown.model)] == [parent.model, grown.model]
    # the newest version goes by the name
    assert find_model(store, "short").model == grown.model
    # the truth is single lags, and the store keeps what was said
    assert grown.added == ["feed_screw"]
    assert grown.notes[:1] == ["no second lag: none takes 20 % off the error on left-out tests"]
    assert find_model(store, grown.model).result == grown
    assert (parent.added, parent.notes) == (None, [])


def test_what_is_added_and_removed_again_is_fitted_as_before(store: Store, spec: Spec) -> None:
    parent = run.fit(store, spec("spindle_bearing", name="back"))
    grown = add(store, parent.model, "feed_screw:T_nut", plain=True)
    back = remove(store, grown.model, "feed_screw")
    assert (back.parameters, back.checks) == (parent.parameters, parent.checks)
    assert [(s.role, s.rmse_um) for s in back.scores] == [(s.role, s.rmse_um) for s in parent.scores]
    assert back.notes == [
        "removed: feed_screw",
        f"taken back: the effects, the tests and the fit are those of {parent.model} again",
    ]
    # a version of its own, which goes by the name
    assert back.model not in (parent.model, grown.model)
    assert find_model(store, "back").model == back.model
    rows = history_rows(store, "back")
    assert [(r["model"], r["in_sample"]) for r in rows] == [
        (parent.model, False),
        (grown.model, True),
        (back.model, False),
    ]
    assert collect(store, back.model).reason is None, "nothing was added last"
    # fitted again it stays where it is
    assert fit_named(store, back.model).model == back.model
    # what is left was chosen with the verification tests
    other = remove(store, grown.model, "spindle_bearing")
    assert {s.role for s in other.scores} == {"calibration", "verification (in-sample)"}
    assert other.notes[1:] == ["verification tests stay fitted (in-sample), for they helped to choose what is left"]


def test_versions_are_compared_over_the_tests_that_both_predict(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    lost = next(t.test for t in world.tests if t.role == "calibration")
    store = stored(world, tmp_path, without={lost: "T_nut"})
    parent = run.fit(store, spec("spindle_bearing", name="some"))
    grown = add(store, parent.model, "feed_screw:T_nut", plain=True)
    assert [(t.test, t.response, t.why) for t in grown.lost or []] == [(lost, "dZ", "no driver for feed_screw")]
    kept = [s for s in parent.scores if s.test != lost]
    before = pooled(kept, "calibration", responses=["dZ"])
    assert before != pytest.approx(pooled(parent.scores, "calibration", responses=["dZ"]), rel=0.01)
    n = len(world.tests) - sum(t.role in ("locked", "none") for t in world.tests)
    said = f"1 of {n} tests is lost, for this version does not predict it: c/{lost} (no driver for feed_screw)"
    # the command and the notebook
    text = before_after_text(grown)
    assert text.splitlines()[0].startswith(f"{said}; before and after are over the {n - 1} that both predict")
    left_out = "made without t9: the clock of nc is off in it"
    noted = before_after_text(grown.model_copy(update={"notes": ["read in steps", left_out, *grown.notes]}))
    assert noted.splitlines()[:2] == [left_out, ""]
    assert noted.endswith(text)
    names = [t.test for t in world.tests if t.role == "calibration" and t.test != lost]
    too = " and ".join(t.test for t in world.tests if t.role == "verification")
    counted = f"{', '.join(names[:-1])} and {names[-1]}"
    assert text.endswith(f"all of calibration: {counted}; fitted too by now, under verification: {too}")
    (row,) = (line.split() for line in text.splitlines() if line.split()[:3] == ["-", "all", "calibration"])
    assert float(row[3]) == pytest.approx(before, rel=0.01)
    # the versions: own errors keep their keys
    first, last = history_rows(store, grown.model)
    assert first["common"]["calibration_rmse_um"] == pytest.approx(before)
    assert first["calibration_rmse_um"] == pytest.approx(pooled(parent.scores, "calibration", responses=["dZ"]))
    assert (first["lost"], last["lost"], first["tests"], last["tests"]) == ([], [f"c/{lost}"], n, n - 1)
    assert history_text([first, last]).startswith(
        f"1 test lost with {grown.model}: c/{lost}; errors are over the {n - 1}"
    )
    # the report
    data = collect(store, grown.model)
    assert next(r for r in error_rows(data) if r.word == "fitted").before == pytest.approx(before)
    assert data.versions[0].calibration_um == pytest.approx(before)
    assert any(line.startswith(said) for line in sentences(data))


def test_what_is_removed_is_a_version_of_its_own_whatever_was_fitted_before(store: Store, spec: Spec) -> None:
    base = run.fit(store, spec("spindle_bearing", name="paths"))
    one = add(store, base.model, "feed_screw:T_nut", plain=True)
    both = add(store, one.model, "ambient_frame:T_hall", plain=True)
    other = add(store, base.model, "ambient_frame:T_hall", plain=True)
    removed = remove(store, both.model, "feed_screw")  # the effects of `other`, come to another way
    assert removed.parameters == other.parameters
    assert removed.model not in (other.model, base.model)
    assert find_model(store, "paths").model == removed.model
    assert [m.model for m in model_chain(store, removed.model)] == [m.model for m in (base, one, both, removed)]
    assert [m.model for m in model_chain(store, other.model)] == [base.model, other.model]
    # what is fitted, added or removed again is the same version, and its name leads past it
    said = f"this model was fitted before: {one.model} is its name, 'paths' is the newer version {removed.model}"
    assert add(store, base.model, "feed_screw:T_nut", plain=True).notes[1:] == [said]
    (alike,) = find_model(store, one.model).result.notes
    assert alike.startswith(SAME_TESTS)


def test_what_add_takes_in_besides_is_said_and_plain_leaves_it(store: Store, spec: Spec) -> None:
    # without its coolant the rest of this model is wrong in a way that a second lag of the speed's heat can use
    parent = run.fit(store, spec({"effect": "lag", "drivers": {"u": "speed"}}, name="speed"))
    grown = add(store, parent.model, "feed_screw:T_nut")
    assert grown.added == ["feed_screw", *(note.split()[0] for note in grown.notes if "is a second lag of" in note)]
    assert set(grown.added) == {k.split(".")[0] for k in grown.parameters} - {"lag"}
    plain = add(store, parent.model, "feed_screw:T_nut", plain=True)
    assert plain.added == ["feed_screw"]
    assert not [note for note in plain.notes if "second lag" in note]


def test_what_fitting_more_tests_does_is_told_apart_from_what_is_added(store: Store, spec: Spec) -> None:
    parent = run.fit(store, spec("spindle_bearing", name="alike"))
    grown = add(store, parent.model, "ambient_frame:T_hall", plain=True)
    further = add(store, grown.model, "feed_screw:T_nut", plain=True)
    # the same effects with the tests and roles of the version that has one more
    stored = find_model(store, grown.model).spec
    refit = run.fit(store, stored.model_copy(update={"effects": parent_effects(store, parent.model), "name": "refit"}))
    whole, was = (pooled(r.scores, responses=["dZ"]) for r in (refit, parent))
    there, was_there = (pooled(r.scores, "verification", responses=["dZ"]) for r in (refit, parent))
    said = (
        f"{SAME_TESTS} leaves {whole:.3g} um over its open tests instead of {was:.3g}, and {there:.3g} um in "
        f"verification instead of {was_there:.3g}: that much comes of fitting them, only the rest of what is added"
    )
    assert grown.notes == [said]
    assert said in " ".join(before_after_text(grown).split())
    assert not further.notes, "the version before was fitted to all of them"
    # kept with the version, for the pages
    versions = collect(store, further.model).versions
    assert [v.refitted for v in versions] == ["", said, ""]


def parent_effects(store: Store, model: str) -> list[EffectSpec]:
    return find_model(store, model).spec.effects


def test_a_candidate_goes_by_its_rank(store: Store, spec: Spec) -> None:
    parent = run.fit(store, spec("spindle_bearing", name="bare"))
    with pytest.raises(UsageError, match="no diagnosis"):
        add(store, parent.model, 1)
    save_diagnosis(store, parent.model, diagnosis(candidate("coolant:coolant_on", claimed=True), model=parent.model))
    with pytest.raises(UsageError, match="no candidate of rank 7"):
        add(store, parent.model, "7")
    with pytest.raises(UsageError, match="rank 1 is one of the diagnosis of dZ"):
        chosen_id(store, parent.model, "1", "dY")
    assert chosen_id(store, parent.model, "1", "dZ") == "coolant:coolant_on"
    assert chosen_id(store, parent.model, "coolant:coolant_on", "dY") == "coolant:coolant_on"
    assert "coolant.tau" in add(store, parent.model, "1").parameters
    direct = add(store, parent.model, EffectSpec(effect="ambient_frame"))
    assert "ambient_frame.gain" in direct.parameters
    several = add(store, parent.model, "1", "feed_screw:T_nut", EffectSpec(effect="ambient_frame"), plain=True)
    assert several.added == ["coolant", "feed_screw", "ambient_frame"]
    assert several.parent == parent.model
    with pytest.raises(UsageError, match="nothing is named to add"):
        add(store, parent.model)
    with pytest.raises(UsageError, match="'coolant:coolant_on' is named twice"):
        add(store, parent.model, 1, "coolant:coolant_on")


def test_the_locked_error_of_all_claims_is_told_of_a_version_with_all_of_them(store: Store, spec: Spec) -> None:
    parent = run.fit(store, spec("spindle_bearing", name="several"))
    locked = {"locked_rmse_um_before": 1.67, "locked_rmse_um_after": 0.53, "locked_rmse_um_fitted": 2.1}
    claims = [
        candidate(name, rank=k, claimed=True, **locked)
        for k, name in enumerate(("coolant:coolant_on", "feed_screw:T_nut"), start=1)
    ]
    version = run.load(store, parent.model).data.data_version
    found = diagnosis(*claims, model=parent.model, data_version=version)
    save_diagnosis(store, parent.model, found)
    assert add(store, parent.model, 1, plain=True).locked_rmse_um_after is None
    both = add(store, parent.model, 1, 2, plain=True)
    ((model,), _) = locked_errors(store, both.model)
    assert both.locked_rmse_um_before == 1.67
    assert both.locked_rmse_um_after == pytest.approx(model.rmse_um), "of the version itself, not what was foretold"
    assert both.locked_rmse_um_fitted == 2.1
    assert find_model(store, both.model).result.locked_rmse_um_after == both.locked_rmse_um_after, "pages read it"


def test_what_was_added_is_what_was_offered_by_effect_and_channels(store: Store, spec: Spec) -> None:
    """A second lag that came along is none of its own; the same effect by another channel is another one."""
    parent, data = spec("spindle_bearing"), run.load(store, run.fit(store, spec("spindle_bearing")).model).data
    found = diagnosis(candidate("lag:T_nut", refinement=True, p_value=None), verdict="refine")
    nut = with_candidate(parent, "lag:T_nut", data.channels)
    assert adds_what_was_offered(nut, data, parent, found)
    second = parent.effects[0].model_copy(update={"id": "again"})
    assert adds_what_was_offered(nut.model_copy(update={"effects": [*nut.effects, second]}), data, parent, found)
    assert not adds_what_was_offered(with_candidate(parent, "lag:T_hall", data.channels), data, parent, found)
    assert not adds_what_was_offered(with_candidate(nut, "lag:T_hall", data.channels), data, parent, found)
    assert not adds_what_was_offered(parent, data, parent, found), "nothing was added"


def test_models_are_compared_on_the_same_tests(store: Store, spec: Spec) -> None:
    a, b = run.fit(store, spec(*EFFECTS)), run.fit(store, spec("spindle_bearing", name="bare"))
    first, second = comparing.compare(store, [a.model, b.model])
    assert [s.test for s in first.scores] == [s.test for s in second.scores]
    assert first.scores[0].rmse_um is not None
    assert second.scores[0].rmse_um is not None
    assert first.scores[0].rmse_um < second.scores[0].rmse_um


def test_carrying_over(store: Store, spec: Spec) -> None:
    rows = comparing.transfer(store, run.fit(store, spec(*EFFECTS)).model)
    assert {r.machine for r in rows} == {"m1"}
    assert all(r.g == pytest.approx(1.0, abs=0.1) for r in rows)
    assert all(r.verdict == "portable" for r in rows)
    with store.reader() as con:
        assert con.execute("select count(distinct test) from portability").fetchone() == (7,)


def test_carrying_over_to_another_campaign_of_the_store(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    """The other machine, a quarter stronger, has the same channels; one of its tests is locked there."""
    few = replace(world, tests=world.tests[:3])
    made = stored(few, tmp_path)
    model = run.fit(made, spec(*EFFECTS)).model
    text = (tmp_path / "campaign.yaml").read_text()
    tests = "[{id: n0, kind: spectrum, role: calibration}, {id: n1, kind: spectrum, role: locked}]"
    for k in (0, 1):
        rows = (tmp_path / f"raw/t{k}.csv").read_text().splitlines()
        at = rows[0].split(";").index("dZ")
        cells = [row.split(";") for row in rows[1:]]
        zero = float(cells[0][at])
        for row in cells:
            row[at] = f"{zero + 1.25 * (float(row[at]) - zero):.6f}"
        (tmp_path / f"raw/n{k}.csv").write_text("\n".join([rows[0], *(";".join(row) for row in cells)]) + "\n")
    other = yaml.safe_load(text) | {
        "id": "d",
        "machine": {"id": "m2", "spindle": "SP1"},
        "tests": yaml.safe_load(tests),
    }
    (tmp_path / "other.yaml").write_text(yaml.safe_dump(other))
    ingest(made, tmp_path / "other.yaml")
    assert {r.campaign for r in comparing.transfer(made, model)} == {"c"}, "its own where nothing is asked"
    for asked in ({"campaigns": ["d"]}, {"tests": ["n0"]}, {"tests": ["d/n0"]}):
        [row] = comparing.transfer(made, model, **asked)
        assert (row.campaign, row.test, row.machine, row.role) == ("d", "n0", "m2", "calibration"), (
            "as its campaign has it"
        )
        assert row.g == pytest.approx(1.25, abs=0.05)
    assert [r.test for r in comparing.transfer(made, model, ["t0", "n0"])] == ["t0", "n0"]
    with pytest.raises(UsageError, match="locked: d/n1"):
        comparing.transfer(made, model, ["n1"])
    with pytest.raises(UsageError, match="no campaign 'e'"):
        comparing.transfer(made, model, campaigns=["e"])
    with pytest.raises(UsageError, match="no test 't0'"):
        comparing.transfer(made, model, ["t0"], campaigns=["d"])
    with made.reader() as con:
        assert con.execute("select distinct campaign from portability").fetchall() == [("c",)]


def test_carrying_over_to_a_locked_test_is_refused(store: Store, spec: Spec) -> None:
    model = run.fit(store, spec(*EFFECTS)).model
    for names in (["t7"], ["t0", "t7"]):
        with pytest.raises(UsageError, match=r"locked: c/t7; opened only to confirm") as caught:
            comparing.transfer(store, model, names)
        assert (caught.value.where, caught.value.got, caught.value.exit_code) == ("--test", "c/t7", 2)
    with store.reader() as con:
        assert con.execute("select count(*) from locked_look where model = ?", [model]).fetchone() == (0,)


@pytest.mark.parametrize("how", ["fit", "add", "remove"])
def test_what_is_made_while_an_ingest_changes_the_data_is_of_the_data_as_they_are_kept(
    stored: Stored, world: Dataset, tmp_path: Path, spec: Spec, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    store = stored(world, tmp_path)
    wished = spec("spindle_bearing", "ambient_frame", name="beside")
    parent = run.fit(store, wished).model
    alone, begun = run.fit_model, list[bool]()

    def beside(*args: Any, **more: Any) -> FittedModel:
        found = alone(*args, **more)
        if not begun:
            begun.append(True)
            path = tmp_path / "campaign.yaml"
            path.write_text(path.read_text().replace("unit: um", "unit: 1.02 um"))
            ingest(Store(store.path), path)
        return found

    monkeypatch.setattr(run, "fit_model", beside)
    made = {
        "fit": lambda: run.fit(store, wished),
        "add": lambda: add(store, parent, "coolant:coolant_on", plain=True),
        "remove": lambda: remove(store, parent, "ambient_frame"),
    }[how]()
    assert begun
    kept = find_model(store, made.model)
    assert not kept.stale
    assert kept.data_version == run.load_data(store, kept.spec).data_version
    before = {(s.test, s.phase): s.ptp_um for s in made.before or () if s.phase == "all"}
    after = {(s.test, s.phase): s.ptp_um for s in made.scores}
    assert all(before[test] == after[test] for test in before)  # measured in the same unit, before and after


def test_data_that_never_stand_still_are_said_and_nothing_of_them_is_kept(
    stored: Stored, world: Dataset, tmp_path: Path, spec: Spec, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = stored(world, tmp_path)
    alone = run.fit_model

    def beside(*args: Any, **more: Any) -> FittedModel:
        with store.write(views=False) as con:
            con.execute("update campaign set data_version = data_version || '-'")
        return alone(*args, **more)

    monkeypatch.setattr(run, "fit_model", beside)
    with pytest.raises(StoreError, match="the data of c changed meanwhile"):
        run.fit(store, spec("spindle_bearing", name="never"))
    with store.reader() as con:
        assert con.execute("select count(*) from model").fetchone() == (0,)
