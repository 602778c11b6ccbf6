"""The machine as the blind benchmark takes it: as drawn, whatever imitates what, and little known.

Sizes are drawn from one range for all effects, known or not. A cause that others imitate, that shows in one test only
or that no locked test works stays as it is: laboratories have such machines, too.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.virtual.gantry.levers import Levers, Units, lever, present, spread
from thermodata.virtual.gantry.plan import Operation

SIZE_UM = (3.0, 12.0)  # [um] standard deviation in its best open test, of every effect
MOST_LOCKED = 3.0  # times as large as there, and no effect is larger in a locked test
FIRST = ("spindle_bearing", "ambient_frame")  # what a laboratory models first


def as_drawn(rng: np.random.Generator, hide: str, axis: int, units: Units, ops: Sequence[Operation]) -> Levers:
    """effect -> lever along X, Y, Z, shape (3,), for the effects that are present. units: micrometres at lever 1.

    With nothing hidden the machine has as few effects as a laboratory may know.
    """
    names = present(rng, hide, axis)
    if hide == "none":
        names = known(rng, names, hide, int(rng.integers(1, len(names) + 1)))
    return {e: lever(rng, e, axis, float(rng.uniform(*SIZE_UM)) / _size(e, units, ops)) for e in names}


def thinly(rng: np.random.Generator, hide: str, names: Sequence[str]) -> tuple[str, ...]:
    """What the model knows of the effects of a machine: from one to all but the hidden one, or all if none is."""
    return tuple(names) if hide == "none" else known(rng, names, hide, int(rng.integers(1, len(names))))


def known(rng: np.random.Generator, names: Sequence[str], hide: str, count: int) -> tuple[str, ...]:
    """So many of some effects, without the hidden one, in their order: what is modelled first, then any."""
    order = [e for e in FIRST if e in names] + [e for e in map(str, rng.permutation(list(names))) if e not in FIRST]
    chosen = [e for e in order if e != hide][:count]
    return tuple(e for e in names if e in chosen)


def _size(effect: str, units: Units, ops: Sequence[Operation]) -> float:
    """Of an effect at lever 1, in the open test in which it is largest [um]."""
    sizes = list(zip(spread(effect, units, ops), ops, strict=True))
    best = max(s for s, op in sizes if op.role != "locked")
    return max(best, max(s for s, _ in sizes) / MOST_LOCKED, 1e-9)
