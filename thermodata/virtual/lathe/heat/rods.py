"""Heat conduction along the bodies of the machine: 1-D finite volumes, Crank-Nicolson, all bodies in one solve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dgtsv

from thermodata.plugin import Float1D

FloatND = np.ndarray[tuple[int, ...], np.dtype[np.float64]]


@dataclass(frozen=True, slots=True)
class Material:
    """k [W/m/K], rho_c [J/m3/K], alpha [1/K]."""

    k: float
    rho_c: float
    alpha: float


STEEL = Material(45.0, 7850 * 470.0, 11.7e-6)
CAST_IRON = Material(50.0, 7200 * 500.0, 10.5e-6)
ALUMINIUM = Material(160.0, 2700 * 900.0, 23.0e-6)


@dataclass(frozen=True, slots=True)
class Body:
    """A rod, or a plate along its thickness. area_m2: that the heat crosses. skin_m2: that meets the air, in all."""

    name: str
    length_m: float
    cells: int
    area_m2: float
    skin_m2: float
    material: Material


@dataclass(frozen=True)
class Stack:
    """Bodies side by side in one state vector; no heat crosses from one to the next but by what is added as power."""

    bodies: tuple[Body, ...]

    @cached_property
    def where(self) -> dict[str, slice]:
        ends = np.cumsum([b.cells for b in self.bodies])
        return {b.name: slice(int(e) - b.cells, int(e)) for b, e in zip(self.bodies, ends, strict=True)}

    @cached_property
    def capacity(self) -> Float1D:
        """Of each cell [J/K]."""
        return np.concatenate(
            [np.full(b.cells, b.material.rho_c * b.area_m2 * b.length_m / b.cells) for b in self.bodies]
        )

    @cached_property
    def skin(self) -> Float1D:
        """Surface of each cell that meets the air [m2]."""
        return np.concatenate([np.full(b.cells, b.skin_m2 / b.cells) for b in self.bodies])

    @cached_property
    def between(self) -> Float1D:
        """Conductance from each cell to the next [W/K], shape (cells - 1,), 0 where a body ends."""
        whole = np.concatenate(
            [np.append(np.full(b.cells - 1, b.material.k * b.area_m2 * b.cells / b.length_m), 0.0) for b in self.bodies]
        )
        return whole[:-1]

    def cell(self, body: str, share: float) -> int:
        """The cell of a body at a share of its length, 0 to 1."""
        part = self.where[body]
        size = part.stop - part.start
        return int(part.start + min(int(share * size), size - 1))

    def step(self, T: FloatND, dt_s: float, leak: FloatND, outside: FloatND, power: FloatND) -> FloatND:
        """The temperatures after dt_s. leak: conductance to `outside` [W/K] of each cell; power: heat put in [W].

        Each of shape (cells,), or (machines, cells) for several that know nothing of each other. Crank-Nicolson:
        second order in time and stable, so that the result does not hang on the step.
        """
        g = self.between
        flow = np.zeros_like(T)
        exchange = g * np.diff(T)
        flow[..., :-1] += exchange
        flow[..., 1:] -= exchange
        right = self.capacity / dt_s * T + 0.5 * (flow - leak * T) + leak * outside + power
        main = self.capacity / dt_s + 0.5 * leak
        main[..., :-1] += 0.5 * g
        main[..., 1:] += 0.5 * g
        # machines in one row, as bodies are: nothing is exchanged where one ends
        side = np.tile(np.append(-0.5 * g, 0.0), T.size // T.shape[-1])[:-1]
        return np.asarray(dgtsv(side, main.ravel(), side, right.ravel())[3]).reshape(T.shape)
