"""The job shop's laboratory: a probe logged as LabVIEW text in V, thermocouples and the control's trace as CSV."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array, felt
from ..faults import slipped
from ..files import GERMAN, POINT, csv, document
from .machine import AT, T0
from .programme import DT_S, Run, wander


@dataclass(frozen=True)
class Sensor:
    """A channel: its place, its name in the file, of which bodies it is a mean (none: the control knows), its step."""

    at: str
    signal: str
    mix: str = ""
    step: float = 0.1
    quantity: str = "temperature"

    @property
    def source(self) -> str:
        return "tc" if self.step == 0.1 else "nc"


SENSORS: Mapping[str, Sensor] = {
    "T_brg": Sensor("spindle.bearing.front", "TC01 spindle brg", "bearing_front 0.75, head 0.25"),
    "T_hall": Sensor("hall", "TC02 hall", "mid 1"),
    "T_head": Sensor("headstock", "TC03 head", "head 1"),
    "T_nutZ": Sensor("axis.z.nut", "TC04 nut Z", "nut_z 0.85, head 0.15"),
    "T_nutY": Sensor("axis.y.nut", "TC05 nut Y", "nut_y 0.85, table 0.15"),
    "T_colR": Sensor("column.rear", "TC06 column back", "column_rear_high 0.6, column_rear_low 0.4"),
    "T_colF": Sensor("column.front", "TC07 column front", "column_front_high 0.6, column_front_low 0.4"),
    "T_airT": Sensor("hall.top", "TC08 air high", "top 1"),
    "T_airB": Sensor("hall.bottom", "TC09 air low", "low 1"),
    "T_cool": Sensor("coolant.tank", "TC10 coolant", "tank 1"),
    "T_fix": Sensor("probe", "TC11 probe bracket", "bracket 0.85, enclosure 0.15"),
    "T_guideZ": Sensor("axis.z.guide", "TC12 guide Z", "guide_z 1"),
    "T_cab": Sensor("cabinet", "TC13 cabinet", "cabinet 1"),
    "T_table": Sensor("table", "TC14 table", "table 1"),
    "T_mot": Sensor("spindle.motor", "S1_TempMot [Grd C]", "motor 1", 1.0),
    "T_motZ": Sensor("axis.z.motor", "Z_TempMot [Grd C]", "motor_z 1", 1.0),
    "speed_S": Sensor("spindle", "S1_nAct [U/min]", "", 1.0, "rotational_speed"),
    "pos_Z": Sensor("axis.z", "Z_pos [mm]", "", 0.001, "position"),
    "feed_Z": Sensor("axis.z", "Z_vAct [m/min]", "", 0.01, "feed"),
    "feed_Y": Sensor("axis.y", "Y_vAct [m/min]", "", 0.01, "feed"),
    "load_S": Sensor("spindle", "S1_load [%]", "", 1.0, "load"),
    "coolant_on": Sensor("coolant", "M8", "", 1.0, "state"),
}
TITLES = {
    "const": "spindle",
    "steps": "spectrum",
    "axis": "linear_axis",
    "idle": "etve",
    "cut": "cutting",
    "mixed": "mixed",
}
UNITS = {"temperature": "degC", "rotational_speed": "rpm", "feed": "m/min", "load": "%", "position": "mm"}
READERS = {"probe": ("crio", ".lvm"), "tc": ("table", "_tc.csv"), "nc": ("cnc", "_nc.csv")}
PARKED_MM = -210.0  # where the probe reads
FULL_V = 9.9985  # of the probe's amplifier


class Laboratory:
    """How the shop logs in one case: its probe is drawn, and in which test it slips where the logs have a fault."""

    def __init__(self, rng: np.random.Generator, folder: Path, axis: str, kind: str) -> None:
        self.rng, self.folder, self.axis, self.kind = rng, folder, axis, kind
        self.raw, self.signal = folder / "raw", f"Eddy{axis}"
        self.raw.mkdir(parents=True, exist_ok=True)
        self.jumps, self.sheet = bool(rng.random() < 0.6), bool(rng.random() < 0.35)
        self.gain = float(rng.uniform(0.04, 0.09) * rng.choice([-1, 1])) if self.jumps else 0.04  # [V/um]
        self.noise_um = rng.uniform(0.1, 0.25)
        self.bad = int(rng.integers(0, 6))

    def log(self, runs: Sequence[Run], temps: Array, move: Array, shown: Sequence[str]) -> str | None:
        """Write three logs a test and a jump test; returns what is wrong with them.

        temps: (time, body and layer, test) [degC]. move: (time, test) [um]. shown: channels beside the displacement.
        """
        fault = None
        for j, r in enumerate(runs):
            d = self._displacement(r, move[: len(r.moving), j])
            if self.kind == "fault" and j == self.bad:
                at, um = int(len(d) * self.rng.uniform(0.3, 0.7)), float(self.rng.uniform(4, 9))
                d, fault = slipped(d, um, at, DT_S, r.id)
            volts = np.where(r.moving, FULL_V, np.clip(2.0 + self.gain * d, -FULL_V, FULL_V))
            _lvm(self.raw / f"{r.id}.lvm", r.start, self.signal, volts, DT_S)
            self._tables(r, self._readings(r, temps[: len(d), :, j], shown))
        if self.jumps:
            moves = np.repeat([0, 100, 0, -100, 0], 60) + self.rng.normal(0, 2 * self.noise_um, 300)
            _lvm(self.raw / "jump.lvm", runs[0].start - timedelta(hours=1), self.signal, 2.0 + self.gain * moves, 0.25)
        return fault

    def _displacement(self, r: Run, move: Array) -> Array:
        rng, n = self.rng, len(move)
        d: Array = move - move[0] + rng.normal(0, self.noise_um, n) + 0.2 * wander(rng, n, 2400)
        if self.kind == "outside":  # the gib sticks: each time that the axes come to rest, the head rests elsewhere
            rests = np.diff(r.moving.astype(int), prepend=0) == -1
            d = d + np.cumsum(np.where(rests, rng.normal(0, 1.6, n), 0))
        return d

    def _readings(self, r: Run, temps: Array, shown: Sequence[str]) -> dict[str, Array]:
        """What stands in the logs of each channel."""
        rng, n, u = self.rng, len(temps), r.inputs
        cold = 0.12 * (temps[:, AT["mid"]] - T0)  # the logger's cold junction
        known = {
            "speed_S": u["speed"] + (u["speed"] > 0) * rng.normal(0, 2, n),
            "feed_Z": u["feed_z"],
            "feed_Y": u["feed_y"],
            "pos_Z": np.where(r.moving, -120 + 80 * np.sin(np.arange(n) * 2.1), PARKED_MM),
            "coolant_on": u["wet"],
            "load_S": np.clip(100 * u["load"] + rng.normal(0, 0.8, n), 0, None),
        }
        readings = {}
        for name in shown:
            s = SENSORS[name]
            x = felt(AT, s.mix, temps) if s.mix else known[name]
            x = x + (cold + rng.normal(0, 0.05, n) if s.source == "tc" else 0)
            readings[name] = np.round(np.round(x / s.step) * s.step, 3)
        return readings

    def _tables(self, r: Run, readings: Mapping[str, Array]) -> None:
        tc, nc = ([name for name in readings if SENSORS[name].source == source] for source in ("tc", "nc"))
        times = [r.start + timedelta(seconds=DT_S * k) for k in range(len(r.moving))]
        head = ["Datum Zeit" if self.sheet else "Time", *(f"{SENSORS[name].signal} [degC]" for name in tc)]
        form = GERMAN if self.sheet else POINT
        csv(self.raw / f"{r.id}_tc.csv", [head], times[::3], [readings[name][::3] for name in tc], form, 1)
        head = ["Zeit", *(SENSORS[name].signal for name in nc)]
        csv(self.raw / f"{r.id}_nc.csv", [head], times, [readings[name] for name in nc])

    def campaign(self, case: int, runs: Sequence[Run], shown: Sequence[str]) -> None:
        """Write campaign.yaml."""
        displacement = {
            "source": "probe",
            "signal": self.signal,
            "quantity": "displacement",
            "unit": "V",
            "axis": self.axis,
            "at": "tcp",
            "relative_to": "table",
            "calibration": "probe",
        }
        still = f"abs(pos_Z + {-PARKED_MM:.0f}) < 0.05"
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": f"mill-{case:02d}",
            "sources": {
                source: {"reader": reader, "files": "raw/{test}" + end, "timezone": "Europe/Prague"}
                for source, (reader, end) in READERS.items()
            },
            "channels": {f"d{self.axis}": displacement, **{name: _channel(SENSORS[name]) for name in shown}},
            "machine": {"id": f"M{case}", "description": "vertical C-frame mill"},
            "calibrations": {"probe": self._calibration()},
            "tests": [
                {"id": r.id, "kind": TITLES[r.kind], "role": r.role} | ({"measuring": still} if r.moving.any() else {})
                for r in runs
            ],
        }
        document(self.folder / "campaign.yaml", campaign)

    def _calibration(self) -> dict[str, Any]:
        if not self.jumps:
            facing = {"facing": f"+{self.axis}", "increases_with": "gap"}
            return {"kind": "scale", "axis": self.axis, "gain": "25 um/V", **facing}
        return {
            "kind": "jump",
            "axis": self.axis,
            "source": "probe",
            "file": "raw/jump.lvm",
            "signal": self.signal,
            "dwell": "15 s",
            "moves": ["100 um", "-100 um", "-100 um", "100 um"],
        }


def _channel(s: Sensor) -> dict[str, str]:
    unit = {"unit": UNITS[s.quantity]} if s.quantity in UNITS else {}
    return {"source": s.source, "signal": s.signal.split(" [")[0], "quantity": s.quantity, "at": s.at} | unit


def _lvm(path: Path, start: datetime, signal: str, volts: Array, dt_s: float) -> None:
    """A LabVIEW text file of one channel."""
    head = [
        "LabVIEW Measurement\t",
        "Writer_Version\t2",
        "Separator\tTab",
        "Decimal_Separator\t.",
        "Multi_Headings\tNo",
        "X_Columns\tOne",
        "Time_Pref\tAbsolute",
        f"Date\t{start:%Y/%m/%d}",
        f"Time\t{start:%H:%M:%S},0",
        "***End_of_Header***\t",
        "",
        "Channels\t1",
        f"Samples\t{len(volts)}",
        "Y_Unit_Label\tV",
        "X0\t0.0",
        f"Delta_X\t{dt_s}",
        "***End_of_Header***\t",
        f"X_Value\t{signal}\tComment",
    ]
    path.write_text("\n".join([*head, *(f"{k * dt_s:.3f}\t{v:.4f}" for k, v in enumerate(volts))]) + "\n")
