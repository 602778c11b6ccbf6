"""Faults of the logs, each with what is told of it; where they begin and how large they are is drawn by each make."""

from __future__ import annotations

import numpy as np

from .bodies import Array


def slipped(d: Array, um: float, at: int, dt_s: float, test: str) -> tuple[Array, str]:
    """A displacement [um] whose probe slips, shape (n,). at: the first sample after."""
    told = f"probe slips by {um:.1f} um in {test} at {at * dt_s / 3600:.2f} h"
    return d + um * (np.arange(len(d)) >= at), told


def come_loose(
    x: Array, air: Array, at: int, dt_s: float, sensor: str, test: str, share: float = 0.75
) -> tuple[Array, str]:
    """What a sensor reads that comes loose, shape (n,). at: the first sample after. share: of the air in it."""
    told = f"{sensor} comes loose in {test} at {at * dt_s / 3600:.2f} h"
    return np.where(np.arange(len(x)) < at, x, (1 - share) * x + share * air), told


def behind(minutes: int, test: str) -> str:
    return f"the control's clock is {minutes} min behind in {test}"
