"""A thermal network of cells: rods, plates and lumps that store heat, links that conduct it, and air around them.

    C dT/dt = -K T + G T_b + q        C [J/K], K and G [W/K], q [W], T_b boundary temperatures [degC]

Integrated by backward Euler with one sparse LU for the whole campaign; sources q are taken from the step before.
All tests of a campaign are stepped together, as columns of one state matrix.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu

from thermodata.plugin import Float1D, Float2D

Cells = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Link:
    """Conductance [W/K] between cell `a` and cell (or boundary) `b`."""

    a: int
    b: int
    w_per_k: float


class Builder:
    """Collects bodies and links; `network()` freezes them."""

    def __init__(self, boundaries: Sequence[str]) -> None:
        self.boundaries = tuple(boundaries)
        self.capacity: list[float] = []
        self.links: list[Link] = []
        self.outside: list[Link] = []
        self.cells: dict[str, Cells] = {}

    def body(self, name: str, capacity: float, n: int = 1, conductance: float = 0.0) -> Cells:
        """A chain of n cells with `capacity` [J/K] in all, neighbours joined by `conductance` [W/K]."""
        first = len(self.capacity)
        self.capacity += [capacity / n] * n
        cells = np.arange(first, first + n)
        self.links += [Link(int(i), int(i) + 1, conductance) for i in cells[:-1]]
        self.cells[name] = cells
        return cells

    def link(self, a: Sequence[int] | Cells | int, b: Sequence[int] | Cells | int, total: float) -> None:
        """Joins cells pairwise, or each with each where their numbers differ; the pairs share `total` [W/K]."""
        left, right = np.atleast_1d(a), np.atleast_1d(b)
        if len(left) != len(right):
            left, right = (x.ravel() for x in np.meshgrid(left, right))
        self.links += [Link(int(i), int(j), total / len(left)) for i, j in zip(left, right, strict=True)]

    def air(self, cells: Sequence[int] | Cells | int, boundary: str, total: float) -> None:
        """Convection of cells to a boundary; the cells share `total` [W/K]."""
        found = np.atleast_1d(cells)
        b = self.boundaries.index(boundary)
        self.outside += [Link(int(i), b, total / len(found)) for i in found]

    def network(self) -> Network:
        return Network(np.array(self.capacity), tuple(self.links), tuple(self.outside), self.boundaries)


@dataclass(frozen=True)
class Network:
    """capacity: shape (n,) [J/K]; links between cells, outside to boundaries."""

    capacity: Float1D
    links: tuple[Link, ...]
    outside: tuple[Link, ...]
    boundaries: tuple[str, ...]

    @property
    def size(self) -> int:
        return len(self.capacity)

    @cached_property
    def conduction(self) -> Any:
        """K, sparse, shape (n, n) [W/K]: what leaves each cell, to other cells and outside."""
        a = np.array([k.a for k in self.links])
        b = np.array([k.b for k in self.links])
        g = np.array([k.w_per_k for k in self.links])
        oa = np.array([k.a for k in self.outside])
        og = np.array([k.w_per_k for k in self.outside])
        rows = np.concatenate([a, b, a, b, oa])
        cols = np.concatenate([a, b, b, a, oa])
        return coo_matrix((np.concatenate([g, g, -g, -g, og]), (rows, cols)), (self.size, self.size)).tocsc()

    @cached_property
    def exchange(self) -> Any:
        """G, sparse, shape (n, boundaries) [W/K]."""
        return csr_matrix(
            (
                np.array([k.w_per_k for k in self.outside]),
                (np.array([k.a for k in self.outside]), np.array([k.b for k in self.outside])),
            ),
            (self.size, len(self.boundaries)),
        )

    def steady(self, sources: Float2D, boundary: Float2D) -> Float2D:
        """Temperatures at rest [degC]. sources: shape (n, k) [W]; boundary: shape (boundaries, k)."""
        return np.asarray(splu(self.conduction).solve(sources + self.exchange @ boundary))


class Stepper:
    """Backward Euler at a constant step [s]."""

    def __init__(self, network: Network, step_s: float) -> None:
        self.stored = (network.capacity / step_s)[:, None]
        self._lu = splu((diags(network.capacity / step_s) + network.conduction).tocsc())
        self._exchange = network.exchange

    def step(self, temperature: Float2D, sources: Float2D, boundary: Float2D) -> Float2D:
        """The temperatures one step later; shapes as in Network.steady."""
        return np.asarray(self._lu.solve(self.stored * temperature + sources + self._exchange @ boundary))
