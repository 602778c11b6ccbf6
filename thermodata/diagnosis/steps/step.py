"""A step of the residual that was found."""

from __future__ import annotations

from dataclasses import dataclass

from thermodata.view.grid.dataset import TestData


@dataclass(frozen=True, slots=True)
class Step:
    test: TestData
    at_s: float
    size: float
    z: float  # times the usual change, of lines through both sides
    alone: float = 0.0  # times the most sudden other change of the test, where that tells
    within_s: float = 0.0
    beside: tuple[str, ...] = ()  # commands that change just then
    bare: bool = False  # alone among what no command makes
