"""Probes and RTDs as TDMS or LVM in V or as CSV in um, an export of a Heidenhain or Fanuc control, a recorder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array, felt
from ..faults import behind, come_loose, slipped
from ..files import Form, csv, document
from ..labview import Spelling, lvm, tdms
from ..sensors import of_log
from ..truth import Plan, channels
from .causes import CAUSES
from .logs import CONTROLS, RECORDERS
from .machine import AT, NODE, SIZE
from .programme import TITLES, Run
from .sensors import SENSORS, UNITS

KEPT = ("n_sp", "v_X", "v_Y", "v_Z", "mess", "T_halle")  # logged in each case
COLUMNS = {**AT} | {name: SIZE + k for name, k in NODE.items()}  # of temperatures: bodies, then sources
FINE = 1 / 3  # between samples of the probes [min]
TABLE = Form(";", ".", "%Y-%m-%d %H:%M:%S", encoding="utf-8")
TEXT = Spelling(".", 5, "0.0000000000000000E+0", padded=True)
MOVES_UM = (20, 20, -40, -20, 20)  # of a jump test
JUMP_DT_S = 0.5
FAULTS = ("slip", "clock", "loose")
LOOSE = ("T_lager_v", "T_mutter_z", "T_kw_vl", "T_halle")  # what can come loose: the first that is logged
ZONE = {"timezone": "Etc/GMT-1"}


class Laboratory:
    """How the laboratory logs in one case: forms of its files, axes, noise and channels are drawn."""

    def __init__(
        self,
        rng: np.random.Generator,
        folder: Path,
        name: str,
        asked: Plan,
        base: Sequence[str],
        most: tuple[float, float],
    ) -> None:
        """name: of the campaign. most: speed [1/min] and power [kW] of the spindle."""
        self.rng, self.folder, self.raw, self.id, self.asked = rng, folder, folder / "raw", name, asked
        self.raw.mkdir(parents=True, exist_ok=True)
        self.top_rpm, self.most_kw = most
        self.form = str(rng.choice(["tdms", "lvm", "csv"]))
        self.control = str(rng.choice(list(CONTROLS)))
        self.recorder = str(rng.choice(list(RECORDERS)))
        self.axes = "XYZ" if rng.random() < 0.4 else asked.axis
        self.noise_um, self.mean_degc = float(rng.uniform(0.05, 0.25)), float(rng.uniform(19.5, 23.5))
        self.gain = {a: float(rng.uniform(0.02, 0.05) * rng.choice([-1, 1])) for a in "XYZ"}  # [V/um]
        must = {*KEPT}.union(*(channels(CAUSES[k].right.split()[0]) for k in (*asked.hidden, *base)))
        gone = set(CAUSES[asked.hidden[0]].gone.split()) if asked.kind == "not_logged" else set()
        self.shown = [c for c in SENSORS if c not in gone and (c in must or rng.random() < 0.85)]
        self.told = {
            "form": self.form,
            "control": self.control,
            "recorder": self.recorder,
            "noise_um": self.noise_um,
            "gain_V_um": self.gain,
            "mean_degC": self.mean_degc,
        }

    def log(self, runs: Sequence[Run], move: Mapping[str, Array], bodies: Array, sources: Array) -> str | None:
        """Write three logs a test and the jump tests; returns what is wrong with them.

        move: by axis, shape (minutes, tests) [um]. bodies, sources: shape (minutes, node, tests) [K]; all end together.
        """
        rng, fault = self.rng, None
        bad = int(rng.choice([j for j, r in enumerate(runs) if r.role != "locked"]))
        wrong = str(rng.choice(FAULTS)) if self.asked.kind == "fault" else ""
        for j, r in enumerate(runs):
            u, n = r.during(), r.steps
            data = self._readings(u, np.concatenate([bodies[-n:, :, j], sources[-n:, :, j]], axis=1))
            shift, late = self._stray(n), timedelta(0)
            if wrong and j == bad:
                at, um = int(n * rng.uniform(0.3, 0.6)), float(rng.uniform(5, 9) * rng.choice([-1, 1]))
                if wrong == "slip":
                    shift, fault = slipped(shift, um, at, 60, r.id)
                elif wrong == "clock":
                    late, fault = timedelta(minutes=-40), behind(40, r.id)
                else:
                    loose = next(c for c in LOOSE if c in self.shown)
                    data[loose], _ = come_loose(data[loose], self.mean_degc + u["mid"], at, 60, loose, r.id)
                    fault = f"{loose} is loose in {r.id} from {at / 60:.2f} h on"
            columns = self._displacements(u["mess"], {a: move[a][-n:, j] for a in self.axes}, shift)
            sampled, coarse = self._rounded(data)
            self._probes(r.id, r.start, 60 * FINE, columns | sampled)
            self._others(r, late, coarse)
        self._jumps(runs[0])
        return fault

    def _readings(self, u: Mapping[str, Array], temps: Array) -> dict[str, Array]:
        """What each channel would read, a value a minute."""
        rng, n = self.rng, len(temps)
        load = (u["n"] > 0) * (2 + 8 * u["n"] / self.top_rpm + 85 * u["cut"]) * rng.uniform(0.97, 1.03, n)
        known = {
            "n_sp": u["n"],
            "P_sp": load * self.most_kw / 100,
            "L_sp": load,
            "v_X": u["vx"],
            "v_Y": u["vy"],
            "v_Z": u["vz"],
            "n_A": u["na"],
            "n_C": u["nc"],
            "M_A": 240 * np.sin(u["tilt"]) + 30 * (u["na"] > 0),
            "kss_ein": u["kss"],
            "q_kss": 24 * u["kss"] * rng.uniform(0.96, 1.04, n),
            "hyd_ein": u["hyd"],
            "mess": u["mess"],
            "T_halle": u["mid"],
            "T_oben": u["mid"] + u["layer"],
            "T_unten": u["mid"] - 0.4 * u["layer"],
            "T_aussen": u["out"],
            "rF": u["humid"],
        }
        data = {c: felt(COLUMNS, SENSORS[c].mix, temps) if SENSORS[c].mix else known[c] for c in self.shown}
        return {c: np.asarray(x, float) + (self.mean_degc if _warm(c) else 0) for c, x in data.items()}

    def _stray(self, n: int) -> Array:
        """What no channel tells: the clamp of C seats anew at times, and creeps with the logarithm of time."""
        shift = np.zeros(n)
        for k in np.cumsum(self.rng.exponential(170, 40)).astype(int) if self.asked.kind == "outside" else ():
            after = np.arange(max(n - k, 0))
            shift[k:] += self.rng.normal(0, 2.5) * np.log1p(after / 5) / 3 * np.exp(-after / 1200)
        return shift

    def _displacements(self, measures: Array, move: Mapping[str, Array], shift: Array) -> dict[str, Array]:
        """What the probes log; out of range while they do not see the artefact."""
        rng, n = self.rng, len(measures)
        fine, columns = _fine(n), {}
        seen = np.interp(fine, np.arange(n), measures) > 0.99
        for a, x in move.items():
            d = x - x[0] + np.cumsum(rng.normal(0, 0.006, n)) + (shift if a == self.asked.axis else 0)
            d = np.interp(fine, np.arange(n), d) + rng.normal(0, self.noise_um, len(fine)) + rng.uniform(-15, 15)
            columns[f"Eddy {a}"] = np.where(seen, *((d, 400.0) if self.form == "csv" else (5 + self.gain[a] * d, 9.99)))
        return columns

    def _rounded(self, data: Mapping[str, Array]) -> tuple[dict[str, Array], dict[str, Array]]:
        """The RTDs by their signals as they are logged, and all channels at their resolution, a value a minute."""
        sampled, coarse = {}, {}
        for c, x in data.items():
            s, n = SENSORS[c], len(x)
            if s.log == "daq":
                fine = _fine(n)
                felt_then = np.interp(fine, np.arange(n), x) + self.rng.normal(0, 0.6 * s.step, len(fine))
                sampled[s.signal] = np.round(felt_then / s.step) * s.step
            coarse[c] = np.round(x / s.step + (self.rng.normal(0, 0.3, n) if _warm(c) else 0)) * s.step
        return sampled, coarse

    def _probes(self, name: str, start: datetime, dt_s: float, columns: Mapping[str, Array]) -> None:
        """The log of probes and RTDs. columns: by signal."""
        signals = {c: (self._unit if c.startswith("Eddy") else "degC", x) for c, x in columns.items()}
        path = self.raw / f"{name}.{self.form}"
        if self.form == "tdms":
            named = {f"Log/{c}": x for c, x in signals.items()}
            tdms(path, {"name": name}, start - timedelta(hours=1), dt_s, named)
        elif self.form == "lvm":
            lvm(path, start, dt_s, signals, TEXT)
        else:
            times = [start + timedelta(seconds=dt_s * k) for k in range(len(next(iter(columns.values()))))]
            head = ["Zeit", *(f"{c} [{unit}]" for c, (unit, _) in signals.items())]
            csv(path, [head], times, list(columns.values()), TABLE)

    def _others(self, r: Run, late: timedelta, data: Mapping[str, Array]) -> None:
        """Logs of the control, whose clock may be late, and of the recorder, every other minute and in UTC."""
        nc, air = ({c: data[c] for c in of_log(log, data, SENSORS)} for log in ("nc", "rec"))
        end, export = CONTROLS[self.control]
        export(self.raw / f"{r.id}{end}", r.start + late, nc)
        times = [r.start - timedelta(hours=1) + timedelta(minutes=k) for k in range(0, r.steps, 2)]
        recorded = {SENSORS[c].signal: x[::2] for c, x in air.items()}
        RECORDERS[self.recorder](self.raw / f"{r.id}.{self.recorder}", times, recorded)

    def _jumps(self, first: Run) -> None:
        level = np.repeat(np.cumsum([0, *MOVES_UM]), 60)
        for a in self.axes if self.form != "csv" else "":
            volts = 5 + self.gain[a] * (level + self.rng.normal(0, self.noise_um, len(level)))
            self._probes(f"jump_{a}", first.start - timedelta(hours=3), JUMP_DT_S, {f"Eddy {a}": volts})

    @property
    def _unit(self) -> str:
        """Of the probes."""
        return "um" if self.form == "csv" else "V"

    def campaign(self, runs: Sequence[Run]) -> None:
        """Write campaign.yaml."""
        text, jumped = self.form == "csv", self.axes if self.form != "csv" else ""
        probes: dict[str, Any] = {"reader": "table" if text else "crio", "files": f"raw/{{test}}.{self.form}"} | ZONE
        recorder = "mcap" if self.recorder == "mcap" else "table"
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": self.id,
            "machine": {"id": self.id, "description": "five-axis machining centre with a trunnion table"},
            "sources": {
                "daq": probes | ({"table": {"decimal": "."}} if text else {}),
                "nc": {"reader": "cnc", "files": "raw/{test}" + CONTROLS[self.control][0]} | ZONE,
                "rec": {"reader": recorder, "files": f"raw/{{test}}.{self.recorder}"},
            },
            "channels": {f"d{a}": self._displacement(a) for a in self.axes} | {c: self._channel(c) for c in self.shown},
            "calibrations": {f"jump_{a}": self._jump(a) for a in jumped},
            "tests": [{"id": r.id, "kind": TITLES[r.kind], "role": r.role, "measuring": "mess > 0.5"} for r in runs],
        }
        document(self.folder / "campaign.yaml", campaign)

    def _signal(self, log: str, signal: str) -> str:
        before = "Log/" if log == "daq" and self.form == "tdms" else ""
        return ("/air." if log == "rec" and self.recorder == "mcap" else before) + signal

    def _displacement(self, a: str) -> dict[str, str]:
        said = {"source": "daq", "signal": self._signal("daq", f"Eddy {a}"), "quantity": "displacement"}
        said |= {"unit": self._unit, "axis": a, "at": "tcp"}
        return said | ({} if self.form == "csv" else {"calibration": f"jump_{a}"})

    def _jump(self, a: str) -> dict[str, Any]:
        return {
            "kind": "jump",
            "axis": a,
            "source": "daq",
            "file": f"raw/jump_{a}.{self.form}",
            "signal": self._signal("daq", f"Eddy {a}"),
            "dwell": "30 s",
            "move_uncertainty": "0.3 um",
            "moves": [f"{um} um" for um in MOVES_UM],
        }

    def _channel(self, c: str) -> dict[str, str]:
        s = SENSORS[c]
        said = {"source": s.log, "signal": self._signal(s.log, s.signal), "quantity": s.quantity}
        return said | {"unit": UNITS[s.quantity]} | ({"at": s.at} if s.at else {})


def _warm(c: str) -> bool:
    return SENSORS[c].quantity == "temperature"


def _fine(n: int) -> Array:
    """When the probes sample in n minutes [min]."""
    return np.arange(0, n - 1 + 1e-9, FINE)
