"""Probes and coarse Pt100s as LVM or TDMS, the control's CSV, the hall's logger as CSV or Parquet.

Of the Pt100s two are loose, three quarters in the air of the hall, or sit where another one would.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..bodies import Array, pairs
from ..files import csv, document
from ..labview import Signals, Spelling, lvm, tdms
from ..run import TestRun
from ..sensors import UNITS, of_log
from .machine import AT, DT_S, ZONE
from .programme import TITLES
from .sensors import SENSORS

TEXT = Spelling(",", 4, "0,0E+0", padded=False)
MOVES_UM = (50, 50, -100, -50, 50)  # of a jump test
JUMP_DT_S = 0.1


class Laboratory:
    """How the laboratory logs in one case: forms, rates, resolutions and the two bad Pt100s are drawn.

    shown: channels beside the displacement, in the order of `SENSORS`. kept: those that are right.
    """

    def __init__(
        self,
        rng: np.random.Generator,
        folder: Path,
        case: int,
        axes: Sequence[str],
        shown: Sequence[str],
        kept: set[str],
    ) -> None:
        self.rng, self.folder, self.case, self.axes, self.shown = rng, folder, case, axes, shown
        self.raw = folder / "raw"
        self.raw.mkdir(parents=True, exist_ok=True)
        self.tdms, self.volts, self.parquet = (bool(rng.random() < 0.5) for _ in range(3))
        self.end = ".tdms" if self.tdms else ".lvm"
        self.noise_um, self.mean_degc = float(rng.uniform(0.08, 0.25)), float(rng.uniform(18.5, 21))
        self.tick_s = {"daq": float(rng.choice([10, 20, 30, 60])), "nc": float(rng.choice([30, 60])), "hall": 300.0}
        self.at = "a test arbor" if rng.random() < 0.5 else "the chuck"
        self.gain = {a: float(rng.uniform(0.03, 0.07) * rng.choice([-1, 1])) if self.volts else 1.0 for a in axes}
        coarser = {k: float(rng.choice([0.2, 1, 1, 1, 10])) for k, s in SENSORS.items() if s.log == "daq"}
        self.step = {k: s.step * coarser.get(k, 1) for k, s in SENSORS.items()}
        self.mix = {k: pairs(s.mix) if s.mix else {} for k, s in SENSORS.items()}
        self.told = self._spoil([k for k in of_log("daq", SENSORS, SENSORS) if k not in kept])

    def _spoil(self, able: Sequence[str]) -> dict[str, str]:
        """Let two Pt100s be loose or sit elsewhere; returns what is told of each."""
        bad, told = self.rng.permutation([k for k in able if k in self.shown])[:2], {}
        others = [k for k in able if k not in self.shown]
        for j, k in enumerate(map(str, bad)):
            if j == 0 or not others or self.rng.random() < 0.4:
                told[k] = "loose"
                self.mix[k] = {volume: 0.25 * share for volume, share in self.mix[k].items()} | {"mid": 0.75}
            else:
                place = str(self.rng.choice(others))
                told[k] = f"sits where {place} would"
                self.mix[k] = pairs(SENSORS[place].mix)
        return told

    def log(
        self,
        runs: Sequence[TestRun],
        states: Sequence[tuple[Array, dict[str, Array]]],
        move: Mapping[str, Sequence[Array]],
        heat: Array,
    ) -> None:
        """Write three logs a test and the jump tests.

        states: of each test temperatures (time, volume, cause) [K] and air. move: by axis, (time,) of each test [um].
        heat: how much warmer than so each cause makes what is felt, shape (causes,).
        """
        for j, (r, (temps, air)) in enumerate(zip(runs, states, strict=True)):
            felt = air | {name: temps[:, i] @ heat for name, i in AT.items()}
            data = self._readings(r, felt)
            probes = {self._name(a): self._probe(a, move[a][j]) for a in self.axes}
            pt100s = {self._name(k): ("degC", data[k]) for k in of_log("daq", self.shown, SENSORS)}
            self._daq(r.id, r.start, self.tick_s["daq"], probes | pt100s)
            self._control(r, data)
            self._hall(r, data)
        level = np.repeat(np.cumsum([0, *MOVES_UM]), 120)
        for a in self.axes if self.volts else ():
            um = level + self.rng.normal(0, self.noise_um, len(level))
            start = runs[0].start - timedelta(hours=2)
            self._daq(f"jump_{a}", start, JUMP_DT_S, {self._name(a): ("V", 5 + self.gain[a] * um)})

    def _readings(self, r: TestRun, felt: Mapping[str, Array]) -> dict[str, Array]:
        """What stands in the logs of each channel. felt: by volume or air, shape (n,) [K]."""
        u, n = r.inputs, len(r.inputs["n"])
        load = np.where(u["n"] > 0, 4 + 8 * u["n"] + 75 * u["cut"], 0) * self.rng.uniform(0.97, 1.03, n)
        known = {
            "n_S1": 4000 * u["n"],
            "n_live": 6000 * u["live"],
            "v_X": 8 * u["fx"],
            "v_Z": 20 * u["fz"],
            "P_S1": 0.18 * load,
            "load_S1": load,
            "hyd_on": u["hyd"],
            "cool_on": u["cool"],
            "door_open": u["door"],
            "I_sun": 600 * felt["sun"],
        }
        data = {}
        for k in self.shown:
            ticks, warm = self._ticks(SENSORS[k].log, n), bool(self.mix[k])
            if warm:
                x = sum((share * felt[of] for of, share in self.mix[k].items()), np.full(n, self.mean_degc))
                x = np.interp(ticks, np.arange(n) * DT_S, x)
            else:
                x = known[k][np.minimum(ticks // DT_S, n - 1).astype(int)]
            data[k] = np.round((x + warm * self.rng.normal(0, 0.03, len(x))) / self.step[k]) * self.step[k]
        return data

    def _probe(self, a: str, move: Array) -> tuple[str, Array]:
        """Unit and samples of a probe."""
        rng, n = self.rng, len(move)
        ticks = self._ticks("daq", n)
        d = np.interp(ticks, np.arange(n) * DT_S, move + np.cumsum(rng.normal(0, 0.012, n)))
        d = d + rng.normal(0, self.noise_um, len(ticks))
        return (self._unit, (5 if self.volts else float(rng.uniform(-40, 40))) + self.gain[a] * d)

    def _ticks(self, log: str, n: int) -> Array:
        """When a log samples in n minutes [s]."""
        return np.arange(0, (n - 1) * DT_S + 1, self.tick_s[log])

    def _times(self, r: TestRun, log: str) -> list[datetime]:
        """The same, by the clock of the laboratory."""
        ticks = self._ticks(log, len(r.inputs["n"]))
        return [(r.start + timedelta(seconds=float(s))).astimezone(ZONE) for s in ticks]

    def _daq(self, name: str, start: datetime, dt_s: float, signals: Signals) -> None:
        path = self.raw / f"{name}{self.end}"
        if self.tdms:
            tdms(path, {"title": name}, start.replace(tzinfo=None), dt_s, signals)
        else:
            lvm(path, start.astimezone(ZONE), dt_s, signals, TEXT)

    def _control(self, r: TestRun, data: Mapping[str, Array]) -> None:
        nc = of_log("nc", data, SENSORS)
        names = ["Date/Time", *(SENSORS[k].signal for k in nc)]
        units = ["", *(UNITS[SENSORS[k].quantity] for k in nc)]
        csv(self.raw / f"{r.id}.csv", [names, units], self._times(r, "nc"), [data[k] for k in nc])

    def _hall(self, r: TestRun, data: Mapping[str, Array]) -> None:
        times = [t.replace(tzinfo=None) for t in self._times(r, "hall")]
        columns = {SENSORS[k].signal: data[k].round(1) for k in of_log("hall", data, SENSORS)}
        table = pd.DataFrame({"time": times, **columns})
        if self.parquet:
            table.to_parquet(self.raw / f"{r.id}_hala.parquet")
        else:
            table.to_csv(self.raw / f"{r.id}_hala.csv", index=False)

    @property
    def _unit(self) -> str:
        """Of the probes."""
        return "V" if self.volts else "um"

    def _name(self, k: str) -> str:
        """Of a channel, or of the probe of an axis, in its log."""
        probe = k in self.axes
        group = ("Probes/" if probe else "Temp/") if self.tdms and (probe or SENSORS[k].log == "daq") else ""
        return group + (f"snimac {k}" if probe else SENSORS[k].signal)

    def campaign(self, runs: Sequence[TestRun]) -> None:
        """Write campaign.yaml."""
        hall = "raw/{test}_hala." + ("parquet" if self.parquet else "csv")
        sources = {
            "daq": {"reader": "crio", "files": "raw/{test}" + self.end},
            "nc": {"reader": "cnc", "files": "raw/{test}.csv"},
            "hall": {"reader": "table", "files": hall},
        }
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": f"longlathe-{self.case:02d}",
            "machine": {"id": f"LL{self.case}", "description": f"flat-bed lathe, probes at {self.at}"},
            "sources": {k: v | {"timezone": "Europe/Prague"} for k, v in sources.items()},
            "channels": {f"d{a}": self._displacement(a) for a in self.axes} | {k: self._channel(k) for k in self.shown},
            "calibrations": {f"jump_{a}": self._jump(a) for a in self.axes if self.volts},
            "tests": [{"id": r.id, "kind": TITLES[r.kind], "role": r.role} for r in runs],
        }
        document(self.folder / "campaign.yaml", campaign)

    def _displacement(self, a: str) -> dict[str, str]:
        said = {"source": "daq", "signal": self._name(a), "quantity": "displacement", "unit": self._unit}
        return said | {"axis": a, "at": "tcp"} | ({"calibration": f"jump_{a}"} if self.volts else {})

    def _channel(self, k: str) -> dict[str, str]:
        s = SENSORS[k]
        said = {"source": s.log, "signal": self._name(k), "quantity": s.quantity, "at": s.at}
        return said | {"unit": UNITS[s.quantity]}

    def _jump(self, a: str) -> dict[str, Any]:
        return {
            "kind": "jump",
            "axis": a,
            "source": "daq",
            "file": f"raw/jump_{a}{self.end}",
            "signal": self._name(a),
            "dwell": "12 s",
            "moves": [f"{um} um" for um in MOVES_UM],
        }
