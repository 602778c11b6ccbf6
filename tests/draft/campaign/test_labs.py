"""Folders of six labs, never seen by the drafting: drafted, ingested as drafted, and with questions answered."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.commands import Said
from tests.draft.labs import LABS, Lab
from thermodata.draft.campaign.parts import Draft
from thermodata.draft.campaign.plan import plan
from thermodata.draft.folder.scan import scan
from thermodata.draft.writing.write import text_of
from thermodata.schema.files.load import load_campaign


def drafted(name: str, folder: Path) -> tuple[Lab, Draft]:
    lab = LABS[name](folder)
    made = plan(name, folder, scan(folder))
    (folder / "campaign.yaml").write_text(text_of(made), encoding="utf-8")
    return lab, made


@pytest.mark.parametrize("name", LABS)
def test_the_draft_says_what_is_true_or_asks(name: str, tmp_path: Path) -> None:
    lab, made = drafted(name, tmp_path)
    loaded = load_campaign(tmp_path / "campaign.yaml")
    assert {t.id for t in loaded.tests} == lab.tests
    assert len(loaded.sources) == lab.sources
    assert {t.id: t.kind for t in loaded.tests if t.id in lab.kinds} == lab.kinds
    assert {getattr(c, "file", ""): getattr(c, "signal", "") for c in loaded.calibrations.values()} == lab.jumps
    assert {t.role for t in loaded.tests} == {"none"}  # a role is never guessed
    said = {c.signal: c.said for c in made.channels}
    wrong = {
        s: (said[s].quantity, said[s].at, said[s].axis)
        for s, truth in lab.signals.items()
        if (said[s].quantity, said[s].at, said[s].axis) != truth and not said[s].questions
    }
    assert wrong == {}


@pytest.mark.parametrize("name", LABS)
def test_the_draft_ingests_as_it_is(name: str, tmp_path: Path, say: Callable[..., Said]) -> None:
    lab = LABS[name](tmp_path / "c")
    made = json.loads(say("init", tmp_path / "c", "--json").out)
    assert {t["id"] for t in made["tests"]} == lab.tests
    said = say("--store", tmp_path / "s", "ingest", tmp_path / "c" / "campaign.yaml", "--json")
    summary = json.loads(said.out)
    # what may be lost is what was asked for: volts without a calibration are never taken for micrometres
    asked = ("displacement in V", "moves are unknown", "is not available", "no unit is known")
    others = [x["reason"] for x in summary["losses"] if not any(a in x["reason"] for a in asked)]
    assert others == []
    assert summary["tests"] == len(lab.tests)
    assert summary["samples"] > 0
    assert said.code == (3 if summary["losses"] else 0)


def test_with_its_questions_answered_a_draft_calibrates(tmp_path: Path, say: Callable[..., Said]) -> None:
    LABS["german"](tmp_path / "c")
    say("init", tmp_path / "c")
    path = tmp_path / "c" / "campaign.yaml"
    text = path.read_text("utf-8").replace("moves: unknown", "moves: [100 um, -50 um, -50 um]")
    text = text.replace('Steuerung/{test}.csv"', 'Steuerung/{test}.csv", timezone: Europe/Berlin')
    assert [s.get("timezone") for s in yaml.safe_load(text)["sources"].values()].count("Europe/Berlin") == 1
    path.write_text(text, encoding="utf-8")
    summary = json.loads(say("--store", tmp_path / "s", "ingest", path, "--json").out)
    gains = {c["name"]: c["gain"] for c in summary["calibrations"]}
    assert gains == pytest.approx({"jump_Wirbelstrom_X": 80, "jump_Wirbelstrom_Z": 80}, rel=0.02)
    lost = {x["reason"].split("'")[1] for x in summary["losses"]}
    assert lost == {"Wirbelstrom_Y"}  # nobody moved the probe Y


def test_a_zone_is_asked_for_with_what_the_other_clocks_say(tmp_path: Path) -> None:
    _, made = drafted("german", tmp_path)
    nc = next(s for s in made.sources if s.reader == "cnc")
    assert any("timezone?" in q and "+1 h" in q and "Europe/Berlin" in q for q in nc.questions)
    assert next(s for s in made.sources if s.reader == "crio").questions == ()


def test_clocks_are_aligned_by_what_both_logged(tmp_path: Path) -> None:
    _, made = drafted("recorder", tmp_path)
    found = next(s.align for s in made.sources if s.align)
    assert found is not None
    assert found.offset_s == pytest.approx(-40, abs=5)
    loaded = load_campaign(tmp_path / "campaign.yaml")
    assert loaded.sources["daq"].clock.align_to == "rec"  # which has UTC


def test_parts_of_one_test_become_one(tmp_path: Path) -> None:
    drafted("czech", tmp_path)
    loaded = load_campaign(tmp_path / "campaign.yaml")
    assert loaded.sources["mereni"].files == "{test}/mereni_*.tdms"
    assert len(loaded.tests) == 2


def test_names_of_one_pattern_become_tests_from(tmp_path: Path) -> None:
    drafted("chinese", tmp_path)
    text = yaml.safe_load((tmp_path / "campaign.yaml").read_text("utf-8"))
    assert text["tests_from"]["files"] == "数据/S{speed}_F{feed}_{nr}.csv"
    conditions = load_campaign(tmp_path / "campaign.yaml").tests[0].conditions
    assert conditions["speed"] == "2000 rpm"


def test_a_table_beside_the_files_gives_conditions(tmp_path: Path) -> None:
    drafted("workbooks", tmp_path)
    tests = {t.id: t.conditions for t in load_campaign(tmp_path / "campaign.yaml").tests}
    assert tests["test_02"] == {"speed": "9000 rpm", "tool": "HSK63 dummy", "remark": "door open"}


def test_what_is_not_used_is_said_with_its_reason(tmp_path: Path) -> None:
    drafted("sinumerik", tmp_path)
    lines = (tmp_path / "campaign.yaml").read_text("utf-8").splitlines()
    left = [x for x in lines if x.startswith("# not used:")]
    assert sorted(x.split(":")[1].strip() for x in left) == ["labview/broken.txt", "notes.txt"]


def test_what_the_json_says_is_what_the_file_says(tmp_path: Path, say: Callable[..., Said]) -> None:
    LABS["chinese"](tmp_path / "c")
    made: dict[str, Any] = json.loads(say("init", tmp_path / "c", "--json").out)
    loaded = load_campaign(tmp_path / "c" / "campaign.yaml")
    assert {c["name"]: (c["quantity"], c["at"]) for c in made["channels"]} == {
        n: (c.quantity, c.at) for n, c in loaded.channels.items()
    }
    assert {c["sure"] for c in made["channels"]} == {True, False}
