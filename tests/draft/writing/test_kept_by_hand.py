"""`init --force` after answers: what they tell of signals is taken up, and nothing that was answered is lost."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from thermodata.draft.make import draft_files
from thermodata.draft.writing.fill_in import filled_in
from thermodata.schema.files.load import load_campaign

MOVES = (100, -100, 50, -50)


def log(path: Path, hour: int, s1: np.ndarray) -> None:
    bed = np.linspace(20, 22, len(s1))
    rows = [
        f"2026-03-02 {hour + k // 3600:02d}:{k // 60 % 60:02d}:{k % 60:02d},{a:.4f},{b:.2f}"
        for k, (a, b) in enumerate(zip(s1, bed, strict=True))
    ]
    path.write_text("\n".join(["time,S1,T_bed [°C]", *rows, ""]))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two tests and a file in which a probe went over gauges, whose names say nothing of it."""
    rng = np.random.default_rng(7)
    for hour, name in ((8, "S4000.csv"), (10, "S8000.csv")):
        log(tmp_path / name, hour, np.linspace(0, 30, 7000) + rng.normal(0, 0.01, 7000))
    steps = rng.normal(0, 0.01, 300)
    for k, move in enumerate(MOVES):
        steps[40 + 60 * k :] += move
    log(tmp_path / "gauge_50um.csv", 13, steps)
    draft_files(tmp_path)
    return tmp_path


def answer(folder: Path, **given: str) -> None:
    path = folder / "campaign.yaml"
    path.write_text(filled_in(path.read_text(), {k.replace("__", "."): v for k, v in given.items()}))


def anew(folder: Path) -> dict[str, object]:
    """The campaign file of a draft made anew, which loads."""
    draft_files(folder, force=True)
    load_campaign(folder / "campaign.yaml")
    return dict(yaml.safe_load((folder / "campaign.yaml").read_text()))


def line_of(folder: Path, begin: str) -> str:
    return next(x for x in (folder / "campaign.yaml").read_text().splitlines() if x.strip().startswith(begin))


def as_probe(folder: Path) -> None:
    answer(folder, unread__S1="displacement [um]")
    answer(
        folder,
        channels__S1__axis="Z",
        channels__S1__at="tcp",
        channels__T_bed__at="spindle.bearing.front",
        machine__id="138",
    )
    answer(folder, tests__0__role="calibration", tests__1__role="verification")


def test_the_jump_test_of_a_probe_that_somebody_named_is_drafted(folder: Path) -> None:
    assert "calibrations" not in yaml.safe_load((folder / "campaign.yaml").read_text())
    as_probe(folder)
    made = anew(folder)
    jump = made["calibrations"]["jump_S1"]
    assert (jump["file"], jump["axis"], jump["moves"]) == ("gauge_50um.csv", "Z", "unknown")
    assert "seen: steps of +100, -100, +50, -50 um" in line_of(folder, "jump_S1:")
    assert made["channels"]["S1"] == {
        "source": "log",
        "signal": "S1",
        "quantity": "displacement",
        "unit": "um",
        "axis": "Z",
        "at": "tcp",
        "relative_to": "table",
        "calibration": "jump_S1",
    }
    assert [t["id"] for t in made["tests"]] == ["S4000", "S8000"]


def test_and_nothing_else_that_was_answered_is_lost_or_asked_again(folder: Path) -> None:
    as_probe(folder)
    made = anew(folder)
    assert made["machine"]["id"] == "138"
    assert made["channels"]["T_bed"]["at"] == "spindle.bearing.front"
    assert [t["role"] for t in made["tests"]] == ["calibration", "verification"]
    assert "# ?" not in line_of(folder, "S1:")
    assert "kept from the campaign file before: T_bed (at), S4000 (role), S8000 (role), S1" in line_of(folder, "# note")
    model = yaml.safe_load((folder / "model.yaml").read_text())
    assert [e["drivers"] for e in model["effects"]] == [{"temperature": "T_bed"}], "a first model of what was answered"


