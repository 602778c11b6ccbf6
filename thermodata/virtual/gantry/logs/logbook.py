"""How a lab logs a world: clocks, signal names, probe sensitivities. Drawn by the seed, apart from the world itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Float1D
from thermodata.virtual.gantry.plan import AXES
from thermodata.virtual.gantry.world import World

PROBE_RANGE_V = 20.0
MOVES_UM = (100.0, 50.0, -200.0, -50.0, 100.0)  # unequal, so that they can't be read with either sign
DWELL_S = 12.0

_CZECH = {
    "spindle_speed": "Otáčky vřetena",
    "spindle_power": "Výkon vřetena",
    "feed": "Posuv {a}",
    "pos": "Poloha {a}",
    "T_motor_spindle": "Teplota motoru vřetena",
    "T_motor": "Teplota motoru {a}",
    "T_nut": "Teplota matice {a}",
    "table_speed": "Otáčky stolu",
    "coolant_on": "Chlazení",
    "pump_on": "Čerpadlo",
    "door_open": "Dveře",
}
_SHORT = {
    "spindle_speed": "nActSpeed",
    "spindle_power": "pActSpindle",
    "feed": "vAct{a}",
    "pos": "sAct{a}1",
    "T_motor_spindle": "tMotSP1",
    "T_motor": "tMot{a}1",
    "T_nut": "tNut{a}1",
    "table_speed": "nActC1",
    "coolant_on": "bCoolant",
    "pump_on": "bHydPump",
    "door_open": "bDoor",
}


@dataclass(frozen=True, slots=True)
class Probe:
    """An eddy probe: volts = zero_v + displacement / um_per_v. um_per_v is signed, by the way the probe faces."""

    axis: str
    serial: str
    um_per_v: float
    zero_v: float

    @property
    def facing(self) -> str:
        return f"{'+' if self.um_per_v > 0 else '-'}{self.axis}"

    def volts(self, um: Float1D, rng: np.random.Generator, noise_um: float) -> Float1D:
        """shape (n,): noise, and the converter's 16 bits and limits."""
        v = self.zero_v + (um + noise_um * rng.standard_normal(len(um))) / self.um_per_v
        bit = PROBE_RANGE_V / 65_536
        return np.asarray(np.clip(np.round(v / bit) * bit, 0.0, PROBE_RANGE_V))


@dataclass(frozen=True)
class Logbook:
    """names: channel -> signal in its file, group included. offsets: source -> what must be added to its times [s]."""

    probes: tuple[Probe, ...]
    names: dict[str, str]
    czech: bool
    nc_offset_s: int
    rec_offset_s: float
    crosstalk: float

    @classmethod
    def draw(cls, world: World) -> Logbook:
        rng = np.random.default_rng([world.seed, 15_485_863])
        probes = tuple(
            Probe(
                a,
                str(rng.integers(4000, 4999)),
                float(rng.uniform(22, 58)) * float(rng.choice([-1, 1])),
                float(rng.uniform(9, 11)),
            )
            for a in AXES
        )
        czech = bool(rng.random() < 0.5)
        style = _CZECH if czech else _SHORT
        first = int(rng.integers(1, 9))
        names: dict[str, str] = {f"d{p.axis}": f"Eddy/{p.axis}" for p in probes}
        number = first
        for s in world.sensors:
            if s.source == "daq":
                names[s.name] = f"Temp/T{number:02d}"
                number += 1
            elif s.source == "rec":
                names[s.name] = f"/hall/air.{s.at.rsplit('.', 1)[-1]}"
            else:
                stem, _, letter = s.name.rpartition("_")
                key = s.name if s.name in style else stem
                names[s.name] = style[key].format(a=letter)
        return cls(
            probes,
            names,
            czech,
            int(rng.integers(-45, 46)),
            round(float(rng.uniform(-5, 5)), 1),
            float(rng.uniform(0.002, 0.006)),
        )


def describe_probe(probe: Probe) -> dict[str, Any]:
    """The channel of a probe in the campaign file, without its signal."""
    return {
        "quantity": "displacement",
        "unit": "V",
        "axis": probe.axis,
        "at": "tcp",
        "relative_to": "table",
        "calibration": f"jump_{probe.axis}",
        "sensor": {"serial": probe.serial, "range": ["0 V", f"{PROBE_RANGE_V:g} V"]},
    }
