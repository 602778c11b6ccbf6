"""Five folders as labs hand them over: drafted, completed by what their owners would answer, ingested and asked."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.commands import Say
from tests.draft.folders import FOLDERS, Folder
from thermodata.draft.writing.baseline import model_text_of
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign, load_model

MOST_ANSWERS = 3


def draft(name: str, folder: Path, say: Say) -> tuple[Folder, Path]:
    truth = FOLDERS[name](folder)
    said = say("init", folder)
    assert said.code == 0, said.err
    return truth, folder / "campaign.yaml"


def answer(truth: Folder, path: Path) -> None:
    """Edits the draft as its owner would: each answer in its one place."""
    text = path.read_text("utf-8")
    for drafted, answered in truth.answers:
        assert text.count(drafted) == 1, f"{drafted}: {text.count(drafted)} times in\n{text}"
        text = text.replace(drafted, answered)
    path.write_text(text, encoding="utf-8")


@pytest.mark.parametrize("name", FOLDERS)
def test_a_folder_is_ingested_after_at_most_three_answers(name: str, tmp_path: Path, say: Say) -> None:
    truth, path = draft(name, tmp_path / "lab", say)
    assert len(truth.answers) <= MOST_ANSWERS
    answer(truth, path)
    loaded = load_campaign(path)
    assert {t.id for t in loaded.tests} == set(truth.tests)
    assert {n: c.quantity for n, c in loaded.channels.items()} == truth.channels
    for test in loaded.tests:
        wanted = truth.conditions.get(test.id, {})
        assert {k: test.conditions.get(k) for k in wanted} == wanted, test.id
    store = ("--store", tmp_path / "s")
    summary = json.loads(say(*store, "ingest", path, "--json").out)
    assert summary["losses"] == []
    rows = json.loads(say(*store, "sql", "select test, duration_s from test", "--json").out)
    assert {r["test"]: r["duration_s"] for r in rows} == pytest.approx(truth.tests)
    channel, test, peak = truth.peak
    asked = f"select max(abs(value)) as peak from sample where channel = '{channel}' and test = '{test}' and flag = 0"
    assert json.loads(say(*store, "sql", asked, "--json").out)[0]["peak"] == pytest.approx(peak, rel=0.06)


@pytest.mark.parametrize("name", ["without_time", "headerless", "minutes"])
def test_a_time_that_nobody_knows_is_refused_and_never_made_up(name: str, tmp_path: Path, say: Say) -> None:
    truth, path = draft(name, tmp_path / "lab", say)
    said = say("--store", tmp_path / "s", "ingest", path, "--json")
    summary = json.loads(said.out)
    assert (said.code, summary["samples"]) == (3, 0)
    reasons = [x["reason"] for x in summary["losses"] if x["file"]]
    assert len(reasons) == len(truth.tests)
    assert all("is not answered yet" in r and "sources.*.table.time" in r for r in reasons)


def test_the_names_of_files_hint_at_the_unit(tmp_path: Path, say: Say) -> None:
    _, path = draft("minutes", tmp_path, say)
    line = next(x for x in path.read_text("utf-8").splitlines() if "unit: unknown" in x)
    assert "'Zeit' runs from 0 in steps of 1" in line
    assert "fits min (3 of 3 names state a length)" in line


def test_a_speed_that_reads_in_two_ways_is_asked_and_a_sample_number_is_none(tmp_path: Path, say: Say) -> None:
    _, path = draft("without_time", tmp_path / "a", say)
    lines = path.read_text("utf-8").splitlines()
    assert "1800 rpm, or number 1 at 8000 rpm?" in next(x for x in lines if "1-8k" in x and "- {" in x)
    assert any("# spindle_speed: {schedule:" in x and "nobody logged the speed" in x for x in lines)
    _, path = draft("headerless", tmp_path / "b", say)
    assert all(not t.conditions for t in load_campaign(path).tests)


def test_a_start_that_is_declared_dates_the_samples(tmp_path: Path, say: Say) -> None:
    truth, path = draft("sheets", tmp_path / "lab", say)
    answer(truth, path)
    text = path.read_text("utf-8").replace("{reader: table,", "{reader: table, timezone: America/Chicago,")
    path.write_text(text, encoding="utf-8")
    store = ("--store", tmp_path / "s")
    say(*store, "ingest", path)
    asked = "select test, clock, start_ns from test order by rowid"
    rows: list[dict[str, Any]] = json.loads(say(*store, "sql", asked, "--json").out)
    assert [(r["test"], r["clock"]) for r in rows] == [
        ("Idle", "absolute"),
        ("6000 rpm", "relative"),
        ("Speed steps", "relative"),
    ]
    assert rows[0]["start_ns"] == 1_556_886_600 * 10**9  # 2019-05-03 12:30 UTC: Chicago keeps daylight saving then


@pytest.mark.parametrize("name", ["without_time", "comments", "minutes", "sheets"])
def test_a_first_model_of_the_sensors_is_drafted_and_loads(name: str, tmp_path: Path, say: Say) -> None:
    truth, path = draft(name, tmp_path / "lab", say)
    model = load_model(path.parent / "model.yaml")
    assert model.campaign_ids == (load_campaign(path).id,)
    used = {c for e in model.effects for c in e.drivers.values()}
    assert used <= set(truth.channels)
    assert "ambient_frame" in {e.effect for e in model.effects}


def _effects_of(places: dict[str, str]) -> str:
    """The first model's text. places: of temperatures, beside a displacement along Z."""
    channels: dict[str, Any] = {n: {"quantity": "temperature", "unit": "degC", "at": at} for n, at in places.items()}
    channels["dZ"] = {"quantity": "displacement", "unit": "um", "axis": "Z", "at": "tcp", "relative_to": "table"}
    channels = {n: {"source": "s", "signal": n, **c} for n, c in channels.items()}
    campaign = Campaign.model_validate(
        {
            "schema": "thermodata/campaign/1",
            "id": "c",
            "machine": {"id": "m"},
            "sources": {"s": {"reader": "table", "files": "{test}.csv"}},
            "channels": channels,
            "tests": [{"id": "t", "kind": "etve", "role": "calibration"}],
        }
    )
    return model_text_of(campaign) or ""


