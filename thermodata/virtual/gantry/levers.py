"""Which effects a machine has, and how its geometry carries each to the tool centre point.

Of a demonstration (`draw_levers`) the hidden effect must be one that a lab could find: big enough in several tests,
and not a copy of what the known effects do together. Sets of effects are drawn until the hidden one is so, and its
lever may grow a little. What judges the diagnosis takes them as they come (`as_drawn`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import lfilter

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.gantry.catalogue import EFFECTS
from thermodata.virtual.gantry.plan import STEP_S, Operation

Units = Sequence[Mapping[str, Float1D]]  # of each test, effect -> its course at lever 1, shape (n,) [um]
Levers = dict[str, Float1D]  # effect -> along X, Y, Z, shape (3,)
POOL = tuple(k for k in EFFECTS if k not in ("spindle_bearing", "ambient_frame"))
DETECTABLE_UM, DETECTABLE_LOCKED_UM = 2.7, 2.3  # [um] standard deviation: third best test, locked test
OWN_UM, LARGEST_UM, DRAWS = 1.1, 18.0, 40  # [um] what no other effect can imitate; [um] best test
EVERY = 30  # steps: one sample in 300 s is enough to compare shapes


def draw_levers(rng: np.random.Generator, hide: str, axis: int, units: Units, ops: Sequence[Operation]) -> Levers:
    """effect -> lever along X, Y, Z, shape (3,), for the effects that are present. units: micrometres at lever 1."""
    best: tuple[float, Levers] = (-1.0, {})
    for _ in range(DRAWS):
        levers = {e: _lever_that_is_seen(rng, e, axis, units, ops) for e in present(rng, hide, axis)}
        if hide == "none":
            return levers
        own = own_um(hide, levers, axis, units, ops)
        largest = max(spread(hide, units, ops)) * abs(levers[hide][axis])
        grow = float(np.clip(OWN_UM / max(own, 1e-9), 1.0, max(1.0, min(1.7, LARGEST_UM / largest))))
        levers[hide] = levers[hide] * grow
        if own * grow > best[0]:
            best = own * grow, levers
        if own * grow >= 0.999 * OWN_UM:
            break
    return best[1]


def own_um(
    effect: str,
    levers: Mapping[str, Float1D],
    axis: int,
    units: Units,
    ops: Sequence[Operation],
) -> float:
    """Root mean square of what the other effects, with any gains and slower by any lag, leave of `effect` [um]."""
    rows, wanted = [], []
    for unit, op in zip(units, ops, strict=True):
        if op.role == "locked":
            continue
        at = np.flatnonzero(op.measuring)[:: EVERY // 3 if not op.measuring.all() else EVERY]
        columns = [w[at] for e in levers if e != effect for w in _shapes(unit[e])]
        block = np.stack(columns, axis=1) if columns else np.zeros((len(at), 1))
        rows.append(block - block.mean(axis=0))
        target = levers[effect][axis] * unit[effect][at]
        wanted.append(target - target.mean())
    a, y = np.concatenate(rows), np.concatenate(wanted)
    scale = np.maximum(np.sqrt(np.mean(a**2, axis=0)), 1e-9)
    gains = np.linalg.lstsq(a / scale, y, rcond=1e-6)[0]
    return float(np.sqrt(np.mean((y - a / scale @ gains) ** 2)))


def _shapes(u: Float1D) -> list[Float2D]:
    out = [u]
    for tau_s in (1200.0, 5400.0):
        a = float(np.exp(-STEP_S / tau_s))
        out.append(np.asarray(lfilter([1 - a], [1.0, -a], u)))
    return out


def present(rng: np.random.Generator, hide: str, axis: int) -> tuple[str, ...]:
    """Four to six effects beside the hidden one; no two of one family, the hidden one's excepted."""
    chosen = ["spindle_bearing", "ambient_frame"]
    taken = {EFFECTS[e].family for e in chosen if e != hide}
    wanted = int(rng.integers(4, 7)) + (hide in chosen)
    for e in map(str, rng.permutation(list(POOL))):
        h = EFFECTS[e]
        if len(chosen) >= wanted:
            break
        if e == hide or h.family in taken or (h.only_z and axis != 2):
            continue
        taken.add(h.family)
        chosen.append(e)
    if hide != "none" and hide not in chosen:
        chosen.append(hide)
    return tuple(chosen)


def spread(effect: str, units: Units, ops: Sequence[Operation]) -> list[float]:
    """Standard deviation of an effect at lever 1 over the measured samples of each test [um]."""
    return [float(np.std(u[effect][op.measuring])) for u, op in zip(units, ops, strict=True)]


def _lever_that_is_seen(
    rng: np.random.Generator, effect: str, axis: int, units: Units, ops: Sequence[Operation]
) -> Float1D:
    """Drawn so that the effect is seen: in its best test, in three tests, in the locked one."""
    h = EFFECTS[effect]
    sizes = spread(effect, units, ops)
    ranked = sorted(sizes, reverse=True)
    third = ranked[min(2, len(ranked) - 1)]
    locked = max(s for s, op in zip(sizes, ops, strict=True) if op.role == "locked")
    size = max(
        float(rng.uniform(*h.rms_um)) / ranked[0],
        DETECTABLE_UM / max(third, 1e-9),
        DETECTABLE_LOCKED_UM / max(locked, 1e-9),
    )
    return lever(rng, effect, axis, min(size, LARGEST_UM / ranked[0]))


def lever(rng: np.random.Generator, effect: str, axis: int, size: float) -> Float1D:
    """Along X, Y, Z, shape (3,): `size` on the response's axis, of either sign, and a share of it on the others."""
    h = EFFECTS[effect]
    along = size * np.array(h.axes) * rng.uniform(0.5, 1.0, 3) * rng.choice([-1.0, 1.0], 3)
    along[axis] = size * rng.choice([-1.0, 1.0])
    return np.asarray(along)
