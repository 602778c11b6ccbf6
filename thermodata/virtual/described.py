"""Sensors of a simulated machine as a campaign file describes them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.view.grid.dataset import ChannelInfo


class Logged(Protocol):
    """A sensor of any of the machines. resolution: in its unit; 0 where it has none."""

    @property
    def name(self) -> str: ...
    @property
    def quantity(self) -> str: ...
    @property
    def at(self) -> str | None: ...
    @property
    def source(self) -> str: ...
    @property
    def resolution(self) -> float: ...


def described(sensors: Iterable[Logged]) -> dict[str, ChannelInfo]:
    """By name; the resolution of temperatures only is declared."""
    return {
        s.name: ChannelInfo(
            s.name,
            s.quantity,
            CANONICAL_UNIT[s.quantity],
            at=s.at,
            source=s.source,
            resolution=s.resolution if s.quantity == "temperature" else None,
        )
        for s in sensors
    }
