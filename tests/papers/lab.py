"""Raw files of a lab, written from functions that are known, ingested and fitted by the commands."""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.cli import main
from thermodata.effect.lag import lag
from thermodata.plugin import Bool1D, Float1D
from thermodata.virtual.gantry.logs.nc import ZONE, write_export
from thermodata.virtual.gantry.logs.tdms import write_recording

Once = Callable[[str, Callable[[Path], object]], Path]  # the fixture `once`
STEP_S = 10.0
START_S = datetime(2026, 1, 12, 7, tzinfo=UTC).timestamp()
UM_PER_V = 40.0  # of the probes, which rest at 5 V
IDLE_S = 900.0


@dataclass(frozen=True)
class Logged:
    """A channel as it is logged. decimals: of the control's export; the cRIO logs what it reads."""

    values: Float1D
    unit: str
    source: str = "nc"
    decimals: int = 1


def grid(hours: float) -> Float1D:
    """[s]"""
    return np.arange(int(hours * 3600 / STEP_S)) * STEP_S


def levels(t: Float1D, steps: Sequence[tuple[float, float]]) -> Float1D:
    """steps: (hours from the end of idling, value from then on); 0 before."""
    out = np.zeros(len(t))
    for begin, value in steps:
        out[t >= IDLE_S + begin * 3600] = value
    return out


def hall_air(t: Float1D, seed: int, swing_k: float = 1.5) -> Float1D:
    """A day's swing from anywhere in it, and doors; relative to the start [K]."""
    rng = np.random.default_rng(seed)
    phase = rng.uniform(0, 2 * np.pi)
    doors = lag((rng.random(len(t)) < STEP_S / 7200) * -60.0, 900.0, STEP_S)
    day = swing_k * (np.sin(2 * np.pi * t / 86400 + phase) - np.sin(phase))
    return np.asarray(day + doors)


def moved_in(parts: Sequence[tuple[Float1D, Bool1D]]) -> Float1D:
    """What each moves while its phase lasts, one after the other without a step."""
    return np.asarray(sum(np.cumsum(np.where(where, np.diff(y, prepend=y[:1]), 0.0)) for y, where in parts))


def noisy(values: Float1D, seed: int, sd: float) -> Float1D:
    return np.asarray(values + np.random.default_rng(seed).normal(0, sd, len(values)))


def write_logs(folder: Path, test: str, day: int, channels: Mapping[str, Logged]) -> None:
    """One test: probes and Pt100 as TDMS, what the control knows as its export."""
    raw = folder / "raw"
    raw.mkdir(parents=True, exist_ok=True)
    start = START_S + 2 * 86400.0 * day
    daq = {f"Log/{n}": _as_logged(c) for n, c in channels.items() if c.source == "daq"}
    write_recording(raw / f"{test}.tdms", daq, start, STEP_S, {"test": test})
    nc = {n: (c.values, c.unit, c.decimals) for n, c in channels.items() if c.source == "nc"}
    if nc:
        write_export(raw / f"{test}.csv", nc, start, STEP_S)


def _as_logged(channel: Logged) -> tuple[Float1D, str]:
    if channel.unit == "um":
        return channel.values / UM_PER_V + 5.0, "V"
    return channel.values, channel.unit


SOURCES = f"""\
sources:
  daq: {{reader: crio, files: "raw/{{test}}.tdms"}}
  nc: {{reader: cnc, files: "raw/{{test}}.csv", timezone: {ZONE}}}
calibrations:
  probe_x: {{kind: scale, axis: X, gain: {UM_PER_V} um/V, facing: -X, increases_with: approach}}
  probe_y: {{kind: scale, axis: Y, gain: {UM_PER_V} um/V, facing: -Y, increases_with: approach}}
  probe_z: {{kind: scale, axis: Z, gain: {UM_PER_V} um/V, facing: -Z, increases_with: approach}}
"""


@dataclass(frozen=True)
class Lab:
    """A folder with a campaign that is ingested."""

    folder: Path

    def run(self, *words: object) -> str:
        """stdout of a command that has to succeed."""
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = main(["--store", str(self.folder / "thermodata.store"), *map(str, words)])
        assert code == 0, err.getvalue()
        return out.getvalue()

    def json(self, *words: object) -> Any:
        return json.loads(self.run(*words, "--json"))

    def model(self, name: str, campaign: str, text: str) -> Path:
        """A model file of this name."""
        path = self.folder / f"{name}.yaml"
        head = f"schema: thermodata/model/1\nname: {name}\ncampaign: {campaign}\nstep: 60 s\n"
        path.write_text(head + text, encoding="utf-8")
        return path


def make_lab(folder: Path, campaign: str, write: Callable[[Path], None]) -> Lab:
    """write: the raw files. campaign: the campaign file without its sources and calibrations of probes."""
    write(folder)
    (folder / "campaign.yaml").write_text(campaign + SOURCES, encoding="utf-8")
    lab = Lab(folder)
    lab.run("ingest", folder / "campaign.yaml")
    return lab


def made_once(once: Once, scratch: Path, name: str, campaign: str, write: Callable[[Path], None]) -> Lab:
    """A copy, in scratch, of the lab that the first test of the run makes: whoever asks may change his own."""
    shutil.copytree(once(name, lambda folder: make_lab(folder, campaign, write)), scratch / name)
    return Lab(scratch / name)


def value(fit: Mapping[str, Any], name: str) -> float:
    return float(fit["parameters"][name]["value"])
