"""The works' laboratory: probe in um and Pt100s as LabVIEW text, the control's CSV, the hall's workbook."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import timedelta
from pathlib import Path

import numpy as np

from ..bodies import Array, felt
from ..faults import behind, come_loose, slipped
from ..files import csv, document, workbook
from ..sensors import Sensor, of_log
from .machine import AT, RATIO
from .programme import DT_S, Run
from .sensors import SENSORS

TITLES = {"const": "spindle", "repeat": "spindle", "axes": "linear_axis", "idle": "etve", "live": "spindle"}
FAULTS = ("slip", "clock", "loose")


class Laboratory:
    """How the laboratory logs in one case: in which test a fault would be is drawn."""

    def __init__(self, rng: np.random.Generator, folder: Path, kind: str, case: int) -> None:
        self.rng, self.folder, self.kind, self.case = rng, folder, kind, case
        self.raw = folder / "raw"
        self.raw.mkdir(parents=True, exist_ok=True)
        self.bad = int(rng.integers(0, 3))
        self.wrong = FAULTS[case // 24 % 3] if kind == "fault" else None

    def log(
        self, runs: Sequence[Run], states: Sequence[tuple[Array, Array]], move: Sequence[Array], shown: Sequence[str]
    ) -> str | None:
        """Write three logs a test; returns what is wrong with them.

        states: temperatures (time, node) [degC] and chiller of each test. move: displacement of each (time,) [um].
        shown: channels beside the displacement.
        """
        faults = []
        for j, (r, (temps, chills)) in enumerate(zip(runs, states, strict=True)):
            wrong = self.wrong if j == self.bad else None
            d, slip = self._displacement(r, move[j], wrong == "slip")
            readings, loose = self._readings(r, temps, chills, shown, wrong == "loose")
            self._labview(r, d, readings)
            self._control(r, readings, timedelta(minutes=-35 if wrong == "clock" else 0))
            self._hall(r, readings)
            late = behind(35, r.id) if wrong == "clock" else None
            faults += [fault for fault in (slip, loose, late) if fault]
        return faults[-1] if faults else None

    def _displacement(self, r: Run, move: Array, slips: bool) -> tuple[Array, str | None]:
        rng, n = self.rng, len(move)
        d = move + rng.normal(0, 0.15, n)
        if self.kind == "outside":  # the levelling wedges slip at times, whatever the temperatures
            d = d + np.cumsum((rng.random(n) < DT_S / 6000) * rng.normal(0, 3.0, n))
        if not slips:
            return d, None
        at, um = int(n * rng.uniform(0.3, 0.7)), float(rng.uniform(4, 9))
        return slipped(d, um, at, DT_S, r.id)

    def _readings(
        self, r: Run, temps: Array, chills: Array, shown: Sequence[str], comes_loose: bool
    ) -> tuple[dict[str, Array], str | None]:
        """What stands in the logs of each channel."""
        rng, u, n, fault = self.rng, r.inputs, r.steps, None
        load = (u["speed"] > 0) * (6 + 80 * u["cut"]) * rng.uniform(0.97, 1.03, n)
        known = {
            "speed": u["speed"],
            "n_motor": u["speed"] * np.array(list(RATIO.values()))[u["range"].astype(int)],
            "range": u["range"],
            "P_motor": 0.6 * load,
            "load": load,
            "n_live": u["live"],
            "feed_X": u["feed_x"],
            "feed_Z": u["feed_z"],
            "pump": u["pump"],
            "chiller_on": chills,
        }
        readings = {}
        for name in shown:
            s = SENSORS[name]
            x = felt(AT, s.mix, temps) if s.mix else known[name]
            if comes_loose and name == "T_bearing_front":
                x, fault = come_loose(x, temps[:, AT["mid"]], int(n * 0.3), DT_S, name, r.id)
            noise = rng.normal(0, 0.4 * s.step, n) if s.mix else 0
            readings[name] = np.round((x + noise) / s.step) * s.step
        return readings, fault

    def _labview(self, r: Run, d: Array, readings: Mapping[str, Array]) -> None:
        """LabVIEW text of many channels with one column of times; its decimals have commas."""
        lv = of_log("lv", readings, SENSORS)
        date, time = f"{r.start:%Y/%m/%d}", f"{r.start:%H:%M:%S},0"

        def each(key: str, value: object) -> str:
            return "\t".join([key, *[str(value)] * (len(lv) + 1)])

        head = [
            "LabVIEW Measurement\t",
            "Writer_Version\t2",
            "Reader_Version\t2",
            "Separator\tTab",
            "Decimal_Separator\t,",
            "Multi_Headings\tNo",
            "X_Columns\tOne",
            "Time_Pref\tAbsolute",
            f"Date\t{date}",
            f"Time\t{time}",
            "***End_of_Header***\t",
            "\t",
            f"Channels\t{len(lv) + 1}",
            each("Samples", r.steps),
            each("Date", date),
            each("Time", time),
            "\t".join(["Y_Unit_Label", "um", *["degC"] * len(lv)]),
            each("X_Dimension", "Time"),
            each("X0", "0,0E+0"),
            each("Delta_X", f"{DT_S:.6f}".replace(".", ",")),
            "***End_of_Header***",
            "\t".join(["X_Value", "Sonda X", *(SENSORS[name].signal for name in lv), "Comment"]),
        ]
        table = np.column_stack([np.arange(r.steps) * DT_S, d, *(readings[name] for name in lv)])
        rows = ("\t".join(f"{v:.6f}" for v in row).replace(".", ",") for row in table)
        (self.raw / f"{r.id}.lvm").write_text("\n".join([*head, *rows]) + "\n", encoding="cp1252")

    def _control(self, r: Run, readings: Mapping[str, Array], off: timedelta) -> None:
        nc = of_log("nc", readings, SENSORS)
        times = [r.start + off + timedelta(seconds=k * DT_S) for k in range(r.steps)]
        head = ["Time", *(SENSORS[name].signal for name in nc)]
        csv(self.raw / f"{r.id}.csv", [head], times, [readings[name] for name in nc])

    def _hall(self, r: Run, readings: Mapping[str, Array]) -> None:
        hall = of_log("xl", readings, SENSORS)
        rows = (
            [r.start + timedelta(seconds=k * DT_S), *(round(float(readings[name][k]), 2) for name in hall)]
            for k in range(0, r.steps, 5)
        )
        workbook(self.raw / f"{r.id}.xlsx", "hala", ["čas", *(SENSORS[name].signal for name in hall)], rows)

    def campaign(self, runs: Sequence[Run], shown: Sequence[str]) -> None:
        """Write campaign.yaml."""
        displacement = {
            "source": "lv",
            "signal": "Sonda X",
            "quantity": "displacement",
            "unit": "um",
            "axis": "X",
            "at": "tcp",
        }
        zone = {"timezone": "Europe/Prague"}
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": f"lathe-{self.case:02d}",
            "machine": {"id": f"SUK{self.case:02d}", "description": "heavy lathe"},
            "sources": {
                "lv": {"reader": "crio", "files": "raw/{test}.lvm", **zone},
                "nc": {"reader": "cnc", "files": "raw/{test}.csv", "encoding": "cp1250", **zone},
                "xl": {"reader": "table", "files": "raw/{test}.xlsx", **zone},
            },
            "channels": {"dX": displacement, **{name: _channel(SENSORS[name]) for name in shown}},
            "tests": [{"id": r.id, "kind": TITLES.get(r.kind, r.kind), "role": r.role} for r in runs],
        }
        document(self.folder / "campaign.yaml", campaign)


def _channel(s: Sensor) -> dict[str, str]:
    return {"source": s.log, "signal": s.signal, "quantity": s.quantity, "at": s.at}
