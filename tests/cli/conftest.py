from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from thermodata.cli import main

from ..commands import Said, Say

CAMPAIGN = """
schema: thermodata/campaign/1
id: small
machine: {id: "138", description: test machine}
sources: {log: {reader: table, files: "raw/{test}.csv"}}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp, calibration: probe}
  T_bearing: {source: log, signal: T_bearing, quantity: temperature, unit: degC, at: spindle.bearing.front}
  T_nut_Z: {source: log, signal: T_nut_Z, quantity: temperature, unit: degC, at: axis.z.nut}
  T_hall: {source: log, signal: T_hall, quantity: temperature, unit: degC, at: hall.bottom}
  spindle_speed: {source: log, signal: spindle_speed, quantity: rotational_speed, unit: rpm, at: spindle}
  feed_Z: {source: log, signal: feed_Z, quantity: feed, unit: m/min, at: axis.z}
calibrations:
  probe: {kind: scale, axis: Z, gain: 1 um/um, facing: -Z, increases_with: approach}
tests:
"""
MODEL = """
schema: thermodata/model/1
name: baseline
campaign: small
response: {axis: Z, at: tcp}
step: 60 s
effects:
  - {effect: spindle_bearing, drivers: {temperature: T_bearing}}
"""
TESTS = {"heat1": "calibration", "heat2": "calibration", "day1": "verification", "day2": "locked"}


def lag(u: np.ndarray, tau_s: float) -> np.ndarray:
    out, state, a = np.zeros_like(u), 0.0, np.exp(-60 / tau_s)
    for i, value in enumerate(u):
        state = a * state + (1 - a) * value
        out[i] = state
    return out


def write_campaign(folder: Path) -> Path:
    """Four tests of 6 h at 60 s, as CSV: growth by the bearing and, hidden from the model, by the nut."""
    (folder / "raw").mkdir(parents=True)
    lines = [CAMPAIGN.strip()]
    for i, (test, role) in enumerate(TESTS.items()):
        rng = np.random.default_rng(i)
        t_s = np.arange(360) * 60.0
        speed = 3000.0 * rng.integers(0, 4, 12).repeat(30) * (t_s > 1200)
        feed = 10.0 * rng.integers(0, 2, 12).repeat(30) * (t_s > 1200)
        bearing, nut = 15 * lag(speed / 9000, 1500.0), 6 * lag(feed / 10, 2400.0)
        hall = 21 + 0.4 * np.sin(t_s / 9000 + i)
        z = 2.0 * lag(bearing, 1800.0) + 3.0 * lag(nut, 2700.0) + rng.normal(0, 0.3, len(t_s))
        rows = np.column_stack([t_s, z, 21 + bearing, 21 + nut, hall, speed, feed])
        head = "time [s],dZ [um],T_bearing [degC],T_nut_Z [degC],T_hall [degC],spindle_speed [rpm],feed_Z [m/min]"
        np.savetxt(folder / "raw" / f"{test}.csv", rows, fmt="%.4f", delimiter=",", header=head, comments="")
        lines.append(f"  - {{id: {test}, kind: mixed, role: {role}, conditions: {{speed: 9000 rpm}}}}")
    (folder / "campaign.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "baseline.yaml").write_text(MODEL, encoding="utf-8")
    return folder / "campaign.yaml"


@pytest.fixture(scope="session")
def made_campaign(once: Callable[[str, Callable[[Path], object]], Path]) -> Path:
    """A campaign that is ingested into `thermodata.store` beside it, with its baseline fitted; read only."""

    def make(folder: Path) -> None:
        path = write_campaign(folder)
        assert main(["--store", str(folder / "thermodata.store"), "ingest", str(path), "--json"]) == 0
        assert main(["--store", str(folder / "thermodata.store"), "fit", str(folder / "baseline.yaml"), "--json"]) == 0

    return once("small", make)


@pytest.fixture(scope="session")
def campaign(made_campaign: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy for all tests of a process."""
    folder = tmp_path_factory.mktemp("small") / "lab"
    shutil.copytree(made_campaign, folder)
    return folder


@pytest.fixture
def own(made_campaign: Path, tmp_path: Path) -> Path:
    """A copy for one test."""
    shutil.copytree(made_campaign, tmp_path / "own")
    return tmp_path / "own"


@pytest.fixture
def ask(say: Say, campaign: Path) -> Say:
    """Runs a command on the campaign's store; it must succeed."""

    def run(*words: object) -> Said:
        said = say("--store", campaign / "thermodata.store", *words)
        assert said.code == 0, said.err
        return said

    return run