def test_moves_that_were_answered_are_kept_however_often_it_is_drafted(folder: Path) -> None:
    as_probe(folder)
    anew(folder)
    answer(folder, calibrations__jump_S1__moves="100, -100, 50, -50")
    first, second = anew(folder), anew(folder)
    assert first == second
    assert first["calibrations"]["jump_S1"]["moves"] == [f"{m} um" for m in MOVES]
    assert "# ?" not in line_of(folder, "jump_S1:")


def test_what_is_no_probe_has_no_jump_test(folder: Path) -> None:
    answer(folder, unread__S1="load [%]")
    made = anew(folder)
    assert "calibrations" not in made
    assert made["channels"]["S1"]["quantity"] == "load"
    assert [t["id"] for t in made["tests"]] == ["S4000", "S8000", "gauge_50um"]


def test_a_draft_that_nobody_touched_is_drafted_as_it_was(folder: Path) -> None:
    before = (folder / "campaign.yaml").read_text()
    anew(folder)
    assert (folder / "campaign.yaml").read_text() == before


def test_what_was_written_by_hand_beside_the_questions_stays(folder: Path) -> None:
    path = folder / "campaign.yaml"
    text = path.read_text().replace("T_bed: {", "bed: {")
    text = text.replace("channels:", 'channels:\n  dT: {derive: "bed - 20 degC", quantity: temperature_difference}', 1)
    text = text.replace("S4000, kind: spindle,", "S4000, kind: spindle, start_state: warm, phases: {run: [0 h, 1 h]},")
    path.write_text(text + "overrule: [{flag: spike, tests: [S4000], channel: bed, because: a door}]\n")
    load_campaign(path)
    made = anew(folder)
    assert {"bed", "dT"} <= set(made["channels"])
    assert "T_bed" not in made["channels"]
    assert made["tests"][0]["start_state"] == "warm"
    assert made["tests"][0]["phases"] == {"run": ["0 h", "1 h"]}
    assert made["overrule"] == [{"flag": "spike", "tests": ["S4000"], "channel": "bed", "because": "a door"}]


def test_parts_that_somebody_made_of_a_recording_stay_in_its_place(folder: Path) -> None:
    path = folder / "campaign.yaml"
    (old,) = [x for x in path.read_text().splitlines() if "{id: S4000" in x]
    parts = [
        f"  - {{id: part{k}, kind: spindle, files: {{log: S4000.csv}}, window: [{k} h, {k + 0.9} h]}}" for k in (0, 1)
    ]
    path.write_text(path.read_text().replace(old, "\n".join(parts)))
    made = anew(folder)
    assert sorted(t["id"] for t in made["tests"]) == ["S8000", "gauge_50um", "part0", "part1"]


def test_tests_that_somebody_gave_a_pattern_keep_it(folder: Path) -> None:
    path = folder / "campaign.yaml"
    head, _, _ = path.read_text().partition("tests:")
    path.write_text(head + 'tests_from:\n  files: "S{speed}.csv"\n  set: {kind: spindle, role: calibration}\n')
    before = load_campaign(path).tests
    assert {(t.id, t.role) for t in before} == {("S4000", "calibration"), ("S8000", "calibration")}
    made = anew(folder)
    assert "tests" not in made
    assert load_campaign(path).tests == before


@pytest.mark.parametrize("text", ["mine\n", "", "schema: thermodata/model/1\n", "tests: [\n"])
def test_a_file_that_is_no_campaign_is_put_aside(folder: Path, text: str) -> None:
    before = (folder / "campaign.yaml").read_text()
    (folder / "campaign.yaml").write_text(text)
    draft_files(folder, force=True)
    assert (folder / "campaign.yaml").read_text().partition("# not used")[0].partition("# as drafted")[0] == (
        before.partition("# as drafted")[0]
    )
    assert (folder / "campaign.1.yaml").read_text() == text


def test_what_does_not_load_with_the_draft_is_left_and_told(folder: Path) -> None:
    path = folder / "campaign.yaml"
    path.write_text(path.read_text().replace("at: bed}", "at: bed, calibration: gone}"))
    draft_files(folder, force=True)
    load_campaign(path)
    assert "by hand is not kept" in path.read_text()


