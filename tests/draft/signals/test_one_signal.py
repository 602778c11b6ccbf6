"""A signal whose unit stands in its name is one channel, though a test was logged in another unit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import numbers, text
from thermodata.draft.make import draft_files


def logs(folder: Path, headers: Sequence[str], factors: Sequence[tuple[float, float]]) -> None:
    """A test for each header, of a bearing that warms from 20 to 30 degC; factors: to the unit of the header."""
    t = np.arange(300) * 10.0
    for k, (header, (factor, offset)) in enumerate(zip(headers, factors, strict=True), 1):
        columns = [numbers(t, 0), numbers((20 + t / 299) * factor + offset, 3), numbers(20 + t / 9000, 2)]
        text(folder / f"run_{k}.csv", ["t [s]", header, "Hall air [degC]"], columns, mark=",")


def test_degrees_of_both_kinds_are_one_channel(tmp_path: Path, say: Say) -> None:
    logs(tmp_path, ["101 <Front brg> (C)", "101 <Front brg> (F)", "101 <Front brg> (C)"], [(1, 0), (1.8, 32), (1, 0)])
    draft = draft_files(tmp_path).draft
    (bearing,) = [c for c in draft.channels if c.said.at == "spindle.bearing.front"]
    assert (bearing.signal, bearing.said.unit, bearing.only_in) == ("101 <Front brg>", None, ())
    assert bearing.said.questions == ("unit: the files disagree: C (2), F (1); each file's own is taken",)
    assert say("--store", tmp_path / "s", "ingest", tmp_path / "campaign.yaml").code == 0
    found = say(
        "--store",
        tmp_path / "s",
        "sql",
        f"select max(value) from sample where channel = '{bearing.name}' group by test",
        "--csv",
    ).out.split()[1:]
    assert [float(v) for v in found] == pytest.approx([30, 30, 30], abs=0.1)


def test_values_are_looked_at_in_the_unit_of_their_own_file(tmp_path: Path) -> None:
    t = np.arange(100) * 10.0
    for k, (unit, size) in enumerate((("mm", 0.001), ("mm", 0.001), ("um", 1.0)), 1):
        text(tmp_path / f"run_{k}.csv", ["t [s]", f"dZ [{unit}]"], [numbers(t, 0), numbers(t * size / 50, 4)], mark=",")
    (probe,) = draft_files(tmp_path).draft.channels
    assert probe.said.questions[0] == "unit: the files disagree: mm (2), um (1); each file's own is taken"


@pytest.mark.parametrize("header", ["Spindle (%)", "Rear brg (C)"])
def test_another_quantity_or_place_is_another_channel(tmp_path: Path, header: str) -> None:
    logs(tmp_path, ["Spindle (A)", header, "Spindle (A)"], [(1, 0)] * 3)
    assert len([c for c in draft_files(tmp_path).draft.channels if "air" not in c.signal]) == 2


def test_two_columns_of_one_file_are_two_channels(tmp_path: Path) -> None:
    t = np.arange(100) * 10.0
    for k in (1, 2):
        header = ["t [s]", "Front brg (C)", "Front brg (F)"]
        text(tmp_path / f"run_{k}.csv", header, [numbers(t, 0), numbers(20 + t / 99, 2), numbers(68 + t / 55, 2)])
    assert len(draft_files(tmp_path).draft.channels) == 2


def test_a_head_that_only_some_files_have_makes_no_second_channel(tmp_path: Path) -> None:
    logs(tmp_path, ["mc/Front brg (C)", "Front brg (C)", "Front brg (C)"], [(1, 0)] * 3)
    (bearing,) = [c for c in draft_files(tmp_path).draft.channels if c.said.at == "spindle.bearing.front"]
    assert (bearing.signal, bearing.only_in) == ("Front brg", ())


def test_heads_that_tell_columns_of_one_file_apart_stay(tmp_path: Path) -> None:
    t = np.arange(300) * 10.0
    warm = [numbers(t, 0), numbers(20 + t / 299, 3), numbers(21 + t / 299, 3)]
    text(tmp_path / "run_1.csv", ["t [s]", "left/Front brg (C)", "right/Front brg (C)"], warm, mark=",")
    text(tmp_path / "run_2.csv", ["t [s]", "Front brg (C)", "Hall air [degC]"], warm, mark=",")
    names = [c.signal for c in draft_files(tmp_path).draft.channels if "air" not in c.signal]
    assert names == ["left/Front brg (C)", "right/Front brg (C)", "Front brg (C)"]


def test_a_statistic_is_called_by_the_name_above_it(tmp_path: Path) -> None:
    t = np.arange(300) * 10.0
    warm = [numbers(t, 0), numbers(20 + t / 299, 3), numbers(21 + t / 299, 3)]
    text(tmp_path / "run.csv", ["t [s]", "BRG_FRONT/Min [degC]", "Eddy Z/AVE (µm)"], warm, mark=",")
    assert [c.name for c in draft_files(tmp_path).draft.channels] == ["BRG_FRONT_Min", "Eddy_Z_AVE"]


def test_heads_that_differ_make_two_channels(tmp_path: Path) -> None:
    """Two tests, each with a sensor of its own: nothing says that they are one."""
    logs(tmp_path, ["spindle/T (C)", "column/T (C)"], [(1, 0)] * 2)
    made = [c for c in draft_files(tmp_path).draft.channels if "Hall" not in c.signal]
    assert [(c.signal, list(c.only_in)) for c in made] == [("spindle/T (C)", ["run_1"]), ("column/T (C)", ["run_2"])]


@pytest.mark.parametrize(
    ("headers", "kind"),
    [(["Ambient (°C)", "Ambient"], "temperature"), (["Ambient", "Ambient (°C)", "Ambient"], "temperature")],
)
def test_a_name_with_and_without_its_unit_is_one_channel(
    tmp_path: Path, say: Say, headers: list[str], kind: str
) -> None:
    t = np.arange(300) * 10.0
    for k, header in enumerate(headers, 1):
        columns = [numbers(t, 0), numbers(20 + t / 9000, 2), numbers(t / 3000, 4)]
        text(tmp_path / f"run_{k}.csv", ["t [s]", header, "dZ [um]"], columns, mark=",")
    (hall, _) = sorted(draft_files(tmp_path).draft.channels, key=lambda c: c.said.quantity != kind)
    assert (hall.name, hall.signal, hall.said.unit, hall.only_in) == ("Ambient", "Ambient", "°C", ())
    said = "°C (1), none (1)" if len(headers) == 2 else "none (2), °C (1)"
    assert hall.said.questions == (f"unit: °C in all files? they say {said}",)
    assert say("--store", tmp_path / "s", "ingest", tmp_path / "campaign.yaml").code == 0
    asked = f"select test, count(*), max(value) from sample where channel = '{hall.name}' group by test order by test"
    rows = say("--store", tmp_path / "s", "sql", asked, "--csv").out.split()[1:]
    assert [r.split(",")[1:] for r in rows] == [["300", "20.33"]] * len(headers)


def test_a_name_without_a_unit_that_is_another_quantity_is_another_channel(tmp_path: Path) -> None:
    t = np.arange(300) * 10.0
    for k, (header, values) in enumerate((("Spindle (A)", 5 + t / 3000), ("Spindle", 20 + t / 900)), 1):
        text(tmp_path / f"run_{k}.csv", ["t [s]", header], [numbers(t, 0), numbers(values, 2)], mark=",")
    found = [(c.signal, c.only_in) for c in draft_files(tmp_path).draft.channels]
    assert found == [("Spindle (A)", ("run_1",)), ("Spindle", ("run_2",))]
