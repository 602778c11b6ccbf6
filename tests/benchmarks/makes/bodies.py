"""Tables of a network of bodies, as text: `body number, ...` of one, `body-body number, ...` between two."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def pairs(text: str) -> dict[str, float]:
    """The number of each name; those of a name that stands twice are added."""
    said: dict[str, float] = {}
    for part in text.split(","):
        name, number = part.split()
        said[name] = said.get(name, 0.0) + float(number)
    return said


def varied(rng: np.random.Generator, text: str, by: float) -> dict[str, float]:
    """The numbers of a table as one machine has them. by: standard deviation of their logarithm."""
    return {name: number * float(np.exp(rng.normal(0, by))) for name, number in pairs(text).items()}


def conduction(at: Mapping[str, int], links: Mapping[str, float]) -> Array:
    """Heat into each body [W] by the temperatures [K] of all, shape (bodies, bodies). links: conductances [W/K]."""
    flow = np.zeros((len(at), len(at)))
    for pair, g in links.items():
        a, b = (at[name] for name in pair.split("-"))
        flow[[a, b, a, b], [a, b, b, a]] += np.array([-g, -g, g, g])
    return flow


def felt(at: Mapping[str, int], mix: str, temps: Array) -> Array:
    """What a sensor feels, shape (n,). mix: its bodies with their shares. temps: shape (n, bodies)."""
    return reduce(np.add, [share * temps[:, at[name]] for name, share in pairs(mix).items()])