def test_a_source_that_somebody_called_otherwise_keeps_what_was_said_of_its_signals(folder: Path) -> None:
    as_probe(folder)
    path = folder / "campaign.yaml"
    path.write_text(path.read_text().replace("  log: {", "  daq: {").replace("source: log", "source: daq"))
    load_campaign(path)
    made = anew(folder)
    assert made["channels"]["T_bed"]["at"] == "spindle.bearing.front"
    assert "jump_S1" in made["calibrations"]
    assert "'daq' is 'log' now" in path.read_text()


def test_a_source_that_somebody_added_stays_with_its_channels(folder: Path) -> None:
    path = folder / "campaign.yaml"
    text = path.read_text().replace("sources:", "sources:\n  own: {reader: table, files: 'hand/{test}.dat'}", 1)
    path.write_text(
        text.replace("channels:", "channels:\n  hall: {source: own, signal: T, quantity: temperature, unit: K}", 1)
    )
    made = anew(folder)
    assert made["sources"]["own"] == {"reader": "table", "files": "hand/{test}.dat"}
    assert made["channels"]["hall"]["source"] == "own"


def test_what_a_draft_cannot_hold_is_told_and_takes_nothing_else_with_it(folder: Path) -> None:
    """Two sources of one file in the place of the draft's one."""
    answer(folder, channels__T_bed__at="spindle.bearing.front")
    path = folder / "campaign.yaml"
    text = path.read_text().replace("sources:", "sources:\n  own: {reader: table, files: 'S4000.csv'}", 1)
    path.write_text(
        text.replace("channels:", "channels:\n  hall: {source: own, signal: T, quantity: temperature, unit: K}", 1)
    )
    made = anew(folder)
    assert made["channels"]["T_bed"]["at"] == "spindle.bearing.front"
    assert "hall" not in made["channels"]
    note = line_of(folder, "# note: not kept")
    assert "own of sources, for 'log' has its files now" in note
    assert "hall of channels, for the draft has no source 'own'" in note
    assert "hall of channels" not in line_of(folder, "# note: kept")


def test_two_channels_of_one_signal_both_stay(folder: Path) -> None:
    path = folder / "campaign.yaml"
    text = path.read_text()
    (bed,) = [x for x in text.splitlines() if x.startswith("  T_bed:")]
    path.write_text(text.replace(bed, f"{bed.replace('T_bed:', 'first:')}\n{bed}"))
    made = anew(folder)
    assert made["channels"]["T_bed"] == made["channels"]["first"]


def test_tests_that_somebody_added_stay_in_their_order(folder: Path) -> None:
    path = folder / "campaign.yaml"
    own = [f"  - {{id: {x}, kind: other, files: {{log: {x}.txt}}}}" for x in "cab"]
    path.write_text(path.read_text().replace("\n  - {id: S4000", "\n" + "\n".join(own) + "\n  - {id: S4000", 1))
    assert [t["id"] for t in anew(folder)["tests"]] == ["c", "a", "b", "S4000", "S8000", "gauge_50um"]


def test_notes_of_several_lines_leave_every_other_line_in_its_place(folder: Path) -> None:
    path = folder / "campaign.yaml"
    parts = [
        f"  - {{id: part{k}, kind: spindle, files: {{log: S8000.csv}}, window: [{k} h, {k + 0.9} h]}}" for k in (0, 1)
    ]
    (old,) = [x for x in path.read_text().splitlines() if "{id: S8000" in x]
    text = path.read_text().replace(old, "\n".join(parts))
    path.write_text(text.replace("{id: S4000,", '{id: S4000, notes: "one\\n\\ntwo: {3} # four\\n",', 1))
    made = {t["id"]: t for t in anew(folder)["tests"]}
    assert set(made) == {"S4000", "gauge_50um", "part0", "part1"}
    assert made["S4000"]["notes"] == "one\n\ntwo: {3} # four\n"
