"""Every command on a small real store: raw CSV to the added effect."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

import thermodata

from ..commands import Say
from ..keys import DIAGNOSIS, FIT, SCORE
from .conftest import TESTS, lag, write_campaign


@pytest.fixture
def data(ask: Say) -> Callable[..., Any]:
    def run(*words: object) -> Any:
        return json.loads(ask(*words, "--json").out)

    return run


def test_ingest_again_changes_nothing(data: Callable[..., Any], campaign: Path) -> None:
    summary = data("ingest", campaign / "campaign.yaml")
    assert summary["changed"] is False
    assert (summary["tests"], summary["files"], summary["losses"]) == (4, 4, [])


def test_a_draft_of_real_files_ingests_as_it_is(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "c")
    path.unlink()
    (tmp_path / "c" / "notes.txt").write_text("nothing that a reader knows")
    made = json.loads(say("init", tmp_path / "c", "--json").out)
    assert made["files"] == 4
    assert [i["file"] for i in made["ignored"]] == ["notes.txt"]
    again = say("init", tmp_path / "c")
    assert (again.code, "--force" in again.err) == (2, True)
    said = say("--store", tmp_path / "s", "ingest", path, "--json")
    assert said.code == 0, said.err
    assert json.loads(said.out)["tests"] == 4


def test_sniff_and_preview(say: Say, tmp_path: Path) -> None:
    write_campaign(tmp_path / "c")
    log, other = tmp_path / "c" / "raw" / "day1.csv", tmp_path / "c" / "baseline.yaml"
    assert json.loads(say("sniff", log, "--json").out)[0]["reader"] == "table"
    assert say("sniff", log, other).code == 2
    found = json.loads(say("preview", log, "--rows", 2, "--json").out)
    assert {s["signal"] for s in found["signals"]} >= {"dZ [um]", "T_nut_Z [degC]"}
    assert [len(rows) for rows in found["first_rows"].values()] == [2]
    assert "T_nut_Z" in say("preview", log).out
    assert "no reader 'tabel'" in say("preview", log, "--reader", "tabel").err


def test_a_broken_file_is_a_loss_and_code_3(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "c")
    (tmp_path / "c" / "raw" / "heat2.csv").write_bytes(b"\x00\x01\x02 not a table")
    said = say("--store", tmp_path / "s", "ingest", path, "--json")
    assert said.code == 3
    assert any("heat2" in json.dumps(loss) for loss in json.loads(said.out)["losses"])


def test_looking(ask: Say, data: Callable[..., Any]) -> None:
    assert {row["test"]: row["role"] for row in data("tests")} == TESTS
    assert {row["channel"]: row["unit"] for row in data("channels")}["T_nut_Z"] == "degC"
    assert data("calibrations")[0]["sign"] == "+"
    assert isinstance(data("quality"), list)
    assert "speed 9000 rpm" in ask("tests").out
    assert "axis.z.nut" in ask("channels", "--test", "day1").out
    assert "raw/day1.csv" in ask("trace", "small", "day1", "dZ").out


def test_an_unknown_campaign_or_test_names_the_known_ones(say: Say, campaign: Path) -> None:
    store = campaign / "thermodata.store"
    said = say("--store", store, "tests", "-c", "smal")
    assert said.code == 2
    assert "did you mean 'small'?" in said.err
    said = say("--store", store, "channels", "-t", "day7")
    assert said.code == 2
    assert "day1" in said.err


def test_sql_gives_clean_csv_and_typed_json(ask: Say, data: Callable[..., Any]) -> None:
    query = "select test, t_s, value, t from sample where channel = 'T_nut_Z' order by test, t_s"
    rows = list(csv.reader(io.StringIO(ask("sql", query, "--csv").out)))
    assert rows[0] == ["test", "t_s", "value", "t"]
    assert len(rows) == 1 + 4 * 360
    assert (rows[1][0], float(rows[2][1])) == ("day1", 60.0)
    assert data("sql", "select 1.5::decimal(4, 2) as a, null as b, [1, 2] as c") == [{"a": 1.5, "b": None, "c": [1, 2]}]
    assert data("sql", "select 1 where false") == []
    assert ask("sql", "select 1 as a, 'x' as a").out.splitlines()[0].split() == ["a", "a"]


def test_a_long_table_is_cut_and_says_so(ask: Say) -> None:
    said = ask("sql", "from sample", "--rows", 3)
    assert len(said.out.splitlines()) == 5
    assert "--csv" in said.err


def test_wrong_sql_is_a_usage_error(say: Say, campaign: Path) -> None:
    said = say("--store", campaign / "thermodata.store", "sql", "selec 1")
    assert said.code == 2
    assert "selec" in said.err


def test_export_writes_a_uniform_grid(data: Callable[..., Any], say: Say, campaign: Path, tmp_path: Path) -> None:
    found = data("export", "small", "day1", tmp_path / "d.parquet", "--step", "5 min")
    table = pq.read_table(tmp_path / "d.parquet")
    assert table.num_rows == found["rows"] == 72
    assert json.loads(table.schema.metadata[b"thermodata.units"])["dZ"] == "um"
    data("export", "small", "day1", tmp_path / "d.csv")
    assert "dZ [um]" in (tmp_path / "d.csv").read_text().splitlines()[0]
    again = say("--store", campaign / "thermodata.store", "export", "small", "day1", tmp_path / "d.csv")
    assert (again.code, "--force" in again.err) == (2, True)
    assert [p.name for p in tmp_path.iterdir() if p.name.endswith(".part")] == []
    wrong = say("--store", campaign / "thermodata.store", "export", "small", "day9", tmp_path / "e.csv")
    assert (wrong.code, "did you mean 'day" in wrong.err) == (2, True)
    assert data("export", "small", "day1", tmp_path / "e.mat", "--step", "5 min")["rows"] == 72
    nameless = say("--store", campaign / "thermodata.store", "export", "small", "day1", tmp_path / "e.xyz")
    assert (nameless.code, ".mf4" in nameless.err) == (2, True)


def test_fit_add_and_history(data: Callable[..., Any], ask: Say, campaign: Path) -> None:
    base = data("fit", campaign / "baseline.yaml")
    assert set(base) == FIT
    assert set(base["scores"][0]) == SCORE
    assert base["before"] is None
    assert {s["test"] for s in base["scores"]} == {"heat1", "heat2", "day1"}, "locked tests stay closed"

    better = data("add", base["model"], "feed_screw:T_nut_Z")
    assert set(better) == FIT | {"stale"}
    assert better["parent"] == base["model"]
    assert [s["model"] for s in better["before"]] == [base["model"]] * len(better["before"])

    def rmse(rows: list[dict[str, Any]]) -> float:
        return float(max(s["rmse_um"] for s in rows if s["phase"] == "all"))

    assert rmse(better["before"]) > 2.0
    assert rmse(better["scores"]) < 0.5, "what is left is the 0.3 um of noise"

    chain = data("history", better["model"])
    assert [v["added"] for v in chain] == [None, "feed_screw"]
    both = data("compare", base["model"], better["model"])
    assert {s["model"] for s in both["scores"]} == {base["model"], better["model"]}
    assert [m["model"] for m in both["models"]] == [base["model"], better["model"]]
    shares = data("compare", base["model"], better["model"], "--contributions", "heat1")
    nut = {row["model"]: row for row in shares if row["effect"] == "feed_screw"}
    assert nut[base["model"]]["largest"] is None
    assert nut[better["model"]]["differs"]
    gives = nut[better["model"]]["difference"]
    assert gives["low"] < gives["value"] < gives["high"]
    # the truth of heat1: 3 um/K on the nut, lagged by 45 min
    rows = np.loadtxt(campaign / "raw" / "heat1.csv", delimiter=",", skiprows=1)
    truth = float((3.0 * lag(rows[:, 3] - 21, 2700.0)).max())
    assert gives["value"] == pytest.approx(truth, rel=0.05)
    told = ask("compare", base["model"], better["model"], "--contributions", "heat1").out
    assert "not in it" in told
    assert "what each effect gives to dZ in heat1" in told
    by_prefix = [m["model"][:8] for m in (base, better)]
    assert ask("compare", *by_prefix, "--contributions", "heat1").out == told
    # a name is the newest version of it
    assert data("compare", base["model"], "baseline", "--contributions", "heat1") == shares
    for words in (
        ["compare", base["model"]],
        ["compare", base["model"], better["model"]],
        ["history", better["model"]],
        ["fit", campaign / "baseline.yaml"],
        ["portability", base["model"]],
    ):
        assert "RMSE" in ask(*words).out or "class" in ask(*words).out


def test_a_model_of_the_store_is_an_effect_of_another(data: Callable[..., Any], campaign: Path) -> None:
    base = data("fit", campaign / "baseline.yaml")
    head = (campaign / "baseline.yaml").read_text(encoding="utf-8").split("effects:")[0]
    path = campaign / "twice.yaml"
    nut = "{effect: feed_screw, drivers: {temperature: T_nut_Z}}"
    path.write_text(
        head.replace("baseline", "twice") + f"effects: [{{effect: model, name: baseline, gain: K}}, {nut}]\n"
    )
    twice = data("fit", path)
    assert 0.5 < twice["parameters"]["model.K"]["value"] < 1.5
    again = data("compare", twice["model"])
    assert again["parameters"]["model.K"]["value"] == pytest.approx(twice["parameters"]["model.K"]["value"])
    path.write_text(path.read_text().replace("name: baseline", f"name: {base['model']}"))
    by_id = data("fit", path)
    assert 0.5 < by_id["parameters"]["model.K"]["value"] < 1.5
    assert by_id["model"] != twice["model"]
    path.write_text(path.read_text().replace(base["model"], "baseline.yaml").replace("gain: K", "gain: 1.5"))
    assert data("fit", path)["parameters"]["model.gain"]["value"] == 1.5


def test_orders_are_shown_with_what_they_foretell(
    data: Callable[..., Any], ask: Say, say: Say, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "160")  # headings in one line
    model = (campaign / "baseline.yaml").read_text(encoding="utf-8").split("effects:")[0]
    path = campaign / "function.yaml"
    path.write_text(model + "effects: [{effect: transfer_function, drivers: {u: T_bearing}, orders: [1, 1]}]\n")
    rows = data("orders", path)
    assert sum(row["chosen"] for row in rows) == 1
    assert {"effect", "numerator", "denominator", "fit_left_out", "fit_worst", "fit_calibration", "why"} <= set(rows[0])
    assert len(data("orders", path, "--method", "oe")) == 16
    said = ask("orders", path).out
    assert "FIT left out [%]" in said
    assert "<-" in said
    found = say("--store", campaign / "thermodata.store", "orders", campaign / "baseline.yaml")
    assert found.code == 2
    assert "no transfer function" in found.err


def test_profiles_are_shown_beside_the_quadratic_intervals(data: Callable[..., Any], ask: Say, campaign: Path) -> None:
    base = data("fit", campaign / "baseline.yaml")
    found = data("profiles", base["model"])
    by_name = {row["parameter"]: row for row in found["parameters"]}
    assert "spindle_bearing.tau" in by_name
    row = by_name["spindle_bearing.tau"]
    assert row["low"] < row["value"] < row["high"]
    assert min(row["curve"], key=lambda point: point[1])[0] == pytest.approx(row["value"], rel=0.2)
    assert base["parameters"]["spindle_bearing.tau"]["low"] == pytest.approx(row["profile_low"], rel=0.02)
    said = ask("profiles", base["model"], "--curves").out
    assert "95 % by profile" in said
    assert "RMS left" in said


def test_a_report_of_a_version_tells_what_it_changed(say: Say, tmp_path: Path) -> None:
    """In a store of its own: in another one somebody may have asked what the model misses."""
    path, store = write_campaign(tmp_path / "c"), tmp_path / "s"
    assert say("--store", store, "ingest", path).code == 0

    def data(*words: object) -> Any:
        return json.loads(say("--store", store, *words, "--json").out)

    base = data("fit", tmp_path / "c" / "baseline.yaml")
    better = data("add", base["model"], "feed_screw:T_nut_Z")
    assert set(better) == FIT | {"stale"}
    found = data("report", better["model"], "-o", tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert found["bytes"] == len(page.encode())
    assert "was added to baseline, and no diagnosis claims it" in page
    assert re.search(r"The error on \w+ tests(, which are fitted too by now,)? falls: ", page)
    assert 'id="test2"' in page
    assert "How it got here" in page
    assert "none was opened" in page


def test_a_snapshot_needs_nothing_beside_it(ask: Say, tmp_path: Path) -> None:
    ask("snapshot", tmp_path / "s.duckdb")
    assert (tmp_path / "s.duckdb").stat().st_size > 100_000


def test_forget_then_gc(say: Say, own: Path) -> None:
    store = own / "thermodata.store"
    assert say("--store", store, "forget", "small", "day2", "--json").code == 0
    assert {r["test"] for r in json.loads(say("--store", store, "tests", "--json").out)} == set(TESTS) - {"day2"}
    assert json.loads(say("--store", store, "gc", "--grace", "0 s", "--json").out)["removed"] > 0
    assert say("--store", store, "forget", "small", "day2").code == 2
    assert (own / "raw" / "day2.csv").exists()


def test_diagnose_add_by_rank_and_report(say: Say, own: Path, tmp_path: Path) -> None:
    store = own / "thermodata.store"
    base = json.loads(say("--store", store, "history", "baseline", "--json").out)[0]["model"]
    found = json.loads(say("--store", store, "diagnose", base, "--json").out)
    assert set(found) == DIAGNOSIS
    assert found["verdict"] == "effect"
    first = found["candidates"][0]
    assert (first["effect"], first["claimed"]) == ("feed_screw", True)
    assert first["locked_rmse_um_after"] < 0.5 * first["locked_rmse_um_before"]
    text = say("--store", store, "diagnose", base).out
    assert text.startswith("missing: feed_screw (T_nut_Z)")
    assert "where the model" in text

    better = json.loads(say("--store", store, "add", base, "1", "--json").out)
    assert better["parent"] == base
    assert say("--store", store, "add", base, "99").code == 2
    back = say("--store", store, "remove", better["model"], "feed_screw", "--json")
    taken = json.loads(back.out)
    assert taken["notes"][0] == "removed: feed_screw"
    assert taken["notes"][1].startswith("taken back: ")
    assert (taken["parent"], taken["before"]) == (better["model"], better["scores"])
    chain = json.loads(say("--store", store, "history", taken["model"], "--json").out)
    assert [(v["added"], v["removed"]) for v in chain] == [(None, None), ("feed_screw", None), (None, "feed_screw")]
    start = json.loads(say("--store", store, "compare", base, "--json").out)
    assert [s["rmse_um"] for s in taken["scores"]] == pytest.approx([s["rmse_um"] for s in start["scores"]])
    wrong = say("--store", store, "remove", better["model"], "feed_srew")
    assert (wrong.code, "the model has no effect 'feed_srew'" in wrong.err) == (2, True)
    assert say("--store", store, "report", better["model"], "-o", tmp_path / "r.html").code == 0
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "Why feed_screw was added" in page
    assert "Locked tests were opened, for whichever model of the store: small/day2" in page
    assert say("--store", store, "report", base, "-o", tmp_path / "b.html").code == 0
    assert "dZ misses feed_screw (T_nut_Z)" in (tmp_path / "b.html").read_text(encoding="utf-8")


def test_responses_in_several_units_are_told_each_in_its_own(say: Say, tmp_path: Path) -> None:
    path, store = write_campaign(tmp_path / "c"), tmp_path / "s"
    ingested = say("--store", store, "ingest", path)
    model = tmp_path / "c" / "two.yaml"
    assert ingested.err.splitlines()[-1].startswith(f"next: thermodata first-model {path} drafts ")
    one = (tmp_path / "c" / "baseline.yaml").read_text()
    model.write_text(one.replace("{axis: Z, at: tcp}", "[{axis: Z, at: tcp}, {channel: T_nut_Z}]"))
    said = say("--store", store, "fit", model)
    assert "next:" not in say("--store", store, "ingest", path).err
    assert "[um]" not in said.out.replace("dZ [um]", "")
    assert "[*] in the unit of the row's response: dZ [um], T_nut_Z [K]" in said.out
    base = said.out.split()[1]

    assert say("--store", store, "add", base, "lag:spindle_speed", "--plain").code == 0
    told = json.loads(say("--store", store, "history", "baseline", "--json").out)
    for version in told:
        scores = json.loads(say("--store", store, "compare", version["model"], "--json").out)["scores"]
        for each in version["responses"]:
            of = [s for s in scores if (s["response"], s["phase"]) == (each["response"], "all")]
            assert each["rmse_um"] == pytest.approx(rmse(of))
            assert each["calibration_rmse_um"] == pytest.approx(rmse([s for s in of if s["role"] == "calibration"]))
        # micrometres stay micrometres: kelvins have no part in them
        assert [(e["response"], e["unit"]) for e in version["responses"]] == [("dZ", "um"), ("T_nut_Z", "K")]
        assert (version["rmse_um"], version["unit"]) == (version["responses"][0]["rmse_um"], "um")
    lines = [line.split() for line in say("--store", store, "history", "baseline").out.splitlines()]
    assert {(n, u) for n in ("dZ", "T_nut_Z") for u in ("um", "K") for words in lines if {n, u} <= set(words)} == {
        ("dZ", "um"),
        ("T_nut_Z", "K"),
    }
    (newest, _) = thermodata.open(store).models()
    assert (newest["unit"], newest["calibration_um"]) == ("um", pytest.approx(told[-1]["calibration_rmse_um"]))


def rmse(scores: list[dict[str, Any]]) -> float:
    return float(np.sqrt(np.average([s["rmse_um"] ** 2 for s in scores], weights=[s["n"] for s in scores])))


def test_answers_to_a_model_of_other_data_say_so(say: Say, own: Path) -> None:
    path, store = own / "campaign.yaml", own / "thermodata.store"
    base = json.loads(say("--store", store, "history", "baseline", "--json").out)[0]["model"]
    path.write_text(path.read_text().replace("kind: mixed", "kind: spectrum"))
    assert say("--store", store, "ingest", path).code == 0
    for words in (["diagnose", base], ["confirm", base, "lag:T_hall"], ["add", base, "lag:T_hall", "--plain"]):
        found = json.loads(say("--store", store, *words, "--json").out)
        assert str(found["stale"]).startswith(f"stale: the data of baseline {base} changed"), words


def test_the_same_question_opens_no_lock_again_and_a_choice_of_ones_own_is_counted(say: Say, own: Path) -> None:
    store = own / "thermodata.store"
    base = json.loads(say("--store", store, "history", "baseline", "--json").out)[0]["model"]

    def looks() -> int:
        query = "select count(*) as n from locked_look where test = 'day2'"
        return int(json.loads(say("--store", store, "sql", query, "--json").out)[0]["n"])

    first = say("--store", store, "diagnose", base, "--json")
    assert looks() == 1
    again = say("--store", store, "diagnose", base, "--json")
    assert (again.out, looks()) == (first.out, 1)
    assert "from the store" in again.err
    assert "from the store" not in first.err

    chosen = json.loads(say("--store", store, "confirm", base, "feed_screw:T_nut_Z", "--json").out)
    assert (chosen["candidate"], chosen["holds"], chosen["looks"]) == ("feed_screw:T_nut_Z", True, 1)
    assert (chosen["holds_by_shape"], chosen["tests"][0]["n"]) == (True, 360)
    assert chosen["why"] == "about each test's mean the error falls by what a cause of its size takes away"
    assert chosen["locked_rmse_um_after"] < 0.5 * chosen["locked_rmse_um_before"]
    assert [t["test"] for t in chosen["tests"]] == ["day2"]
    assert chosen["tests"][0]["rmse_um_after"] == pytest.approx(chosen["locked_rmse_um_after"])
    text = say("--store", store, "confirm", base, "1")
    assert "feed_screw:T_nut_Z holds on the locked tests" in text.out
    assert "opened once so far" in text.out
    assert "from the store" in text.err
    assert looks() == 1, "the diagnosis opened it for that already"
    other = json.loads(say("--store", store, "confirm", base, "lag:T_hall", "--json").out)
    assert (other["looks"], looks()) == (2, 2)
    again = json.loads(say("--store", store, "confirm", base, "1", "--json").out)
    assert (again["looks"], looks()) == (2, 2), "from the store, and how often by now"
    assert say("--store", store, "confirm", base, "99").code == 2
    better = json.loads(say("--store", store, "add", base, "1", "--json").out)["model"]
    had = say("--store", store, "confirm", better, "feed_screw:T_nut_Z")
    assert (had.code, looks()) == (2, 2), "what the model has is not asked again"
    assert "the model has feed_screw (T_nut_Z) already" in had.err


def test_what_diagnose_puts_right_confirm_and_add_put_right_too(say: Say, tmp_path: Path) -> None:
    """A probe that is turned in one test would spoil the fit of both."""
    path, store = write_campaign(tmp_path / "c"), tmp_path / "s"
    turned = next(iter(TESTS))
    log = tmp_path / "c" / "raw" / f"{turned}.csv"
    head, rows = log.read_text().splitlines()[0], np.loadtxt(log, delimiter=",", skiprows=1)
    rows[:, 1] *= -1
    np.savetxt(log, rows, fmt="%.4f", delimiter=",", header=head, comments="")
    assert say("--store", store, "ingest", path).code == 0
    base = json.loads(say("--store", store, "fit", tmp_path / "c" / "baseline.yaml", "--json").out)["model"]
    found = json.loads(say("--store", store, "diagnose", base, "--json").out)
    assert [test for _, test in found["put_right"]["left_out"]] == [turned]
    claimed = next(c for c in found["candidates"] if c["claimed"])
    assert claimed["effect"] == "feed_screw"

    held = json.loads(say("--store", store, "confirm", base, claimed["id"], "--json").out)
    assert (held["holds"], held["put_right"]) == (True, found["put_right"])
    assert held["locked_rmse_um_after"] == pytest.approx(claimed["locked_rmse_um_after"])
    assert f"judged without {turned}" in say("--store", store, "confirm", base, claimed["id"]).out

    better = json.loads(say("--store", store, "add", base, claimed["id"], "--plain", "--json").out)
    assert better["notes"][0].startswith(f"made without {turned}: its probe is turned")
    scored = {s["test"]: s for s in better["scores"]}
    assert turned not in scored
    assert scored["day1"]["rmse_um"] < 1.0
    again = say("--store", store, "diagnose", better["model"])
    assert f"this version was made without {turned}: its probe is turned" in again.out

    rows[:, 1] *= -1
    np.savetxt(log, rows, fmt="%.4f", delimiter=",", header=head, comments="")
    assert say("--store", store, "ingest", path).code == 0
    mended = json.loads(say("--store", store, "add", base, claimed["id"], "--plain", "--json").out)
    assert turned in {s["test"] for s in mended["scores"]}, "what was mended is left out no more"
    assert not any(note.startswith("made without") for note in mended["notes"])


def test_a_campaign_without_locked_tests_has_nothing_to_confirm_on(say: Say, tmp_path: Path) -> None:
    path, store = write_campaign(tmp_path / "c"), tmp_path / "s"
    path.write_text(path.read_text(encoding="utf-8").replace("role: locked", "role: verification"), encoding="utf-8")
    assert say("--store", store, "ingest", path).code == 0
    base = json.loads(say("--store", store, "fit", tmp_path / "c" / "baseline.yaml", "--json").out)["model"]
    told = say("--store", store, "confirm", base, "feed_screw:T_nut_Z")
    assert told.code == 2
    assert "no locked test to confirm on" in told.err
    assert "got: none: every test of the model is open" in told.err
    for what_to_do in ("write role: locked at it in the file of 'small'", "then thermodata ingest", "thermodata fit "):
        assert what_to_do in " ".join(told.err.split())


def test_a_locked_test_that_the_model_has_lost_is_told_with_what_it_lacks(say: Say, tmp_path: Path) -> None:
    path, store = write_campaign(tmp_path / "c"), tmp_path / "s"
    log = tmp_path / "c" / "raw" / "day2.csv"
    head, *lines = log.read_text().splitlines()
    lost = next(i for i, name in enumerate(head.split(",")) if name.startswith("T_bearing"))
    rows = [[*cells[:lost], "", *cells[lost + 1 :]] for cells in (line.split(",") for line in lines)]
    log.write_text("\n".join([head, *map(",".join, rows)]) + "\n")
    assert say("--store", store, "ingest", path).code in (0, 3)
    base = json.loads(say("--store", store, "fit", tmp_path / "c" / "baseline.yaml", "--json").out)["model"]
    told = say("--store", store, "confirm", base, "feed_screw:T_nut_Z")
    assert told.code == 2
    assert "got: day2: no driver for spindle_bearing (T_bearing)\ntry: thermodata quality tells" in told.err


def test_a_locked_test_that_a_model_is_fitted_to_is_said_and_counted_once(say: Say, tmp_path: Path) -> None:
    path, store = write_campaign(tmp_path / "c"), tmp_path / "s"
    assert say("--store", store, "ingest", path).code == 0
    plain = (tmp_path / "c" / "baseline.yaml").read_text(encoding="utf-8")
    model = tmp_path / "c" / "open.yaml"
    model.write_text(plain + "calibrate_on: [day1, day2]\n", encoding="utf-8")
    for _ in range(2):
        fitted = say("--store", store, "fit", model)
        assert "locked in the campaign, and open in this model: small/day2" in fitted.err
        query = "select test, reason from locked_look"
        looks = json.loads(say("--store", store, "sql", query, "--json").out)
        assert [(look["test"], look["reason"]) for look in looks] == [("day2", "the model uses it as an open test")]
    assert "locked in the campaign" not in say("--store", store, "fit", tmp_path / "c" / "baseline.yaml").err
