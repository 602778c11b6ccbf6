"""A jump test finds its probe: one that reads a length, one under another head, one that another program recorded."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import yaml

from tests.commands import Say
from tests.draft.labs import START, numbers, staircase, tdms, text, warm
from thermodata.draft.make import draft_files

MOVES = "[50 um, 50 um, -100 um, -50 um, 50 um]"


def volts(um_per_v: float = 80.0) -> np.ndarray:
    return staircase([50, 50, -100, -50, 50], um_per_v, 8, 20, 3)


def lab(folder: Path, head: str = "Slow", unit: str = "V") -> None:
    for k in range(3):
        columns = {"Z1 tcp": (warm(2000, 5, 0.1, 0.3, k), unit), "T1": (warm(2000, 22, 5, 0.3, k), "degC")}
        tdms(folder / f"m{k}.tdms", {head: columns}, START, 10)


def calibrated(folder: Path, say: Say) -> dict[str, dict[str, object]]:
    """The drafted campaign, with the moves answered, ingested: name -> calibration."""
    path = folder / "campaign.yaml"
    path.write_text(path.read_text("utf-8").replace("moves: unknown", f"moves: {MOVES}"), "utf-8")
    said = say("--store", folder / "s", "ingest", path, "--json")
    assert said.code == 0, said.err
    summary = json.loads(said.out)
    assert not summary["losses"]
    return {c["name"]: c for c in summary["calibrations"]}


def test_a_jump_test_tells_the_sign_of_a_probe_that_reads_a_length(tmp_path: Path, say: Say) -> None:
    lab(tmp_path, "Slow", "um")
    tdms(tmp_path / "jump_Z.tdms", {"Slow": {"Z1 tcp": (volts(-1.0), "um")}}, START, 0.05)
    draft = draft_files(tmp_path).draft
    (probe,) = [c for c in draft.channels if c.said.quantity == "displacement"]
    assert (probe.calibration, probe.said.questions) == ("jump_Z1_tcp", ())
    assert "Z1_tcp has no values: without 'calibration' it has, its sign unknown" in draft.jumps[0].question
    assert not draft.not_used
    assert calibrated(tmp_path, say)["jump_Z1_tcp"]["gain"] == pytest.approx(-1, rel=0.01)


def test_groups_that_are_called_after_their_rates_hide_no_probe(tmp_path: Path, say: Say) -> None:
    lab(tmp_path)
    still = 5 + np.random.default_rng(0).normal(0, 0.002, len(volts()))
    tdms(tmp_path / "jump_Z.tdms", {"Fast": {"Z1 tcp": (volts(), "V"), "T1": (4 * still, "degC")}}, START, 0.05)
    draft = draft_files(tmp_path).draft
    assert [s.name for s in draft.sources] == ["daq"]
    assert [(c.signal, c.calibration) for c in draft.channels] == [("Slow/Z1 tcp", "jump_Z1_tcp"), ("Slow/T1", None)]
    assert [(j.source, j.signal) for j in draft.jumps] == [("daq", "Fast/Z1 tcp")]
    assert calibrated(tmp_path, say)["jump_Z1_tcp"]["gain"] == pytest.approx(80, rel=0.02)


def test_another_program_may_have_recorded_the_jump_test(tmp_path: Path, say: Say) -> None:
    lab(tmp_path)
    n = len(volts())
    header, columns = ["time [s]", "Z1 tcp [V]"], [numbers(np.arange(n) * 0.05, 2), numbers(volts(), 4)]
    text(tmp_path / "jump_Z.csv", header, columns, mark=",")
    draft = draft_files(tmp_path).draft
    (probe,) = [c for c in draft.channels if c.said.quantity == "displacement"]
    assert (probe.source, probe.calibration) == ("daq", "jump_Z1_tcp")
    (jump,) = draft.jumps
    assert (jump.source, jump.signal) == ("log", "Z1 tcp [V]")
    assert "files" not in yaml.safe_load((tmp_path / "campaign.yaml").read_text("utf-8"))["sources"]["log"]
    assert calibrated(tmp_path, say)["jump_Z1_tcp"]["gain"] == pytest.approx(80, rel=0.02)


def test_of_two_probes_of_one_name_none_is_chosen(tmp_path: Path) -> None:
    for k in range(3):
        groups = {head: {"Z1 tcp": (warm(2000, 5, 0.1, 0.3, k), "V")} for head in ("Left", "Right")}
        tdms(tmp_path / f"m{k}.tdms", groups, START, 10)
    tdms(tmp_path / "jump_Z.tdms", {"Fast": {"Z1 tcp": (volts(), "V")}}, START, 0.05)
    draft = draft_files(tmp_path).draft
    asked = [c for c in draft.channels if any("calibration?" in q for q in c.said.questions)]
    assert [c.signal for c in asked] == ["Left/Z1 tcp", "Right/Z1 tcp"]
    assert "no one displacement in the tests that is called so" in dict(draft.not_used)["jump_Z.tdms"]


@pytest.mark.parametrize(("many", "shown"), [(12, ""), (13, " ... (13 in all)")])
def test_steps_that_are_not_listed_are_counted(tmp_path: Path, many: int, shown: str) -> None:
    lab(tmp_path)
    steps = staircase([50, -50] * (many // 2) + [50] * (many % 2), 80, 8, 20, 3)
    tdms(tmp_path / "jump_Z.tdms", {"Slow": {"Z1 tcp": (steps, "V")}}, START, 0.05)
    (jump,) = draft_files(tmp_path).draft.jumps
    assert len(jump.seen) == many
    assert jump.question.endswith(f"{jump.seen[11]:+g}{shown} V")


def test_two_probes_along_one_axis_have_a_jump_test_each(tmp_path: Path) -> None:
    """Both answer whenever the axis moves, the upper one more: each file is of the probe that it is called after."""
    for k in range(3):
        columns = {n: (warm(2000, 5, 0.1, 0.3, k), "V") for n in ("Probe Y", "Probe Y oben", "Probe Z")}
        tdms(tmp_path / f"m{k}.tdms", {"Slow": columns}, START, 10)
    still = 5 + np.random.default_rng(0).normal(0, 0.002, len(volts()))
    moved = {"Probe Y": (volts(), "V"), "Probe Y oben": (volts(70.0), "V"), "Probe Z": (still, "V")}
    for called in ("d2", "dY"):
        tdms(tmp_path / f"jump_{called}.tdms", {"Slow": moved}, START, 0.05)
    rest = dict.fromkeys(("Probe Y", "Probe Y oben"), (still, "V"))
    tdms(tmp_path / "jump_dZ.tdms", {"Slow": {**rest, "Probe Z": (volts(), "V")}}, START, 0.05)
    draft = draft_files(tmp_path).draft
    assert {j.signal: Path(j.file).stem for j in draft.jumps} == {
        "Slow/Probe Y": "jump_dY",
        "Slow/Probe Y oben": "jump_d2",
        "Slow/Probe Z": "jump_dZ",
    }
    assert not draft.not_used


@pytest.mark.parametrize(("named", "unit"), [("jump_dZ_table", "V"), ("jump_dZ", None)])
def test_signals_that_nothing_tells_of_are_probes_by_their_jump_test(
    tmp_path: Path, named: str, unit: str | None
) -> None:
    """S1 in volts, or in nothing that a file says, is a displacement where it moves in steps in a file called jump."""
    for k in range(3):
        columns = {"S1": (warm(2000, 0.5, 0.1, 0.3, k), unit), "T1": (warm(2000, 22, 5, 0.3, k), "degC")}
        tdms(tmp_path / f"m{k}.tdms", {"Slow": columns}, START, 10)
    tdms(tmp_path / f"{named}.tdms", {"Slow": {"S1": (volts(), unit)}}, START, 0.05)
    draft = draft_files(tmp_path).draft
    (probe,) = [c for c in draft.channels if c.said.quantity == "displacement"]
    assert (probe.said.unit, probe.said.axis, probe.calibration) == (unit, "Z", "jump_Slow_S1")
    asked = [q.partition("?")[0] for q in probe.said.questions]
    own = ["at: tcp, or the table itself"] if "table" in named else ["unit: um, mm, m or V"]
    assert asked == [*own, f"axis: Z by {named}.tdms"]
    assert probe.said.at == (None if "table" in named else "tcp")
    assert [t.id for t in draft.tests] == ["m0", "m1", "m2"]
    assert draft.jumps[0].question.endswith(unit or "of a unit that is asked")
