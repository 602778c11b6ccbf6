"""Channels of a laboratory beside the displacement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True)
class Sensor:
    """A channel: log, name in the log, place, resolution, the bodies it feels (none: what the control knows)."""

    log: str
    signal: str
    at: str
    step: float
    mix: str = ""
    quantity: str = "temperature"


UNITS: Mapping[str, str] = {
    "temperature": "degC",
    "rotational_speed": "rpm",
    "feed": "m/min",
    "power": "kW",
    "load": "%",
    "torque": "N m",
    "flow": "l/min",
    "humidity": "%",
    "irradiance": "W/m2",
    "state": "1",
}  # of most logs


class Logged(Protocol):
    @property
    def log(self) -> str: ...


def of_log(log: str, names: Iterable[str], sensors: Mapping[str, Logged]) -> list[str]:
    """Those of these channels that stand in a log."""
    return [name for name in names if sensors[name].log == log]
