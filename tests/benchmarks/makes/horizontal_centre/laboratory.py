"""A research laboratory: probe in V and Pt100s as TDMS, the control's CSV, the hall's workbook, and a jump test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from nptdms import ChannelObject, RootObject, TdmsWriter

from ..bodies import Array, felt
from ..faults import behind, come_loose, slipped
from ..files import csv, document, workbook
from ..sensors import of_log
from .machine import AT
from .programme import DT_S, Run, wander
from .sensors import SENSORS, UNITS, Sensor

TITLES = {"const": "spindle", "repeat": "spindle", "axes": "linear_axis", "table": "rotary_axis"}
MOVING = ("axes", "table", "cutting", "mixed")
MOVES_UM = (100, 50, -200, -50, 100)  # of the jump test
FULL_V = 9.99  # of the probe's amplifier
FAULTS = ("clock", "loose", "slip")


class Laboratory:
    """How the laboratory logs in one case: its probe is drawn, and in which test a fault would be."""

    def __init__(self, rng: np.random.Generator, folder: Path, axis: str, kind: str, case: int) -> None:
        self.rng, self.folder, self.axis, self.kind, self.case = rng, folder, axis, kind, case
        self.raw, self.probe = folder / "raw", f"Sondy/S1 {axis}"
        self.raw.mkdir(parents=True, exist_ok=True)
        self.gain = float(rng.uniform(0.02, 0.05) * rng.choice([-1, 1]))  # [V/um]
        self.noise_um = rng.uniform(0.08, 0.25)
        self.bad = int(rng.integers(0, 3))
        self.wrong = FAULTS[case // 24 % 3] if kind == "fault" else None

    def log(self, runs: Sequence[Run], temps: Array, move: Array, shown: Sequence[str]) -> str | None:
        """Write three logs a test and a jump test; returns what is wrong with them.

        temps: (time, body and layer, test) [degC]. move: (time, test) [um]. shown: channels beside the displacement.
        """
        faults = []
        for j, r in enumerate(runs):
            n = len(r.logged["speed"])
            wrong = self.wrong if j == self.bad else None
            d, slip = self._displacement(r, move[:n, j], wrong == "slip")
            readings, loose = self._readings(r, temps[:n, :, j], shown, wrong == "loose")
            self._daq(r, d, readings)
            self._control(r, readings, timedelta(minutes=-25 if wrong == "clock" else 0))
            self._hall(r, readings)
            late = behind(25, r.id) if wrong == "clock" else None
            faults += [fault for fault in (slip, loose, late) if fault]
        level = np.repeat(np.cumsum([0, *MOVES_UM]), 120)
        volts = 5 + self.gain * level + self.rng.normal(0, 2e-3, len(level))
        _tdms(self.raw / "jump.tdms", runs[0].start - timedelta(hours=2), 0.1, {self.probe: ("V", volts)})
        return faults[-1] if faults else None

    def _displacement(self, r: Run, move: Array, slips: bool) -> tuple[Array, str | None]:
        rng, n = self.rng, len(move)
        d = move - move[0] + rng.normal(0, self.noise_um, n) + 0.2 * wander(rng, n, 3600)
        if self.kind == "outside":  # each tool change seats the taper elsewhere
            seated = rng.random(n) < DT_S / 3600
            d = d + np.cumsum(seated * rng.normal(0, 3.0, n)) * (r.kind in ("mixed", "cutting", "spectrum"))
        if not slips:
            return d, None
        at, um = int(n * rng.uniform(0.3, 0.7)), float(rng.uniform(4, 9))
        return slipped(d, um, at, DT_S, r.id)

    def _readings(
        self, r: Run, temps: Array, shown: Sequence[str], comes_loose: bool
    ) -> tuple[dict[str, Array], str | None]:
        """What stands in the logs of each channel."""
        rng, u, n, fault = self.rng, r.logged, len(temps), None
        known = {
            "speed": u["speed"] + (u["speed"] > 0) * rng.normal(0, 1, n),
            "feed_Z": u["feed_z"],
            "feed_Y": u["feed_y"],
            "speed_table": u["table"],
            "power": (u["speed"] > 0)
            * (0.15 + 0.12 * (u["speed"] / 1000) ** 1.3 + u["load"] * rng.uniform(0.97, 1.03, n)),
            "coolant_on": u["wet"],
            "G_window": u["sun"] + rng.normal(0, 3, n) * (u["sun"] > 0),
        }
        readings = {}
        for name in shown:
            s = SENSORS[name]
            x = felt(AT, s.mix, temps) if s.mix else known[name]
            if comes_loose and name == "T_bearing":
                x, fault = come_loose(x, temps[:, AT["mid"]], int(n * 0.3), DT_S, name, r.id)
            grain = 0.4 * s.step * (s.quantity == "temperature")
            readings[name] = np.round((x + rng.normal(0, grain, n)) / s.step) * s.step
        return readings, fault

    def _daq(self, r: Run, d: Array, readings: Mapping[str, Array]) -> None:
        u, n = r.logged, len(d)
        moving = (u["feed_z"] + u["feed_y"] + u["table"]) > 0
        volts = np.where(moving, FULL_V, np.clip(5 + self.gain * d, 0, FULL_V)) + self.rng.normal(0, 1e-4, n)
        pt100 = {SENSORS[name].signal: ("degC", readings[name]) for name in of_log("daq", readings, SENSORS)}
        _tdms(self.raw / f"{r.id}.tdms", r.start, DT_S, {self.probe: ("V", volts), **pt100})

    def _control(self, r: Run, readings: Mapping[str, Array], off: timedelta) -> None:
        nc = of_log("nc", readings, SENSORS)
        heads = [
            ["Datum a čas", *(SENSORS[name].signal for name in nc)],
            ["", *(UNITS[SENSORS[name].quantity] for name in nc)],
        ]
        times = [r.start + off + timedelta(seconds=k * DT_S) for k in range(len(r.logged["speed"]))]
        csv(self.raw / f"{r.id}.csv", heads, times, [readings[name] for name in nc])

    def _hall(self, r: Run, readings: Mapping[str, Array]) -> None:
        hall = of_log("hall", readings, SENSORS)
        rows = (
            [r.start + timedelta(seconds=k * DT_S), *(round(float(readings[name][k]), 2) for name in hall)]
            for k in range(0, len(r.logged["speed"]), 2)
        )
        workbook(self.raw / f"{r.id}.xlsx", "hala", ["čas", *(SENSORS[name].column for name in hall)], rows)

    def campaign(self, runs: Sequence[Run], shown: Sequence[str]) -> None:
        """Write campaign.yaml."""
        displacement = {
            "source": "daq",
            "signal": self.probe,
            "quantity": "displacement",
            "unit": "V",
            "axis": self.axis,
            "at": "tcp",
            "calibration": "jump",
        }
        jump = {
            "kind": "jump",
            "axis": self.axis,
            "source": "daq",
            "file": "raw/jump.tdms",
            "signal": self.probe,
            "moves": [f"{um} um" for um in MOVES_UM],
            "dwell": "12 s",
            "move_uncertainty": "0.5 um",
        }
        still = "feed_Z == 0 and feed_Y == 0" + (" and speed_table == 0" if "speed_table" in shown else "")
        zone = {"timezone": "Europe/Prague"}
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": f"hmc-{self.case:02d}",
            "machine": {
                "id": f"HMC{self.case:02d}",
                "description": "horizontal milling centre with ram and turning table",
            },
            "sources": {
                "daq": {"reader": "crio", "files": "raw/{test}.tdms"},
                "nc": {"reader": "cnc", "files": "raw/{test}.csv", **zone, "encoding": "cp1250"},
                "hall": {"reader": "table", "files": "raw/{test}.xlsx", **zone},
            },
            "channels": {f"d{self.axis}": displacement, **{name: _channel(SENSORS[name]) for name in shown}},
            "calibrations": {"jump": jump},
            "tests": [
                {"id": r.id, "kind": TITLES.get(r.kind, r.kind), "role": r.role}
                | ({"measuring": still} if r.kind in MOVING else {})
                for r in runs
            ],
        }
        document(self.folder / "campaign.yaml", campaign)


def _channel(s: Sensor) -> dict[str, str]:
    return {"source": s.log, "signal": s.column, "quantity": s.quantity, "at": s.at}


def _tdms(path: Path, start: datetime, dt_s: float, signals: Mapping[str, tuple[str, Array]]) -> None:
    """One TDMS file of signals (group/name: unit, values) that begin at start (Prague, winter)."""
    begun = np.datetime64(start - timedelta(hours=1), "us")
    wave = {"wf_start_time": begun, "wf_start_offset": 0.0, "wf_increment": dt_s}
    channels = [
        ChannelObject(*name.split("/"), x, {**wave, "wf_samples": len(x), "unit_string": unit})
        for name, (unit, x) in signals.items()
    ]
    with TdmsWriter(str(path)) as out:
        out.write_segment([RootObject({"title": path.stem}), *channels])
