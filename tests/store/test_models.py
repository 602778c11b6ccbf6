"""Models in the store: kept, found by what one types, gone stale, and what was found out about them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from tests.stored_fits import fit_of, score_of
from thermodata.errors import StoreError, UsageError
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Artefact, Diagnosis, WeakSpot
from thermodata.schema.answers.result import FitResult, Parameter
from thermodata.schema.files.model import Model
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import load_diagnosis, save_diagnosis, save_findings
from thermodata.store.catalogue.models.fits import find_model, model_chain, save_fit
from thermodata.store.catalogue.models.looks import count_locked_look, locked_looks, looks_of
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.forget import forget
from thermodata.store.keep.gc import gc
from thermodata.store.trace.lineage import trace

from .store_fakes import daq, write_log

SPEC: dict[str, Any] = {
    "schema": "thermodata/model/1",
    "name": "base",
    "campaign": "shop",
    "response": {"axis": "Z", "at": "tcp"},
    "step": "30 s",
    "effects": [{"effect": "lag"}],
}


def fit(
    model: str, name: str = "base", parent: str | None = None, tests: tuple[str, ...] = ("one", "two")
) -> FitResult:
    tau = Parameter(value=1800.0, unit="s", low=1700.0, high=None)
    scores = [score_of(t, model=model, campaign="shop", rmse_um=1.5) for t in tests]
    return fit_of(model, scores, name=name, parent=parent, parameters={"lag.tau": tau})


def save(
    store: Store, model: str, name: str = "base", parent: str | None = None, tests: tuple[str, ...] = ("one", "two")
) -> str:
    table = pa.table(
        {
            "t_s": [0.0, 30.0],
            "measured": [0.0, 1.0],
            "predicted": [0.0, 0.5],
            "residual": [0.0, 0.5],
            "valid": [True, True],
            "c__lag": [0.0, 0.5],
        }
    )
    return save_fit(
        store,
        spec=Model.model_validate(SPEC | {"name": name}),
        result=fit(model, name, parent, tests),
        parent=parent,
        predictions={("shop", t, "dZ"): table for t in tests},
        data_version="v",
    )


def test_a_fit_comes_back_as_it_was_saved(filled: Store) -> None:
    assert save(filled, "abc123") == "abc123"
    found = find_model(filled, "abc123")
    assert found.result == fit("abc123")
    assert found.spec == Model.model_validate(SPEC)
    assert (found.name, found.parent, found.stale) == ("base", None, False)
    with filled.reader() as con:
        assert con.execute(
            "select test, t_s, residual from residual where model = 'abc123' order by all"
        ).fetchall() == [("one", 0.0, 0.0), ("one", 30.0, 0.5), ("two", 0.0, 0.0), ("two", 30.0, 0.5)]
        assert con.execute("select parameter, value, unit, low, high from fit").fetchall() == [
            ("lag.tau", 1800.0, "s", 1700.0, None)
        ]
        assert con.execute("select count(*) from score where model = 'abc123'").fetchone() == (2,)


def test_saving_again_replaces_and_keeps_the_place_in_history(filled: Store) -> None:
    save(filled, "m1")
    save(filled, "m2", parent="m1")
    save(filled, "m1", tests=("one",))
    assert find_model(filled, "base").model == "m2"
    assert [s.test for s in find_model(filled, "m1").result.scores] == ["one"]
    with filled.reader() as con:
        assert con.execute("select count(*) from score_row where model = 'm1'").fetchone() == (1,)
    assert [m.model for m in model_chain(filled, "m2")] == ["m1", "m2"]


def test_a_model_is_found_by_id_prefix_or_name(filled: Store) -> None:
    save(filled, "abc111")
    save(filled, "abc222", "other")
    assert find_model(filled, "abc2").model == "abc222"
    assert find_model(filled, "other").model == "abc222"
    with pytest.raises(UsageError, match=r"abc111, abc222|abc222, abc111"):
        find_model(filled, "abc")
    with pytest.raises(UsageError, match="did you mean 'other'"):
        find_model(filled, "othr")
    with pytest.raises(UsageError):
        find_model(filled, "")


def test_an_edit_makes_only_the_fits_stale_that_used_the_test(filled: Store, campaign: Path) -> None:
    save(filled, "both")
    save(filled, "first", tests=("one",))
    text = campaign.read_text()
    campaign.write_text(text.replace("heating: [0 s, 600 s]", "heating: [0 s, 300 s]"))
    summary = ingest(filled, campaign)
    assert summary.stale == ["both"]
    assert (find_model(filled, "both").stale, find_model(filled, "first").stale) == (True, False)
    campaign.write_text(text.replace("spindle, role: verification", "spindle, notes: hm, role: verification"))
    save(filled, "both")
    ingest(filled, campaign)
    assert find_model(filled, "both").stale  # the phases changed back
    campaign.write_text(campaign.read_text().replace("notes: hm", "notes: well"))
    save(filled, "both")
    assert ingest(filled, campaign).stale == []  # words only


DIAGNOSIS = Diagnosis(
    model="m1",
    response="dZ",
    verdict="effect",
    noise_um=0.2,
    rmse_um=1.5,
    explainable=0.9,
    next_test=None,
    weak_spots=[WeakSpot(campaign="shop", test="one", from_s=0.0, to_s=600.0, rmse_um=2.0, state="heating")],
    candidates=[
        Candidate(
            rank=1,
            id="lag:T_a",
            effect="lag",
            family="generic",
            drivers=["T_a"],
            claimed=True,
            p_value=0.001,
            rmse_um_before=1.5,
            rmse_um_after=0.4,
            fit_before=50.0,
            fit_after=90.0,
            locked_rmse_um_fitted=2.4,
            locked_rmse_um_before=1.6,
            locked_rmse_um_after=0.5,
        )
    ],
    artefacts=[Artefact(kind="step", campaign="shop", test="two", at_s=30.0, size_um=5.0, why="a slip")],
)


def test_a_diagnosis_is_kept_whole_and_in_rows(filled: Store) -> None:
    assert load_diagnosis(filled, "m1") is None
    save(filled, "m1")
    for _ in range(2):
        save_diagnosis(filled, "m1", DIAGNOSIS)
    assert load_diagnosis(filled, "m1") == DIAGNOSIS
    with filled.reader() as con:
        assert con.execute("select kind, count(*) from finding group by 1 order by 1").fetchall() == [
            ("artefact", 1),
            ("candidate", 1),
            ("diagnosis", 1),
            ("weak_spot", 1),
        ]
        assert con.execute("select test, from_s, state from weak_spot").fetchall() == [("one", 0.0, "heating")]
        assert con.execute("select effect, drivers, claimed from candidate").fetchall() == [("lag", ["T_a"], True)]
        locked = ", ".join(f"locked_rmse_um_{when}" for when in ("fitted", "before", "after"))
        assert con.execute(f"select {locked} from candidate").fetchall() == [(2.4, 1.6, 0.5)]
    save(filled, "m2")  # of several responses each is diagnosed by itself, in a model of its own or anew
    save_diagnosis(filled, "m2", DIAGNOSIS.model_copy(update={"response": "dX"}))
    with filled.reader() as con:
        for view in ("weak_spot", "candidate", "artefact"):
            assert con.execute(f"select model, response from {view} order by all").fetchall() == [
                ("m1", "dZ"),
                ("m2", "dX"),
            ]
            added = ["response"]
            if view == "candidate":
                added += ["campaigns", "stale", "locked_rmse_um_fitted"]
            columns = con.sql(f"select * from {view}").columns
            assert columns[-len(added) :] == added, "what stood before keeps its place"
    save_findings(filled, "m1", "portability", [("shop", "one", {"rmse_um": 3.0, "machine": "139"})])
    with filled.reader() as con:
        assert con.execute("select test, payload->>'$.machine' from finding where kind = 'portability'").fetchall() == [
            ("one", "139")
        ]
    with pytest.raises(StoreError, match="m9"):
        save_diagnosis(filled, "m9", DIAGNOSIS)


def test_the_views_say_what_is_of_data_that_changed(filled: Store, campaign: Path) -> None:
    save(filled, "m1")
    save(filled, "first", tests=("one",))
    save_diagnosis(filled, "m1", DIAGNOSIS)
    text = campaign.read_text()
    for now, stale in ((text.replace("heating: [0 s, 600 s]", "heating: [0 s, 300 s]"), True), (text, False)):
        campaign.write_text(now)
        ingest(filled, campaign)
        with filled.reader() as con:
            assert con.execute("select distinct stale from candidate").fetchall() == [(stale,)]
            for view in ("score", "residual"):
                found = con.execute(f"select distinct model, stale from {view} order by 1").fetchall()
                assert found == [("first", False), ("m1", stale)]


def test_looks_at_locked_tests_are_counted(filled: Store) -> None:
    for _ in range(2):
        count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    assert (locked_looks(filled, "shop", "two"), locked_looks(filled, "shop", "one")) == (2, 0)


def test_looks_count_on_under_another_id_of_the_campaign(filled: Store, campaign: Path) -> None:
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    campaign.write_text(campaign.read_text().replace("id: shop", "id: store"))
    ingest(filled, campaign)
    assert [locked_looks(filled, "store", test) for test in ("one", "two")] == [0, 1]
    forget(filled, "shop")
    ingest(filled, campaign)
    assert locked_looks(filled, "store", "two") == 1


def test_models_that_span_other_campaigns_go_with_one_only_where_that_is_said(filled: Store) -> None:
    save(filled, "m1")
    with filled.write() as con:
        con.execute("update model set campaigns = ['shop', 'other'] where model = 'm1'")
    with pytest.raises(UsageError, match=r"m1 \(of other too\)"):
        forget(filled, "shop")
    assert find_model(filled, "m1").model == "m1"
    assert locked_looks(filled, "shop", "two") == 0
    assert forget(filled, "shop", models=True)["models"] == ["m1"]


@pytest.mark.parametrize("test", [None, "two"])
def test_looks_at_data_that_come_back_count_on(filled: Store, campaign: Path, test: str | None) -> None:
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    for looks in (1, 2):
        assert forget(filled, "shop", test)["looks"] == looks
        ingest(filled, campaign)
        assert locked_looks(filled, "shop", "two") == looks, "nobody has forgotten what he saw"
        count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    text = campaign.read_text()
    line = next(one for one in text.splitlines(keepends=True) if "id: two" in one)
    for now in (text.replace(line, ""), text):  # taken out of the campaign file, and back
        campaign.write_text(now)
        ingest(filled, campaign)
    assert locked_looks(filled, "shop", "two") == 3
    with filled.reader() as con:
        assert con.execute("select count(*) from finding where kind = 'forgotten'").fetchone() == (0,)


def test_looks_do_not_count_for_other_data_of_the_same_name(filled: Store, campaign: Path) -> None:
    count_locked_look(filled, "m1", [("shop", "one"), ("shop", "two")], "claim of lag:T_a")
    assert forget(filled, "shop")["looks"] == 2
    two = campaign.parent / "raw" / "two_a.npz"
    was = two.read_bytes()
    write_log(two, daq(seed=9))
    ingest(filled, campaign)
    assert [locked_looks(filled, "shop", test) for test in ("one", "two")] == [1, 0]
    # a detour over other data resets none
    count_locked_look(filled, "m2", [("shop", "two")], "claim of lag:T_b")
    forget(filled, "shop")
    two.write_bytes(was)
    ingest(filled, campaign)
    assert [locked_looks(filled, "shop", test) for test in ("one", "two")] == [1, 1]
    assert [look.model for look in looks_of(filled, ["shop"])["shop", "two"]] == ["m1"]


def test_looks_at_data_that_others_replaced_count_on(filled: Store, campaign: Path) -> None:
    """In place, and forgotten then."""
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    two = campaign.parent / "raw" / "two_a.npz"
    was = two.read_bytes()
    write_log(two, daq(seed=9))
    others = two.read_bytes()
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "two") == 1, "they may be the same but for a byte"
    count_locked_look(filled, "m2", [("shop", "two")], "claim of lag:T_b")
    forget(filled, "shop")
    two.write_bytes(was)
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "two") == 1
    two.write_bytes(others)
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "two") == 2


def test_looks_at_data_that_are_written_back_over_others_count_on(filled: Store, campaign: Path) -> None:
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    forget(filled, "shop")
    two = campaign.parent / "raw" / "two_a.npz"
    was = two.read_bytes()
    write_log(two, daq(seed=9))
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "two") == 0
    two.write_bytes(was)
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "two") == 1


def test_looks_go_with_the_data_of_tests_that_change_places(filled: Store, campaign: Path) -> None:
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    raw = campaign.parent / "raw"
    looked = {log: log.read_bytes() for log in sorted(raw.iterdir()) if log.name.startswith(("one", "two"))}
    for log in looked:
        log.unlink()
    for log, data in looked.items():
        test = log.name[:3]
        log.with_name({"one": "two", "two": "one"}[test] + log.name[3:]).write_bytes(data)
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "one") == 1


def test_looks_count_on_where_the_data_come_under_another_name(filled: Store, campaign: Path) -> None:
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    text = campaign.read_text()
    for log in (campaign.parent / "raw").glob("two*"):
        log.rename(log.with_name(log.name.replace("two", "late")))
    campaign.write_text(text.replace("id: two", "id: late"))
    ingest(filled, campaign)
    assert locked_looks(filled, "shop", "late") == 1


def test_what_was_said_of_a_test_that_is_taken_out_stays_and_is_there_when_it_is_back(
    filled: Store, campaign: Path
) -> None:
    save(filled, "m1")
    count_locked_look(filled, "m1", [("shop", "two")], "claim of lag:T_a")
    text = campaign.read_text()

    def known() -> tuple[Any, ...]:
        with filled.reader() as con:
            score, residual = (
                con.execute(f"select * exclude (stale) from {view} order by all").fetchall()
                for view in ("score", "residual")
            )
        return score, residual, locked_looks(filled, "shop", "two")

    before = known()
    assert ({row[1] for row in before[0]}, before[2]) == ({"one", "two"}, 1)
    campaign.write_text("\n".join(line for line in text.splitlines() if "id: two" not in line))
    notes = ingest(filled, campaign).notes
    assert [n for n in notes if "two" in n and not n.startswith("in no test")] == [
        "no longer in the campaign file: two; its logs are out of the store, and what models said of it stays in their "
        "results, for when it is back"
    ]
    assert known() == before
    assert not any("no longer" in n for n in ingest(filled, campaign).notes), "it is said once"
    campaign.write_text(text)
    assert not any("no longer" in n for n in ingest(filled, campaign).notes)
    assert known() == before


def test_what_is_forgotten_is_gone_from_the_results_too(filled: Store) -> None:
    save(filled, "m1")
    save(filled, "m2")
    forget(filled, "shop", "two")
    with filled.reader() as con:
        assert con.execute("select distinct test from score").fetchall() == [("one",)]
        assert con.execute("select model from model order by rowid").fetchall() == [("m1",), ("m2",)]
    assert [s.test for s in find_model(filled, "m1").result.scores] == ["one"]


def test_forgetting_takes_what_was_fitted(filled: Store) -> None:
    save(filled, "m1")
    save_diagnosis(filled, "m1", DIAGNOSIS)
    assert forget(filled, "shop", "two")["stale"] == ["m1"]
    with filled.reader() as con:
        assert con.execute("select distinct test from residual").fetchall() == [("one",)]
    assert trace(filled, "m1")["files"][0]["source_path"] == "raw/one_a.npz"
    assert forget(filled, "shop")["models"] == ["m1"]
    with pytest.raises(UsageError):
        find_model(filled, "m1")
    gc(filled, grace_s=0)
    assert list((filled.path / "model").iterdir()) == []
