"""What the whole command `thermodata fit` costs on 43 tests of 6 h: processor time as a user starts it.

    uv run --no-sync python tests/benchmarks/fit_command.py                            # logs as a lathe writes them
    uv run --no-sync python tests/benchmarks/fit_command.py --recording DATA.xlsx      # 43 windows of a real recording

The lathe's logs are those of joint_fit.py, a CSV each, ingested first; the model has a bearing and the hall's air. The
recording is that of tests/real/fl_thermal (46 h at 15 s), cut into 43 windows of 6 h; the model has its speed and t4.
Modules are compiled before the clock starts, and the figure is the median over runs of the time of user and system.
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
from pathlib import Path

import joint_fit
import numpy as np
from measure import PROGRAM, Run, machine, middle, run, table

HOURS = 6.0
GOAL_S = 2.0
LATHE = """schema: thermodata/campaign/1
id: lathe
machine: {id: lathe}
sources:
  log: {reader: table, files: "raw/{test}.csv", table: {time: {column: t, unit: s}}}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
  T_bearing: {source: log, signal: T_bearing, quantity: temperature, unit: degC, at: spindle.bearing.front}
  T_hall: {source: log, signal: T_hall, quantity: temperature, unit: degC, at: hall}
tests:
"""
RECORDING = """schema: thermodata/campaign/1
id: lathe
machine: {id: bench}
sources:
  log: {reader: table, files: DATA, table: {sheet: 1, header_rows: 1, time: {column: 1, unit: s}}}
channels:
  dZ: {source: log, signal: ch3, quantity: displacement, unit: um, axis: Z, at: tcp}
  speed: {source: log, signal: spindle, quantity: rotational_speed, unit: rpm, at: spindle}
  T_bearing: {source: log, signal: t4, quantity: temperature, unit: degC}
tests:
"""
MODEL = """schema: thermodata/model/1
name: bench
campaign: lathe
response: {axis: Z, at: tcp}
step: 60 s
effects:
"""


def lathe(folder: Path) -> str:
    """The campaign's folder, and the effects of its model."""
    (folder / "raw").mkdir()
    lines = []
    for k in range(joint_fit.SHORT):
        test = joint_fit.short(k)
        names = list(test.values)
        good = np.isfinite(test.values["dZ"])
        rows = np.column_stack([test.t_s, *(test.values[n] for n in names)])[good]
        with (folder / "raw" / f"s{k:02d}.csv").open("w") as file:
            np.savetxt(file, rows, fmt="%.4f", delimiter=",", header=",".join(["t", *names]), comments="")
        lines.append(f"  - {{id: s{k:02d}, kind: spindle, role: calibration}}\n")
    (folder / "campaign.yaml").write_text(LATHE + "".join(lines))
    return "  - {effect: spindle_bearing}\n  - {effect: ambient_frame}\n"


def recording(folder: Path, data: Path) -> str:
    """Windows that begin at even steps over the record."""
    starts = np.linspace(0.0, 46.3 - HOURS, joint_fit.SHORT)
    lines = [
        f"  - {{id: w{k:02d}, kind: spindle, role: calibration, window: [{a:.3f} h, {a + HOURS:.3f} h], "
        "history: recording}\n"
        for k, a in enumerate(starts)
    ]
    shutil.copy(data, folder)  # a link that leads outside is refused
    (folder / "campaign.yaml").write_text(RECORDING.replace("DATA", data.name) + "".join(lines))
    return "  - {effect: lag, id: a, drivers: {u: speed}}\n  - {effect: lag, id: b, drivers: {u: T_bearing}}\n"


def measured(folder: Path, effects: str, runs: int) -> Run:
    """Of `thermodata fit` on a store that holds the campaign."""
    (folder / "model.yaml").write_text(MODEL + effects)
    store = folder / "store"
    run([PROGRAM, "--store", store, "ingest", folder / "campaign.yaml", "--json"])
    command = [PROGRAM, "--store", store, "fit", folder / "model.yaml", "--json"]
    run(command)
    return middle([run(command) for _ in range(runs)])


def main() -> None:
    """Print a line a store."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--recording", type=Path, help="data.xlsx of fl_thermal, in place of the lathe's logs")
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a user's modules are compiled once
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        effects = lathe(folder) if given.recording is None else recording(folder, given.recording)
        done = measured(folder, effects, given.runs)
    print(machine())
    what = "logs of a lathe" if given.recording is None else "windows of a recording"
    row = [f"fit, {joint_fit.SHORT} {what}, {HOURS:g} h", f"{done.cpu_seconds:.2f}", f"{GOAL_S:g}"]
    print(
        table(
            ["command", "processor [s]", "goal [s]", "wall [s]", "peak RSS [MiB]"],
            [[*row, f"{done.seconds:.2f}", f"{done.peak_mib:.0f}"]],
        )
    )


if __name__ == "__main__":
    main()