def test_a_first_model_of_another_response_says_its_own_name_and_what_it_cannot_tell() -> None:
    probe = {"source": "s", "quantity": "displacement", "unit": "um"}
    nut = {"source": "s", "signal": "T", "quantity": "temperature", "unit": "degC"}
    campaign = Campaign.model_validate(
        {
            "schema": "thermodata/campaign/1",
            "id": "c",
            "machine": {"id": "m"},
            "sources": {"s": {"reader": "table", "files": "{test}.csv"}},
            "channels": {
                "dZ": {**probe, "signal": "dZ", "axis": "Z", "at": "tcp", "relative_to": "table"},
                "ch3": {**probe, "signal": "ch3"},
                "T_nut": {**nut, "at": "axis.z.nut"},
                "T_hall": {**nut, "at": "hall"},
            },
            "tests": [{"id": "t", "kind": "etve", "role": "calibration"}],
        }
    )
    text = model_text_of(campaign, "ch3") or ""
    assert "thermodata diagnose baseline_ch3 says" in text
    assert "name: baseline_ch3" in text
    assert "on an axis, and the response has none yet: feed_screw (T_nut)" in text
    assert "diagnose baseline says" in (model_text_of(campaign) or "")


@pytest.mark.parametrize("mid", ["hall", None])
def test_a_first_model_reads_the_air_of_the_hall_before_that_above(mid: str | None) -> None:
    text = _effects_of({"T_top": "hall.top", "T_air": mid or "hall.bottom"})
    assert f"ambient_frame, drivers: {{temperature: {'T_air' if mid else 'T_top'}}}" in text


@pytest.mark.parametrize(
    ("bearing", "taken", "other"), [("table.bearing", "T2", "T1"), ("table.pallet", "T1", "T2"), ("table", "T1", "T2")]
)
def test_a_first_model_reads_the_part_that_the_effect_is_called_after(bearing: str, taken: str, other: str) -> None:
    """A drive of the table before its bearing, in the order of the file."""
    text = _effects_of({"T1": "table.motor", "T2": bearing})
    assert f"table_bearing, drivers: {{temperature: {taken}}}" in text
    assert f"; or by {other}" in text


def test_the_drafted_model_fits_once_roles_are_given(tmp_path: Path, say: Say) -> None:
    truth, path = draft("minutes", tmp_path / "lab", say)
    answer(truth, path)
    text = path.read_text("utf-8").replace("role: none", "role: calibration")
    path.write_text(text, encoding="utf-8")
    store = ("--store", tmp_path / "s")
    say(*store, "ingest", path)
    fitted = json.loads(say(*store, "fit", path.parent / "model.yaml", "--json").out)
    scores = [s["fit"] for s in fitted["scores"] if s["phase"] == "all"]
    assert len(scores) == 3
    assert min(scores) > 50


def test_a_model_that_is_there_is_never_overwritten(tmp_path: Path, say: Say) -> None:
    (tmp_path / "lab").mkdir()
    own = tmp_path / "lab" / "model.yaml"
    own.write_text("mine\n")
    draft("minutes", tmp_path / "lab", say)
    assert own.read_text() == "mine\n"
    assert say("init", tmp_path / "lab", "--force").code == 0
    assert (tmp_path / "lab" / "model.1.yaml").read_text() == "mine\n"
    assert "thermodata/model/1" in own.read_text("utf-8")
    for kept, text in ((["model.1.yaml"], own.read_text("utf-8")), (["model.1.yaml", "model.2.yaml"], "mine too\n")):
        own.write_text(text, encoding="utf-8")
        assert say("init", tmp_path / "lab", "--force").code == 0
        assert sorted(p.name for p in own.parent.glob("model.*.yaml")) == kept, "what somebody wrote alone"
