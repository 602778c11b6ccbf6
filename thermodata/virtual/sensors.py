"""What the lab measures: Pt100s in the cRIO, the control's own channels, air stations, and three probes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.plugin import Float1D
from thermodata.virtual.hall import smooth
from thermodata.virtual.plan import AXES

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


def make_sensors(rng: np.random.Generator) -> tuple[tuple[Sensor, ...], frozenset[str]]:
    """Every sensor that a lab could place, and the names of those that this one has left out unless needed."""
    fine = float(rng.choice([0.01, 0.02, 0.05]))
    whole = bool(rng.random() < 0.25)  # some controls show whole kelvin only
    rows: list[Sensor] = []
    spare: set[str] = set()

    def pt(name: str, at: str, body: str, cell: int, usual: float = 1.0) -> None:
        if rng.random() >= usual:
            spare.add(name)
        serial, offset = f"PT-{rng.integers(1000, 9999)}", float(rng.normal(0, 0.1))
        rows.append(
            Sensor(
                name,
                "daq",
                "temperature",
                "degC",
                at,
                (body, cell),
                float(rng.uniform(0.008, 0.02)),
                fine,
                serial,
                offset,
            )
        )

    def own(name: str, at: str, body: str, cell: int) -> None:
        rows.append(Sensor(name, "nc", "temperature", "degC", at, (body, cell), 0.02, 1.0 if whole else 0.1))

    def state(name: str, quantity: str, unit: str, at: str, resolution: float = 0.0) -> None:
        rows.append(Sensor(name, "nc", quantity, unit, at, resolution=resolution))

    pt("T_bearing_front", "spindle.bearing.front", "bearing_front_outer", 0)
    pt("T_bearing_rear", "spindle.bearing.rear", "bearing_rear_outer", 0, 0.7)
    pt("T_ram", "ram", "ram", 1, 0.4)
    pt("T_column_front", "column.front", "column_front", 2)
    pt("T_column_rear", "column.rear", "column_rear", 2)
    pt("T_bed", "bed", "bed", 1, 0.5)
    pt("T_table_bearing", "table.bearing", "table_bearing", 0)
    pt("T_table", "table", "table", 2, 0.5)
    pt("T_tool", "tool", "tool", 2, 0.6)
    pt("T_fixture", "fixture", "probe", 0, 0.9)
    pt("T_coolant", "coolant.supply", "chiller", 0)
    pt("T_tank", "hydraulics", "tank", 0)
    own("T_motor_spindle", "spindle.motor", "stator", 0)
    for a in AXES:
        own(f"T_motor_{a}", f"axis.{a.lower()}.motor", f"feed_motor_{a.lower()}", 0)
        own(f"T_nut_{a}", f"axis.{a.lower()}.nut", f"nut_{a.lower()}", 0)
    for name, at in (("T_hall_top", "hall.top"), ("T_hall_bottom", "hall.bottom"), ("T_floor", "floor")):
        rows.append(
            Sensor(
                name,
                "rec",
                "temperature",
                "degC",
                at,
                at,
                0.015,
                0.01,
                f"AIR-{rng.integers(100, 999)}",
                float(rng.normal(0, 0.1)),
            )
        )
    state("spindle_speed", "rotational_speed", "rpm", "spindle", 1.0)
    state("spindle_power", "power", "kW", "spindle", 0.01)
    for a in AXES:
        state(f"feed_{a}", "feed", "m/min", f"axis.{a.lower()}", 0.001)
        state(f"pos_{a}", "position", "mm", f"axis.{a.lower()}", 0.001)
    state("table_speed", "rotational_speed", "rpm", "table", 0.1)
    state("coolant_on", "state", "1", "coolant")
    state("pump_on", "state", "1", "hydraulics")
    state("door_open", "state", "1", "hall.door")
    return tuple(rows), frozenset(spare)
