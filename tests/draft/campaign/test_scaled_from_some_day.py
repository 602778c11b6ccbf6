"""A probe that is logged in volts in some tests and in micrometres in others: the draft takes the calibration of the
volts out of the others, and each test has the displacement that its log says."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import START, Float1D, staircase, tdms, warm

UM_PER_V = 50.0
RISE_UM = 30.0


def _write(path: Path, day: float, probe: Float1D, unit: str) -> None:
    tdms(path, {"g": {"dZ": (probe, unit), "T_bed": (warm(len(probe), 20, 3, 0.3, 1), "degC")}}, _at(day), 1.0)


def _at(day: float) -> datetime:
    return START + timedelta(days=day)


def _folder(folder: Path, units: str) -> None:
    """A test a letter: volts or micrometres of the same displacement. And the jump test, in volts."""
    growth = warm(4000, 0, RISE_UM, 0.3, 7)
    for day, letter in enumerate(units):
        probe, unit = (growth / UM_PER_V + 5, "V") if letter == "V" else (growth, "um")
        _write(folder / f"P{day}.tdms", day, probe, unit)
    _write(folder / "jump_Z.tdms", -0.5, staircase([100, -100], UM_PER_V, 30, 1.0, 3), "V")


def _answered(folder: Path, say: Say) -> str:
    assert say("init", folder).code == 0
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    text = text.replace("moves: unknown", "moves: [100 um, -100 um]").replace("id: unknown", "id: m1")
    (folder / "campaign.yaml").write_text(text, encoding="utf-8")
    return text


def _risen(folder: Path, say: Say) -> dict[str, tuple[float, str]]:
    """Test -> (how far the end is from the beginning [um], the sign of the channel)."""
    query = (
        "select s.test, median(value) filter (t_s > 3800) - median(value) filter (t_s < 100), any_value(c.sign) "
        "from sample s join channel c using (campaign, test, channel) where channel = 'g_dZ' group by s.test"
    )
    said = say("--store", folder / "store", "sql", query, "--csv")
    assert said.code == 0, said.err
    rows = [line.split(",") for line in said.out.splitlines()[1:]]
    return {test: (float(value), sign) for test, value, sign in rows}


@pytest.mark.parametrize("units", ["VVuu", "uuV", "uu"])
def test_micrometres_are_taken_as_they_stand_beside_volts(tmp_path: Path, say: Say, units: str) -> None:
    _folder(tmp_path, units)
    text = _answered(tmp_path, say)
    lines = [line for line in text.splitlines() if "channels: {g_dZ: {calibration: []}}" in line]
    assert len(lines) == units.count("u")
    assert all("g_dZ is in um here" in line and "which way does it count?" in line for line in lines)
    said = say("--store", tmp_path / "store", "ingest", tmp_path / "campaign.yaml")
    assert "losses" not in said.out
    risen = _risen(tmp_path, say)
    wanted = {f"P{day}": "+" if letter == "V" else "unknown" for day, letter in enumerate(units)}
    assert {test: sign for test, (_, sign) in risen.items()} == wanted
    assert np.allclose([abs(um) for um, _ in risen.values()], RISE_UM, rtol=0.1)


def test_one_unit_in_all_tests_needs_nothing_of_its_own(tmp_path: Path, say: Say) -> None:
    _folder(tmp_path, "VVV")
    assert "channels: {g_dZ" not in _answered(tmp_path, say)


def test_a_calibration_of_volts_for_micrometres_is_told_with_what_takes_them(tmp_path: Path, say: Say) -> None:
    _folder(tmp_path, "VVu")
    text = _answered(tmp_path, say).replace(", channels: {g_dZ: {calibration: []}}", "")
    (tmp_path / "campaign.yaml").write_text(text, encoding="utf-8")
    said = say("--store", tmp_path / "store", "ingest", tmp_path / "campaign.yaml")
    assert "in each test whose log has it in um, channels: {g_dZ: {calibration: []}} takes it as it stands" in said.out
    assert "declare the channel's unit" not in said.out
