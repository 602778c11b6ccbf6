"""A model taken out of the lab by commands: written for a control, run on logs without displacement, shown."""

from __future__ import annotations

import csv
import io
import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
import yaml

from thermodata.cli import main
from thermodata.modelling.run import load
from thermodata.store import Store

from ..commands import Said, Say
from .conftest import write_campaign


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small campaign with sensors that flicker as real ones do: readings that stand still are flagged as held."""
    folder = tmp_path_factory.mktemp("flicker") / "lab"
    path = write_campaign(folder)
    rng = np.random.default_rng(3)
    for log in sorted((folder / "raw").glob("*.csv")):
        head = log.read_text().splitlines()[0]
        rows = np.genfromtxt(log, delimiter=",", skip_header=1)
        rows[:, 2:5] += rng.normal(0.0, 0.01, (len(rows), 3))
        np.savetxt(log, rows, fmt="%.4f", delimiter=",", header=head, comments="")
    for words in (["ingest", path], ["fit", folder / "baseline.yaml"]):
        assert main(["--store", str(folder / "thermodata.store"), *map(str, words), "--json"]) == 0
    return folder


@pytest.fixture
def refused(say: Say, campaign: Path) -> Callable[..., str]:
    """Runs a command that must be refused; its words."""

    def run(*words: object) -> str:
        said = say("--store", campaign / "thermodata.store", *words)
        assert (said.code, said.out) == (2, "")
        return said.err

    return run


@pytest.fixture
def logs(campaign: Path, tmp_path: Path) -> Path:
    """Two logs of the machine without its displacement."""
    folder = tmp_path / "march"
    folder.mkdir()
    for name, old in (("run_2", "heat1"), ("run_10", "day2")):
        rows = list(csv.reader((campaign / "raw" / f"{old}.csv").open()))
        at = rows[0].index("dZ [um]")
        with (folder / f"{name}.csv").open("w", newline="") as file:
            csv.writer(file).writerows([c for i, c in enumerate(row) if i != at] for row in rows)
    return folder


def test_logs_without_displacement_are_predicted(ask: Say, logs: Path) -> None:
    answer = json.loads(ask("predict", "baseline", logs, "--json").out)
    assert [t["test"] for t in answer["tests"]] == ["run_2", "run_10"]
    first = answer["tests"][0]
    assert (first["campaign"], first["response"], first["unit"], first["rmse"]) == ("march", "dZ", "um", None)
    assert first["known"] == 1.0
    kept = json.loads(ask("sql", "select t_s, predicted from residual where test = 'heat1' order by t_s", "--json").out)
    kept = np.array([[row["t_s"], row["predicted"]] for row in kept])
    assert np.allclose(first["t_s"], kept[:, 0])
    assert np.allclose(np.diff(first["predicted"]), np.diff(kept[:, 1]), atol=1e-9)
    assert np.ptp(first["predicted"]) > 5.0


def test_a_hotter_log_is_said_to_be_beyond_the_fit(ask: Say, logs: Path) -> None:
    assert json.loads(ask("predict", "baseline", logs, "--json").out)["beyond"] == []
    path = logs / "run_2.csv"
    head, *rows = csv.reader(path.open())
    at = head.index("T_bearing [degC]")
    first = float(rows[0][at])
    with path.open("w", newline="") as file:
        hot = ([*r[:at], str(first + 4 * (float(r[at]) - first)), *r[at + 1 :]] for r in rows)
        csv.writer(file).writerows([head, *hot])
    (one,) = json.loads(ask("predict", "baseline", logs, "--json").out)["beyond"]
    assert (one["test"], one["effect"], one["drivers"]) == ("run_2", "spindle_bearing", ["T_bearing"])
    text = ask("predict", "baseline", logs).out
    assert "beyond the tests that the model is fitted to" in text
    assert "run_2: spindle_bearing (T_bearing) goes to" in text


def test_a_driver_that_is_held_beyond_its_last_reading_is_said(ask: Say, logs: Path) -> None:
    assert json.loads(ask("predict", "baseline", logs, "--json").out)["held"] == []
    path = logs / "run_2.csv"
    head, *rows = csv.reader(path.open())
    at, end_s = head.index("T_bearing [degC]"), float(rows[-1][0])
    with path.open("w", newline="") as file:
        cut = ([*r[:at], "" if float(r[0]) > end_s - 1200 else r[at], *r[at + 1 :]] for r in rows)
        csv.writer(file).writerows([head, *cut])
    answer = json.loads(ask("predict", "baseline", logs, "--json").out)
    (one,) = answer["held"]
    assert (one["test"], one["channel"], one["at_end"]) == ("run_2", "T_bearing", True)
    assert one["from_s"] == pytest.approx(end_s - 1200, abs=61)
    assert answer["tests"][0]["known"] == 1.0
    text = ask("predict", "baseline", logs).out
    assert "T_bearing is held at its last value where nothing measured it, and counts as known: run_2 (" in text


def test_one_log_is_predicted_as_its_test(ask: Say, refused: Callable[..., str], logs: Path) -> None:
    whole = {t["test"]: t for t in json.loads(ask("predict", "baseline", logs, "--json").out)["tests"]}
    (one,) = json.loads(ask("predict", "baseline", logs / "run_10.csv", "--json").out)["tests"]
    assert one["test"] == "run_10"
    assert one["predicted"] == whole["run_10"]["predicted"]
    (logs / "notes.txt").write_bytes("Temp;°C".encode("cp1252"))
    said = refused("predict", "baseline", logs / "notes.txt")
    assert "the log fits no source of the model's campaign" in said
    assert "{test}.csv" in said


def test_a_prediction_is_a_table_a_file_and_csv(ask: Say, logs: Path, tmp_path: Path) -> None:
    out = tmp_path / "predicted.parquet"
    text = ask("predict", "baseline", logs, "--out", out).out
    assert "run_2" in text
    assert "lowest [um]" in text
    table = pq.read_table(out)
    assert table.column_names == [
        "campaign", "test", "response", "t_s", "predicted", "measured", "known", "c__spindle_bearing",
        "predicted_low", "predicted_high",
    ]  # fmt: skip
    assert table.column("measured").null_count == table.num_rows
    rows = list(csv.DictReader(io.StringIO(ask("predict", "baseline", logs, "--csv", "--test", "run_10").out)))
    assert {r["test"] for r in rows} == {"run_10"}
    wanted = [
        v for v, t in zip(*(table.column(c).to_pylist() for c in ("predicted", "test")), strict=True) if t == "run_10"
    ]
    assert np.allclose([float(r["predicted [um]"]) for r in rows], wanted)
    assert "95 %: from the parameters" in text
    assert "it does not hold" in text
    assert all(
        float(r["predicted_low [um]"]) < float(r["predicted [um]"]) < float(r["predicted_high [um]"]) for r in rows
    )


def test_the_prediction_of_another_machine_names_it_and_has_no_band(ask: Say, campaign: Path, tmp_path: Path) -> None:
    own = json.loads(ask("predict", "baseline", "small", "--json").out)
    assert own["elsewhere"] == []
    assert all(t["half_95"] > 0 for t in own["tests"])
    text = (campaign / "campaign.yaml").read_text()
    other = campaign / "other.yaml"
    spec = yaml.safe_load(text)
    other.write_text(yaml.safe_dump({**spec, "machine": {**spec["machine"], "id": "hobbing-7"}}))
    answer = json.loads(ask("predict", "baseline", other, "--json").out)
    other.unlink()
    (said,) = answer["elsewhere"]
    assert "is of machine hobbing-7, and the model was fitted to machine" in said
    assert {t["half_95"] for t in answer["tests"]} == {None}
    assert answer["tests"][0]["predicted_low"] is None


def test_a_campaign_shows_its_error_but_not_that_of_a_locked_test(ask: Say, campaign: Path) -> None:
    by_name = json.loads(ask("predict", "baseline", "small", "--json").out)["tests"]
    by_file = json.loads(ask("predict", "baseline", campaign / "campaign.yaml", "--json").out)["tests"]
    assert [t["predicted"] for t in by_name] == [t["predicted"] for t in by_file]
    rmse = {t["test"]: t["rmse"] for t in by_name}
    assert rmse["day1"] > 0.3
    assert rmse["day2"] is None


def test_what_can_not_be_predicted_is_said(ask: Say, refused: Callable[..., str], logs: Path, tmp_path: Path) -> None:
    assert "no folder, campaign file or campaign 'nope'" in refused("predict", "baseline", "nope")
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "thermodata init" in refused("predict", "baseline", empty)
    assert "no test 'run_3'" in refused("predict", "baseline", logs, "--test", "run_3")
    assert "--force replaces it" in refused("predict", "baseline", logs, "--out", _touched(tmp_path / "x.csv"))
    assert ".parquet or .csv" in refused("predict", "baseline", logs, "--out", tmp_path / "x.xlsx")


def test_a_test_without_a_driver_is_left_out_with_its_reason(say: Say, campaign: Path, logs: Path) -> None:
    rows = list(csv.reader((logs / "run_2.csv").open()))
    at = rows[0].index("T_bearing [degC]")
    with (logs / "run_2.csv").open("w", newline="") as file:
        csv.writer(file).writerows([c for i, c in enumerate(row) if i != at] for row in rows)
    said = say("--store", campaign / "thermodata.store", "predict", "baseline", logs)
    assert said.code == 3
    assert "left out: march/run_2: nothing in its logs is read by the model" in said.err
    assert "run_10" in said.out
    assert "run_2" not in said.out
    # also where none of the tests that are asked for has it
    predict = ("--store", campaign / "thermodata.store", "predict", "baseline")
    (logs / "run_10.csv").write_bytes((logs / "run_2.csv").read_bytes())
    said = say(*predict, logs, "--json")
    assert said.code == 3
    answer = json.loads(said.out)
    assert (answer["tests"], answer["file"]) == ([], None)
    assert len(answer["left_out"]) == 2
    assert say(*predict, logs, "--csv").out == ""


def _touched(path: Path) -> Path:
    path.write_text("")
    return path


def test_a_model_runs_in_a_python_of_its_own_as_it_was_predicted(ask: Say, campaign: Path, tmp_path: Path) -> None:
    answer = json.loads(
        ask("model", "export", "baseline", "--to", "python", "--cycle", "60 s", "-o", tmp_path, "--json").out
    )
    assert [i["name"] for i in answer["inputs"]] == ["T_bearing"]
    assert (answer["cycle_s"], answer["effects"], answer["states"]) == (60.0, ["spindle_bearing"], 1)
    log = list(csv.reader((campaign / "raw" / "heat1.csv").open()))
    at = log[0].index("T_bearing [degC]")
    text = "T_bearing\n" + "\n".join(row[at] for row in log[1:]) + "\n"
    done = subprocess.run(
        [sys.executable, "-I", "-S", answer["files"][0]], input=text, capture_output=True, text=True, check=True
    )
    made = [float(row["displacement"]) for row in csv.DictReader(io.StringIO(done.stdout))]
    told = json.loads(ask("predict", "baseline", "small", "--test", "heat1", "--json").out)["tests"][0]["predicted"]
    # the logs' grid is the control's: only what a start counts from differs (a mean of the first minutes there)
    assert np.abs(np.diff(np.array(made) - np.array(told))).max() < 0.01
    assert np.abs(np.array(made) - np.array(told))[-1] < 0.1


@pytest.mark.parametrize("target", ["st", "scl", "c", "python", "json", "mat"])
def test_every_target_is_written_once(
    ask: Say, refused: Callable[..., str], campaign: Path, tmp_path: Path, target: str
) -> None:
    words = ("model", "export", "baseline", "--to", target, "-o", tmp_path)
    text = ask(*words).out
    files = sorted(p.name for p in tmp_path.iterdir())
    assert files
    assert all(name in text for name in files)
    assert "baseline_dZ" in files[0]
    assert "--force replaces it" in refused(*words)
    ask(*words, "--force")


def test_limits_cycle_and_names_are_the_users(ask: Say, refused: Callable[..., str], tmp_path: Path) -> None:
    words = ("model", "export", "baseline", "--to", "json", "-o", tmp_path)
    ask(*words, "--cycle", "500 ms", "--limit", "40", "--rate", "5", "--hold", "2 min", "--name", "Kompenzace Z")
    data = json.loads((tmp_path / "Kompenzace_Z.json").read_text())
    assert data["cycle_s"] == 0.5
    assert data["limits"] == {"correction": 40.0, "rate_per_min": 5.0, "hold_s": 120.0}
    assert "a cycle of a control" in refused(*words, "--cycle", "2 h")
    assert "--limit is larger than 0" in refused(*words, "--limit", "-4")
    assert "64 bits" in refused(*words, "--real", "real")


def test_what_can_not_run_in_a_control_is_refused_with_reason_and_way_out(
    say: Say, campaign: Path, tmp_path: Path
) -> None:
    lab = tmp_path / "lab"
    shutil.copytree(campaign, lab)
    text = (lab / "baseline.yaml").read_text().replace("name: baseline", "name: with_start")
    extra = "drivers: {u: T_nut_Z}, gain_by: conditions.day, fixed: {tau: 45}"
    (lab / "with_start.yaml").write_text(
        text + "  - {effect: warm_start, gain_by: test}\n" + f"  - {{effect: lag, id: nut, {extra}}}\n"
    )
    declared = (lab / "campaign.yaml").read_text()
    for i, test in enumerate(("heat1", "heat2", "day1", "day2")):
        condition = f"conditions: {{day: {'cold' if i % 2 else 'warm'}}}"
        line = next(x for x in declared.splitlines() if f"id: {test}," in x)
        declared = declared.replace(line, line.replace("conditions: {speed: 9000 rpm}", condition))
    (lab / "campaign.yaml").write_text(declared)

    def run(*words: object) -> Said:
        return say("--store", lab / "thermodata.store", *words)

    assert run("ingest", lab / "campaign.yaml").code == 0
    words = ("model", "export", lab / "with_start.yaml", "--to", "st", "-o", tmp_path)
    said = run(*words)
    assert said.code == 2
    assert "warm_start: " in said.err
    assert "goes on from its last state" in said.err
    assert "nut: its gain differs by day (" in said.err
    assert "--group nut=warm chooses its gain; --without warm_start leaves it out" in said.err
    assert "--without warm_start,nut" not in said.err
    assert run(*words, "--without", "warm_start", "--group", "nut=cold").code == 0
    written = (tmp_path / "with_start_dZ.st").read_text()
    assert "nut: cold" in written
    assert "left out" in written
    # the largest correction is that of the tests whose gain it has
    limits = {}
    for group in ("cold", "warm"):
        written = ("model", "export", "with_start", "--to", "json", "-o", tmp_path, "--force", "--json")
        only = ("--without", "warm_start,spindle_bearing", "--group", f"nut={group}")
        limits[group] = json.loads(run(*written, *only).out)["limit"]
    loaded = load(Store(lab / "thermodata.store"), "with_start")
    nut = next(t for t in loaded.fitted.responses[0].terms if t.id == "nut")
    for group in ("cold", "warm"):
        own = [np.nanmax(np.abs(nut.contribution(t))) for t in loaded.data.tests if nut.bound.group(t) == group]
        assert 1.5 * max(own) <= limits[group] <= 1.7 * max(own)
    assert "no effect 'nu'" in run(*words, "--without", "nu").err
    assert "no group of nut 'hot'" in run(*words, "--without", "warm_start", "--group", "nut=hot").err


def test_the_model_file_of_a_version_is_the_same_model_again(say: Say, campaign: Path, tmp_path: Path) -> None:
    lab = shutil.copytree(campaign, tmp_path / "lab")

    def ask(*words: object) -> Said:
        said = say("--store", lab / "thermodata.store", *words)
        assert said.code == 0, said.err
        return said

    made = json.loads(ask("add", "baseline", "feed_screw:T_nut_Z", "--json").out)
    words = ("model", "export", made["model"], "--to", "yaml", "-o", tmp_path)
    told = json.loads(ask(*words, "--json").out)
    assert (told["to"], told["files"], told["cycle_s"]) == ("yaml", [str(tmp_path / "baseline.yaml")], None)
    assert "--force replaces it" in say("--store", lab / "thermodata.store", *words).err
    again = json.loads(ask("fit", tmp_path / "baseline.yaml", "--json").out)
    assert again["model"] == made["model"]
    assert again["parameters"] == made["parameters"]
    program = json.loads(ask("model", "export", "baseline", "--to", "json", "-o", tmp_path, "--json").out)
    assert told.keys() == program.keys()
    assert json.loads(ask(*words, "--name", "mine", "--json").out)["files"] == [str(tmp_path / "mine.yaml")]
    # a file of that name of another campaign stays, and the campaign comes into the name
    path = tmp_path / "baseline.yaml"
    path.write_text(path.read_text().replace("campaign: small", "campaign: large"))
    assert json.loads(ask(*words, "--json").out)["files"] == [str(tmp_path / "baseline_small.yaml")]
    assert "campaign: large" in path.read_text()
    assert "baseline_small.yaml" in say("--store", lab / "thermodata.store", *words).err


# ---- show


def test_show_says_what_the_fit_found(ask: Say, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "160")  # headings in one line
    fitted = json.loads(ask("fit", "baseline", "--json").out)["parameters"]
    shown = json.loads(ask("show", "baseline", "--json").out)["responses"][0]
    (path,) = shown["paths"]
    assert (path["effect"], path["drive"], path["unit"]) == ("spindle_bearing", "T_bearing", "um/K")
    assert path["gain_at_rest"] == pytest.approx(fitted["spindle_bearing.gain"]["value"])
    assert path["time_constants_min"] == pytest.approx([fitted["spindle_bearing.tau"]["value"]])
    assert path["poles"][0][0] == pytest.approx(np.exp(-1.0 / path["time_constants_min"][0]))
    assert sum(path["a"]) / sum(path["b"]) == pytest.approx(path["gain_at_rest"])
    assert path["step_response"]["y"][-1] == pytest.approx(path["gain_at_rest"], rel=0.01)
    residual = shown["residual"]
    assert residual["autocorrelation"][0] == 1.0
    assert residual["ljung_box"][0]["p_value"] < 1e-3  # the nut that the model lacks
    assert [s["state"].partition(":")[0] for s in shown["states"]] == ["spindle_bearing"]
    text = ask("show", "baseline").out
    for told in ("poles z", "gain at rest", "Ljung-Box", "residual against", "um/K", "0 by the fit: gains are solved"):
        assert told in text


def test_show_says_whose_bound_holds_a_gain(ask: Say, campaign: Path) -> None:
    assert json.loads(ask("show", "baseline", "--json").out)["responses"][0]["at_bounds"] == []
    text = (campaign / "baseline.yaml").read_text(encoding="utf-8").split("effects:")[0]
    held = text.replace("name: baseline", "name: held")
    path = campaign / "held.yaml"
    path.write_text(
        held + "effects: [{effect: spindle_bearing, drivers: {temperature: T_bearing}, bounds: {gain: [0, 0.1]}}]\n"
    )
    fitted = json.loads(ask("fit", path, "--json").out)
    (row,) = json.loads(ask("show", fitted["model"], "--json").out)["responses"][0]["at_bounds"]
    assert (row["name"], row["value"], row["bound"]) == ("at_bound:spindle_bearing.gain", 0.1, 0.1)
    assert "held at 0.1 by a bound of the model file" in ask("show", fitted["model"]).out


def test_show_draws_a_picture(ask: Say, refused: Callable[..., str], tmp_path: Path) -> None:
    out = tmp_path / "show.png"
    assert str(out) in ask("show", "baseline", "--png", out).out
    assert out.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert out.stat().st_size > 20_000
    assert "FILE.png" in refused("show", "baseline", "--png", tmp_path / "show.svg")
    svg, pdf = tmp_path / "show.svg", tmp_path / "show.pdf"
    answer = json.loads(ask("show", "baseline", "--svg", svg, "--pdf", pdf, "--json").out)
    assert (answer["picture"], answer["pictures"]) == (str(svg), [str(svg), str(pdf)])
    drawn = svg.read_text("utf-8")
    assert "Bode: phase [deg]" in drawn
    assert "band: 95 % of white noise" in drawn
    assert pdf.read_bytes()[:5] == b"%PDF-"
    ask("show", "baseline", "--svg", svg)
    assert svg.read_text("utf-8") == drawn, "the same model gives the same file"
    assert "no effect 'spindle'" in refused("show", "baseline", "--effect", "spindle")


def test_without_matplotlib_the_hint_is_the_extra(
    refused: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    said = refused("show", "baseline", "--png", tmp_path / "show.png")
    assert "thermodata[picture]" in said
    assert not (tmp_path / "show.png").exists()
