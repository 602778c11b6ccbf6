"""A laboratory: probe and Pt100s as a cRIO's CSV in UTC, the control's CSV in another zone's time, and a jump test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np

from ..bodies import Array, felt
from ..faults import behind, come_loose, slipped
from ..files import Form, csv, document
from ..sensors import UNITS, Sensor, of_log
from .machine import AT
from .programme import DT_S, Run
from .sensors import SENSORS

TITLES = {
    "const": "spindle",
    "spec": "spectrum",
    "axes": "linear_axis",
    "rot": "rotary_axis",
    "idle": "etve",
    "cut": "cutting",
    "dry": "cutting",
    "prod": "mixed",
}
MOVES_UM = (50, 50, -100, -50, 50)  # of the jump test
JUMP_DT_S = 0.1
FAULTS = ("slip", "clock", "loose")
CRIO = Form(",", ".", "%Y-%m-%dT%H:%M:%S.%f", cut=3)
CONTROL = Form(";", ",", "%d.%m.%Y;%H:%M:%S")


class Laboratory:
    """How the laboratory logs in one case: zone, probe, rate and offsets are drawn, and in which test a fault would be.

    mean_degc: of the hall. shown: channels beside the displacement.
    """

    def __init__(
        self,
        rng: np.random.Generator,
        folder: Path,
        axis: str,
        kind: str,
        case: int,
        mean_degc: float,
        shown: list[str],
    ) -> None:
        self.rng, self.folder, self.axis, self.kind, self.case, self.shown = rng, folder, axis, kind, case, shown
        self.raw, self.probe = folder / "raw", f"AI31_Eddy_{axis}"
        self.raw.mkdir(parents=True, exist_ok=True)
        self.zone = str(rng.choice(["Europe/Prague", "Asia/Tokyo", "America/Chicago"]))
        self.volts = bool(rng.random() < 0.65)
        self.noise_um = float(rng.uniform(0.08, 0.25))
        self.tick_s = float(rng.choice([15, 20, 30]))
        self.gain = float(rng.uniform(0.03, 0.07) * rng.choice([-1, 1]))  # [V/um]
        self.mean_degc, self.offsets = mean_degc, {name: float(rng.normal(0, 0.15)) for name in shown}
        self.bad = int(rng.integers(0, 3))
        self.wrong = FAULTS[case // 24 % 3] if kind == "fault" else None

    def log(self, runs: Sequence[Run], states: Sequence[tuple[Array, Array]], move: Sequence[Array]) -> str | None:
        """Write two logs a test and a jump test; returns what is wrong with them.

        states: temperatures (time, node) above the hall's mean [K] and compressor of each test.
        move: displacement of each (time,) [um].
        """
        faults = []
        for j, (r, (temps, chills)) in enumerate(zip(runs, states, strict=True)):
            wrong = self.wrong if j == self.bad else None
            known = self._known(r, chills)
            at = int(r.steps * self.rng.uniform(0.3, 0.6))
            d, slip = self._displacement(r, move[j], at, wrong == "slip")
            readings, loose = self._readings(r, temps, known, at, wrong == "loose")
            self._crio(r, d, readings)
            self._control(r, readings, timedelta(minutes=-35 if wrong == "clock" else 0))
            late = behind(35, r.id) if wrong == "clock" else None
            faults += [fault for fault in (slip, loose, late) if fault]
        if self.volts:
            level = np.repeat(np.cumsum([0, *MOVES_UM]), 120)
            um = level + self.rng.normal(0, self.noise_um, len(level))
            start = runs[0].start - timedelta(hours=2)
            self._table("jump", start, JUMP_DT_S, {self.probe: 5 + self.gain * um})
        return faults[-1] if faults else None

    def _known(self, r: Run, chills: Array) -> dict[str, Array]:
        """What the control knows."""
        u = r.inputs
        load = np.where(u["speed"] > 0, 4 + 14 * u["speed"] ** 1.5 + 75 * u["cut"], 0)
        load *= self.rng.uniform(0.97, 1.03, r.steps)
        return {
            "n_sp": 18000 * u["speed"],
            "n_B": 50 * u["rotary"],
            "v_X": u["feed_x"],
            "v_Y": u["feed_y"],
            "v_Z": u["feed_z"],
            "P_sp": 0.3 * load,
            "load_sp": load,
            "cool_on": u["coolant"],
            "hyd_on": u["hydraulics"],
            "chill_on": chills,
        }

    def _displacement(self, r: Run, move: Array, at: int, slips: bool) -> tuple[Array, str | None]:
        """With what no cause explains, a value each minute. at: where the probe slips if it does."""
        rng, n = self.rng, r.steps
        stray = np.cumsum(rng.normal(0, 0.012, n))
        clamped = int(rng.exponential(90))
        while self.kind == "outside" and clamped < n:  # a clamped joint creeps after each clamping, never alike
            stray[clamped:] += rng.normal(0, 1.6) * np.log1p(np.arange(n - clamped) / 6)
            clamped += int(rng.exponential(200)) + 20
        d = move + stray
        if not slips:
            return d, None
        return slipped(d, float(rng.uniform(4, 9)), at, DT_S, r.id)

    def _readings(
        self, r: Run, temps: Array, known: Mapping[str, Array], at: int, comes_loose: bool
    ) -> tuple[dict[str, Array], str | None]:
        """What stands in the logs of each channel. at: where the bearing's sensor comes loose if it does."""
        rng, ticks, minutes, fault = self.rng, self._ticks(r), np.arange(r.steps), None
        readings = {}
        for name in self.shown:
            s = SENSORS[name]
            x = felt(AT, s.mix, temps) + (self.mean_degc + self.offsets[name]) if s.mix else known[name]
            if comes_loose and name == "T_brg_f":
                x, fault = come_loose(x, self.mean_degc + temps[:, AT["mid"]], at, DT_S, name, r.id)
            x = np.interp(ticks, minutes, x) if s.log == "crio" else x
            grain = rng.normal(0, 0.4 * s.step, len(x))
            readings[name] = np.round((x + grain * bool(s.mix)) / s.step) * s.step
        return readings, fault

    def _ticks(self, r: Run) -> Array:
        """When the cRIO samples [min]."""
        return np.arange(0, (r.steps - 1) * DT_S + 1e-6, self.tick_s) / DT_S

    def _crio(self, r: Run, d: Array, readings: Mapping[str, Array]) -> None:
        ticks, rng = self._ticks(r), self.rng
        um = np.interp(ticks, np.arange(r.steps), d) + rng.normal(0, self.noise_um, len(ticks))
        probe = 5 + self.gain * um if self.volts else um + rng.uniform(-40, 40)
        pt100 = {SENSORS[name].signal: readings[name] for name in of_log("crio", readings, SENSORS)}
        self._table(r.id, r.start, self.tick_s, {self.probe: probe, **pt100})

    def _table(self, name: str, start: datetime, dt_s: float, signals: Mapping[str, Array]) -> None:
        columns = list(signals.values())
        times = [start + timedelta(seconds=k * dt_s) for k in range(len(columns[0]))]
        csv(self.raw / f"{name}_crio.csv", [["Timestamp UTC", *signals]], times, columns, CRIO, 4)

    def _control(self, r: Run, readings: Mapping[str, Array], off: timedelta) -> None:
        nc, zone = of_log("nc", readings, SENSORS), ZoneInfo(self.zone)
        times = [(r.start + off + timedelta(seconds=k * DT_S)).astimezone(zone) for k in range(r.steps)]
        head = ["Datum", "Zeit", *(_column(SENSORS[name]) for name in nc)]
        csv(self.raw / f"{r.id}_nc.csv", [head], times, [readings[name] for name in nc], CONTROL, 2)

    def campaign(self, runs: Sequence[Run]) -> None:
        """Write campaign.yaml."""
        displacement = {
            "source": "crio",
            "signal": self.probe,
            "quantity": "displacement",
            "unit": "V" if self.volts else "um",
            "axis": self.axis,
            "at": "tcp",
        }
        jump = {
            "kind": "jump",
            "axis": self.axis,
            "source": "crio",
            "file": "raw/jump_crio.csv",
            "signal": self.probe,
            "dwell": "12 s",
            "moves": [f"{um} um" for um in MOVES_UM],
        }
        calibration = {"calibration": "jump"} if self.volts else {}
        channels = {name: _channel(SENSORS[name]) for name in self.shown}
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": f"hmill-{self.case:02d}",
            "machine": {"id": f"HM{self.case}", "description": "bed mill"},
            "sources": {
                "crio": {"reader": "table", "files": "raw/{test}_crio.csv", "timezone": "UTC"},
                "nc": {"reader": "cnc", "files": "raw/{test}_nc.csv", "timezone": self.zone},
            },
            "channels": {f"d{self.axis}": displacement | calibration, **channels},
            "calibrations": {"jump": jump} if self.volts else {},
            "tests": [{"id": r.id, "kind": TITLES[r.kind], "role": r.role} for r in runs],
        }
        document(self.folder / "campaign.yaml", campaign)


def _column(s: Sensor) -> str:
    """Its name with its unit, as it stands in the head of the control's export."""
    return s.signal if s.quantity == "state" else f"{s.signal} [{UNITS[s.quantity]}]"


def _channel(s: Sensor) -> dict[str, str]:
    return {"source": s.log, "signal": s.signal, "quantity": s.quantity, "at": s.at, "unit": UNITS[s.quantity]}
