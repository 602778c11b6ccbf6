"""What is logged, and how badly: places, lags, noise, steps of the reading, three loggers with a clock each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import lfilter

from thermodata.plugin import Float1D
from thermodata.virtual.lathe.heat.fields import Fields
from thermodata.virtual.lathe.heat.hall import Air
from thermodata.virtual.lathe.programme import DT_S, Work

True_ = Callable[[Work, Air, Fields], Float1D]
UNIT = {
    "temperature": "degC",
    "rotational_speed": "rpm",
    "power": "kW",
    "feed": "m/min",
    "position": "mm",
    "state": "1",
    "pressure": "bar",
    "humidity": "%",
}


@dataclass(frozen=True, slots=True)
class Sensor:
    """at: place, as the laboratory wrote it; None where nobody did. lag_s, noise, resolution: in the unit of `UNIT`."""

    name: str
    quantity: str
    at: str | None
    source: str
    true: True_
    lag_s: float = 0.0
    noise: float = 0.0
    resolution: float = 0.0

    @property
    def unit(self) -> str:
        return UNIT[self.quantity]

    def read(self, true: Float1D, rng: np.random.Generator) -> Float1D:
        """The reading of a true course, shape (n,) on DT_S; at rest before it begins."""
        x = true
        if self.lag_s > 0:
            a = float(np.exp(-DT_S / self.lag_s))
            x, _ = lfilter([1 - a], [1, -a], x, zi=[a * x[0]])
        x = x + self.noise * rng.standard_normal(len(x))
        return np.asarray(np.round(x / self.resolution) * self.resolution if self.resolution else x)


def _plc(name: str, at: str | None, true: True_, lag_s: float = 45.0) -> Sensor:
    return Sensor(name, "temperature", at, "plc", true, lag_s, 0.03, 0.1)


def _pt(name: str, at: str | None, true: True_, lag_s: float = 90.0) -> Sensor:
    return Sensor(name, "temperature", at, "logger", true, lag_s, 0.02, 0.01)


def _air(name: str, at: str, true: True_) -> Sensor:
    return Sensor(name, "temperature", at, "hall", true, 240.0, 0.03, 0.1)


def _spindle_kw(work: Work) -> Float1D:
    return np.asarray(work.cutting + 0.8 * (work.speed / 4000) ** 1.2 + 0.15 * (work.speed > 0))


ALL: tuple[Sensor, ...] = (
    _plc("TS_brg_f", "spindle.bearing.front", lambda w, a, f: f.at("quill", 0.8)),
    _plc("TS_brg_r", "spindle.bearing.rear", lambda w, a, f: f.at("quill", 0.15)),
    _plc("T_mot_S", "spindle.motor", lambda w, a, f: f.tanks["winding"], 20.0),
    _plc("T_mot_X", "axis.x.motor", lambda w, a, f: f.tanks["motor_x"], 20.0),
    _plc("T_mot_Z", "axis.z.motor", lambda w, a, f: f.tanks["motor_z"], 20.0),
    Sensor("n_S", "rotational_speed", "spindle", "plc", lambda w, a, f: w.speed, 0, 1.0, 1.0),
    Sensor("P_S", "power", "spindle", "plc", lambda w, a, f: _spindle_kw(w), 5.0, 0.05, 0.01),
    Sensor("v_X", "feed", "axis.x", "plc", lambda w, a, f: w.feed_x, 0, 0.0, 0.001),
    Sensor("v_Z", "feed", "axis.z", "plc", lambda w, a, f: w.feed_z, 0, 0.0, 0.001),
    Sensor("pos_Z", "position", "axis.z", "plc", lambda w, a, f: w.pos_z, 0, 0.0, 0.001),
    Sensor("M_cool", "state", "coolant", "plc", lambda w, a, f: w.coolant),
    Sensor("n_tool", "rotational_speed", "turret", "plc", lambda w, a, f: w.tool_speed, 0, 1.0, 1.0),
    Sensor("p_hyd", "pressure", "hydraulics", "plc", lambda w, a, f: 38 + 14 * w.pump, 10.0, 0.4, 0.1),
    _pt("C01_nutZ", "axis.z.nut", lambda w, a, f: f.at("screw_z", 0.6)),
    _pt("C02_nutX", "axis.x.nut", lambda w, a, f: f.at("screw_x", 0.6)),
    _pt("C03_guide", "axis.z.guide", lambda w, a, f: f.at("saddle", 0.1)),
    _pt("C04_foot", "headstock", lambda w, a, f: f.at("headstock", 0.15)),
    _pt("C05_bedtop", "bed.covers", lambda w, a, f: f.at("bed", 0.95)),
    _pt("C06_bedlow", "bed.feet", lambda w, a, f: f.at("bed", 0.05)),
    _pt("C07_rib", "rear_wall", lambda w, a, f: f.at("rib", 0.1)),
    _pt("C08_turret", "turret.disc", lambda w, a, f: f.at("turret", 0.4)),
    _pt("C09_bracket", "fixture", lambda w, a, f: f.at("bracket", 0.5), 30.0),
    _pt("C10_cool", "coolant.tank", lambda w, a, f: f.tanks["coolant"]),
    _pt("C11_oil", "hydraulics", lambda w, a, f: f.tanks["oil"]),
    _pt("C12_part", "workpiece", lambda w, a, f: f.at("part", 0.1)),
    _pt("C13", None, lambda w, a, f: f.at("headstock", 0.6)),
    _air("A1_high", "hall.top", lambda w, a, f: a.high),
    _air("A2_low", "hall.bottom", lambda w, a, f: a.low),
    _air("A3_floor", "floor", lambda w, a, f: a.floor),
    Sensor("A4_rh", "humidity", "hall", "hall", lambda w, a, f: a.humidity, 120.0, 0.5, 0.1),
)
BY_NAME = {s.name: s for s in ALL}


def coarse(sensor: Sensor) -> Sensor:
    """The same as a control shows it that counts in whole kelvins."""
    return replace(sensor, resolution=1.0) if sensor.quantity == "temperature" else sensor
