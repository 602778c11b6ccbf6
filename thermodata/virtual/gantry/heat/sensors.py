"""What the lab measures: Pt100s in the cRIO, the control's own channels, air stations, and three probes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np

from thermodata.plugin import Float1D
from thermodata.virtual.gantry.heat.hall import smooth
from thermodata.virtual.gantry.plan import AXES

SourceName = Literal["daq", "nc", "rec"]


@dataclass(frozen=True, slots=True)
class Sensor:
    """One logged channel. cell: (body, number) or a boundary's name, for temperatures; noise_k: slow part [K]."""

    name: str
    source: SourceName
    quantity: str
    unit: str
    at: str
    cell: tuple[str, int] | str | None = None
    noise_k: float = 0.0
    resolution: float = 0.0
    serial: str = ""
    offset_k: float = 0.0

    def read(self, true: Float1D, rng: np.random.Generator) -> Float1D:
        """A reading on the grid of 10 s, shape (n,): offset, slow noise, resolution."""
        value = true + self.offset_k
        if self.noise_k:
            fast = 0.5 * self.noise_k * rng.standard_normal(len(true))
            value = value + smooth(rng, len(true), self.noise_k, 400.0) + fast
        if self.resolution:
            value = np.round(value / self.resolution) * self.resolution
        return np.asarray(value, dtype=np.float64)


_thermometer = partial(Sensor, quantity="temperature", unit="degC")

# name, place, body, cell, how often a lab has it
_PT100 = (
    ("T_bearing_front", "spindle.bearing.front", "bearing_front_outer", 0, 1.0),
    ("T_bearing_rear", "spindle.bearing.rear", "bearing_rear_outer", 0, 0.7),
    ("T_ram", "ram", "ram", 1, 0.4),
    ("T_column_front", "column.front", "column_front", 2, 1.0),
    ("T_column_rear", "column.rear", "column_rear", 2, 1.0),
    ("T_bed", "bed", "bed", 1, 0.5),
    ("T_table_bearing", "table.bearing", "table_bearing", 0, 1.0),
    ("T_table", "table", "table", 2, 0.5),
    ("T_tool", "tool", "tool", 2, 0.6),
    ("T_fixture", "fixture", "probe", 0, 0.9),
    ("T_coolant", "coolant.supply", "chiller", 0, 1.0),
    ("T_tank", "hydraulics", "tank", 0, 1.0),
)
_OF_CONTROL = (
    ("T_motor_spindle", "spindle.motor", "stator"),
    *(
        of_axis
        for a in AXES
        for of_axis in (
            (f"T_motor_{a}", f"axis.{a.lower()}.motor", f"feed_motor_{a.lower()}"),
            (f"T_nut_{a}", f"axis.{a.lower()}.nut", f"nut_{a.lower()}"),
        )
    ),
)
_OF_AIR = (("T_hall_top", "hall.top"), ("T_hall_bottom", "hall.bottom"), ("T_floor", "floor"))
# name, quantity, unit, place, resolution
_STATES = (
    ("spindle_speed", "rotational_speed", "rpm", "spindle", 1.0),
    ("spindle_power", "power", "kW", "spindle", 0.01),
    *(
        of_axis
        for a in AXES
        for of_axis in (
            (f"feed_{a}", "feed", "m/min", f"axis.{a.lower()}", 0.001),
            (f"pos_{a}", "position", "mm", f"axis.{a.lower()}", 0.001),
        )
    ),
    ("table_speed", "rotational_speed", "rpm", "table", 0.1),
    ("coolant_on", "state", "1", "coolant", 0.0),
    ("pump_on", "state", "1", "hydraulics", 0.0),
    ("door_open", "state", "1", "hall.door", 0.0),
)


def make_sensors(rng: np.random.Generator) -> tuple[tuple[Sensor, ...], frozenset[str]]:
    """Every sensor that a lab could place, and the names of those that this one has left out unless needed."""
    fine = float(rng.choice([0.01, 0.02, 0.05]))
    whole = bool(rng.random() < 0.25)  # some controls show whole kelvin only
    spare: set[str] = set()
    rows: list[Sensor] = []
    # all draw from one generator: their order is part of what a seed means
    for name, at, body, cell, usual in _PT100:
        if rng.random() >= usual:
            spare.add(name)
        serial, offset = f"PT-{rng.integers(1000, 9999)}", float(rng.normal(0, 0.1))
        noise = float(rng.uniform(0.008, 0.02))
        rows.append(
            _thermometer(
                name, "daq", at=at, cell=(body, cell), noise_k=noise, resolution=fine, serial=serial, offset_k=offset
            )
        )
    shown = 1.0 if whole else 0.1  # [K]
    rows += [
        _thermometer(name, "nc", at=at, cell=(body, 0), noise_k=0.02, resolution=shown)
        for name, at, body in _OF_CONTROL
    ]
    for name, at in _OF_AIR:
        serial, offset = f"AIR-{rng.integers(100, 999)}", float(rng.normal(0, 0.1))
        rows.append(
            _thermometer(name, "rec", at=at, cell=at, noise_k=0.015, resolution=0.01, serial=serial, offset_k=offset)
        )
    rows += [Sensor(name, "nc", quantity, unit, at, resolution=step) for name, quantity, unit, at, step in _STATES]
    return tuple(rows), frozenset(spare)
