"""Probes in V and Pt100s as TDMS, LVM or LabVIEW's spreadsheet, the control's CSV, the hall's MCAP or CSV.

Probes of an axis, of three, or of two heights whose difference is a tilt; they are out of reach while the machine
works. What the control shows is rounded, and a sensor that does nothing may go with the hidden cause.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np

from ..bodies import Array, felt
from ..faults import behind, come_loose, slipped
from ..files import document
from ..sensors import Sensor, of_log
from ..truth import Plan, channels
from .causes import CAUSES
from .logs import GROUP, control, probes, recorder
from .machine import AT, NODE, State
from .programme import TITLES, Run, lagged
from .sensors import DECOYS, SENSORS, UNITS, known

KEPT = ("n_S", "F_X", "F_Y", "F_Z", "n_A", "cool_on", "meas", "T_hall")  # logged in each case where its cause is
COLUMNS = {**NODE} | {name: len(NODE) + k for name, k in AT.items()}  # of temperatures: sources, then volumes
FINE = 0.5  # between samples of the probes [min]
ZERO_V, AWAY_V = 5.0, 10.0  # of the probes at their zero, and while they see nothing
APART_MM = 160.0  # heights of the probes that make a tilt
MOVES_UM = (50, 50, -100, -50, 50)  # of a jump test
JUMP_DT_S = 0.5
FAULTS = ("slip", "clock", "loose")
LOOSE = ("T_brg_f", "T_nut_X", "T_nut_Y", "T_rtb")  # what comes loose: the first that is logged
ZONE = {"timezone": "Europe/Prague"}


class Laboratory:
    """How the laboratory logs in one case: forms of its files, probes, noise and channels are drawn."""

    def __init__(
        self, rng: np.random.Generator, folder: Path, case: int, asked: Plan, base: Sequence[str], most_kw: float
    ) -> None:
        """most_kw: power of the spindle."""
        self.rng, self.folder, self.raw, self.asked, self.most_kw = rng, folder, folder / "raw", asked, most_kw
        self.id = f"vmc-{case:02d}"
        self.raw.mkdir(parents=True, exist_ok=True)
        self.form, self.recorder = str(rng.choice(["tdms", "lvm", "txt"])), str(rng.choice(["mcap", "csv"]))
        if asked.axis == "T":
            self.probes = ["Y_high", "Y_low"]
        else:
            self.probes = [*"XYZ"] if rng.random() < 0.4 else [asked.axis]
        self.noise_um, self.mean_degc = float(rng.uniform(0.05, 0.25)), float(rng.uniform(19.5, 23.5))
        self.gain = {p: float(rng.uniform(0.02, 0.05) * rng.choice([-1, 1])) for p in self.probes}  # [V/um]
        self.shown = self._chosen(base)
        self.sensors = {c: SENSORS[c] for c in self.shown}
        self.decoy: tuple[str, str] | None = None  # and what it goes with
        if asked.hidden and asked.kind != "not_logged" and case % 3 == 1:
            right = CAUSES[asked.hidden[0]].drivers[0]
            sensor = next(s for place, s in DECOYS.items() if SENSORS[right].at.startswith(place))
            self.decoy = sensor.signal, right
            self.sensors[sensor.signal] = sensor
        self.told: dict[str, Any] = {
            "form": self.form,
            "recorder": self.recorder,
            "noise_um": self.noise_um,
            "gain_V_um": self.gain,
            "mean_degC": self.mean_degc,
            "decoy": [self.decoy[0], self.sensors[self.decoy[0]].at, self.decoy[1]] if self.decoy else None,
            "decoy_r": [],
        }

    def _chosen(self, base: Sequence[str]) -> list[str]:
        """The channels that are logged; what a gearbox has only where the case is of one, behind the belt or not."""
        asked = self.asked
        must = {*KEPT}.union(*(channels(CAUSES[k].best) for k in (*asked.hidden, *base)))
        gone = CAUSES[asked.hidden[0]].gone if asked.kind == "not_logged" else set()
        if not {"gearbox", "belt"} & {*asked.hidden, *base}:
            gone = gone | {"T_gear"}
        return [c for c in SENSORS if c not in gone and (c in must or self.rng.random() < 0.8)]

    def log(self, runs: Sequence[Run], states: Sequence[State], move: Sequence[Mapping[str, Array]]) -> str | None:
        """Write three logs a test and the jump tests; returns what is wrong with them. move: of each test by axis [um],
        and T [urad]."""
        rng, fault = self.rng, None
        bad = int(rng.choice([j for j, r in enumerate(runs) if r.role == "verification"]))
        wrong = str(rng.choice(FAULTS))
        for j, (r, state) in enumerate(zip(runs, states, strict=True)):
            data, shift, late = self._readings(r, state), self._stray(r.steps), timedelta(0)
            if self.asked.kind == "fault" and j == bad:
                at, um = int(r.steps * rng.uniform(0.3, 0.6)), float(rng.uniform(5, 9) * rng.choice([-1, 1]))
                if wrong == "slip":
                    shift, fault = slipped(shift, um, at, 60, r.id)
                elif wrong == "clock":
                    late, fault = timedelta(minutes=-35), behind(35, r.id)
                else:
                    c = next(c for c in (*LOOSE, *self.shown) if c in self.shown)
                    air = self.mean_degc + r.during()["hall"]
                    data[c], fault = come_loose(data[c], air, at, 60, c, r.id, share=0.7)
            if self.decoy:
                data[self.decoy[0]] = self._decoy(data[self.decoy[1]])
            signals = self._displacements(r.during()["meas"], move[j], shift)
            sampled, coarse = self._rounded(data)
            probes(self.raw / f"{r.id}.{self.form}", r.start, 60 * FINE, signals | sampled)
            self._others(r, late, coarse)
        self._jumps(runs[0])
        return fault

    def _readings(self, r: Run, state: State) -> dict[str, Array]:
        """What each channel would show, a value a minute."""
        at_hand = known(r.during(), state.fluids, self.most_kw)
        temps = np.concatenate([state.own, state.fields.sum(2)], axis=1)
        data = {c: felt(COLUMNS, SENSORS[c].mix, temps) if SENSORS[c].mix else at_hand[c] for c in self.shown}
        return {c: x + (self.mean_degc if _warm(SENSORS[c]) else 0) for c, x in data.items()}

    def _stray(self, n: int) -> Array:
        """What no channel tells: the gas spring that carries the headstock leaks, and somebody fills it up."""
        shift, k = np.zeros(n), 0
        while self.asked.kind == "outside" and k < n:
            span, leak = int(self.rng.uniform(90, 500)), self.rng.uniform(4, 10)
            shift[k : k + span] = -leak * (np.arange(span)[: n - k] / span) ** 0.7
            k += span
        return shift

    def _decoy(self, x: Array) -> Array:
        """A temperature that goes with another one, shape (n,)."""
        wander = lagged(self.rng.normal(0, 1, len(x)), 40)
        own = wander / max(wander.std(), 1e-9) * 0.04 * max(np.ptp(x), 0.5)
        decoy: Array = self.mean_degc + 4 + 0.7 * lagged(x - x[0], 4) + own
        self.told["decoy_r"].append(round(float(np.corrcoef(x, decoy)[0, 1]), 3))
        return decoy

    def _displacements(self, measures: Array, move: Mapping[str, Array], shift: Array) -> dict[str, tuple[str, Array]]:
        """What the probes log [V]; nothing while they do not see the artefact."""
        rng, n = self.rng, len(measures)
        fine, signals = _fine(n), {}
        seen = measures[fine.astype(int)] > 0.5
        for p in self.probes:
            d = move[p[0]] + np.cumsum(rng.normal(0, 0.005, n)) + (shift if p in (self.asked.axis, "Y_high") else 0)
            d = d + APART_MM / 1000 * move["T"] if p == "Y_high" else d
            d = np.interp(fine, np.arange(n), d - d[0]) + rng.normal(0, self.noise_um, len(fine)) + rng.uniform(-15, 15)
            signals[f"Eddy {p}"] = "V", np.where(seen, ZERO_V + self.gain[p] * d, AWAY_V)
        return signals

    def _rounded(self, data: Mapping[str, Array]) -> tuple[dict[str, tuple[str, Array]], dict[str, Array]]:
        """The Pt100s by their signals as they are logged, and all channels at their resolution, a value a minute."""
        sampled, coarse, rng = {}, {}, self.rng
        for c, x in data.items():
            s, n = self.sensors[c], len(x)
            if s.log == "daq":
                fine = _fine(n)
                then = np.interp(fine, np.arange(n), x) + rng.normal(0, 0.02, len(fine))
                sampled[s.signal] = UNITS[s.quantity], np.round(then / s.step) * s.step
            coarse[c] = np.round((x + (rng.normal(0, 0.3 * s.step, n) if _warm(s) else 0)) / s.step) * s.step
        return sampled, coarse

    def _others(self, r: Run, late: timedelta, data: Mapping[str, Array]) -> None:
        """Logs of the control, whose clock may be late, and of the recorder, every other minute."""
        nc, rec = (of_log(log, data, self.sensors) for log in ("nc", "rec"))
        signals = {self.sensors[c].signal: (_spelled(self.sensors[c]), data[c]) for c in nc}
        control(self.raw / f"{r.id}_nc.csv", r.start + late, signals)
        times = [r.start + timedelta(minutes=k) for k in range(0, r.steps, 2)]
        recorder(self.raw / f"{r.id}{self._end}", times, {self.sensors[c].signal: data[c][::2] for c in rec})

    @property
    def _end(self) -> str:
        """Of the recorder's files."""
        return ".mcap" if self.recorder == "mcap" else "_hall.csv"

    def _jumps(self, first: Run) -> None:
        level = np.repeat(np.cumsum([0, *MOVES_UM]), 60)
        for p in self.probes:
            volts = ZERO_V + self.gain[p] * (level + self.rng.normal(0, self.noise_um, len(level)))
            path, start = self.raw / f"jump_{p}.{self.form}", first.start - timedelta(hours=3)
            probes(path, start, JUMP_DT_S, {f"Eddy {p}": ("V", volts)})

    def campaign(self, runs: Sequence[Run]) -> None:
        """Write campaign.yaml."""
        mcap = self.recorder == "mcap"
        tilt = {"derive": f"(dY_high - dY_low) / {APART_MM:.0f} mm", "quantity": "tilt"}
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": self.id,
            "machine": {"id": self.id, "description": "vertical machining centre with a rotary table"},
            "sources": {
                "daq": {"reader": "crio", "files": f"raw/{{test}}.{self.form}"} | ZONE,
                "nc": {"reader": "cnc", "files": "raw/{test}_nc.csv"} | ZONE,
                "rec": {"reader": "mcap" if mcap else "table", "files": "raw/{test}" + self._end}
                | ({} if mcap else ZONE),
            },
            "channels": {f"d{p}": self._displacement(p) for p in self.probes}
            | {c: self._channel(s) for c, s in self.sensors.items()}
            | ({"tilt_A": tilt} if self.asked.axis == "T" else {}),
            "calibrations": {f"jump_{p}": self._jump(p) for p in self.probes},
            "tests": [{"id": r.id, "kind": TITLES[r.kind], "role": r.role, "measuring": "meas > 0.5"} for r in runs],
        }
        document(self.folder / "campaign.yaml", campaign)

    def _signal(self, log: str, signal: str) -> str:
        if log == "daq":
            return f"{GROUP}/{signal}" if self.form == "tdms" else signal
        return f"/hall.{signal}" if log == "rec" and self.recorder == "mcap" else signal

    def _displacement(self, p: str) -> dict[str, str]:
        said = {"source": "daq", "signal": self._signal("daq", f"Eddy {p}"), "quantity": "displacement", "unit": "V"}
        return said | {"axis": p[0], "at": "mandrel." + p[2:] if p[1:] else "tcp", "calibration": f"jump_{p}"}

    def _jump(self, p: str) -> dict[str, Any]:
        return {
            "kind": "jump",
            "axis": p[0],
            "source": "daq",
            "file": f"raw/jump_{p}.{self.form}",
            "signal": self._signal("daq", f"Eddy {p}"),
            "dwell": "30 s",
            "move_uncertainty": "0.5 um",
            "moves": [f"{um} um" for um in MOVES_UM],
        }

    def _channel(self, s: Sensor) -> dict[str, str]:
        said = {"source": s.log, "signal": self._signal(s.log, s.signal), "quantity": s.quantity}
        return said | {"unit": UNITS[s.quantity]} | ({"at": s.at} if s.at else {})


def _warm(s: Sensor) -> bool:
    return s.quantity == "temperature"


def _spelled(s: Sensor) -> str:
    """A unit as the control writes it."""
    return {"degC": "°C", "1": ""}.get(UNITS[s.quantity], UNITS[s.quantity])


def _fine(n: int) -> Array:
    """When the probes sample in n minutes [min]."""
    return np.arange(0, n - 1 + 1e-9, FINE)
