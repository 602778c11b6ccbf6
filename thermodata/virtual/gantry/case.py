"""The library's own machine as the blind benchmark judges it: one effect hidden, or none, or one not logged.

A stratum is the effect that is hidden in any case. How many of the others the model lacks is drawn (`as_drawn`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.errors import unknown_name
from thermodata.plugin import Float1D
from thermodata.schema.files.model import EffectSpec
from thermodata.virtual.gantry.as_drawn import as_drawn, thinly
from thermodata.virtual.gantry.binned import to_dataset
from thermodata.virtual.gantry.catalogue import EFFECTS, drivers_of
from thermodata.virtual.gantry.plan import STEP_S
from thermodata.virtual.gantry.right_names import names_of
from thermodata.virtual.gantry.world import Run, World, all_but_the_hidden_one, make_world
from thermodata.virtual.truth.case import Case
from thermodata.virtual.truth.marking import Key
from thermodata.virtual.truth.strata import Stratum

NONE = "none"
NOT_LOGGED = ", not logged"
_STEP_S = 60.0
STRATA: Mapping[str, Stratum] = {
    **{hide: Stratum(h.meaning, more=True) for hide, h in EFFECTS.items()},
    NONE: Stratum("nothing hidden, the model knows all that the machine has, from one effect on", hidden=0),
    **{
        f"{hide}{NOT_LOGGED}": Stratum(f"{h.meaning}, and no sensor tells it", blind=True)
        for hide, h in EFFECTS.items()
    },
}


def strata_of(hide: Sequence[str], *, logged: bool) -> tuple[str, ...]:
    """Of effects to hide, each in turn where none is named; logged: whether sensors tell what is hidden.

    UsageError for what can't be hidden; none has no sensors that could be left out.
    """
    choices = [*EFFECTS, *([NONE] if logged else [])]
    for name in hide:
        if name not in choices:
            raise unknown_name("effect to hide", name, choices)
    return tuple(name if logged else f"{name}{NOT_LOGGED}" for name in hide or choices)


def case_of(stratum: str, seed: int) -> Case:
    """The machine of a seed. A cause that is not logged is the only one that its model lacks."""
    blind = STRATA[stratum].blind
    world = make_world(
        stratum.removesuffix(NOT_LOGGED),
        seed,
        measured=not blind,
        draw=as_drawn,
        knows=all_but_the_hidden_one if blind else thinly,
    )
    hidden = tuple(e for e in world.present if e not in world.known)
    if blind:
        world = _without_sensors(world, hidden)
    names = names_of(world.axis, world.sensors)
    logged = {s.name for s in world.sensors}
    nothing = not any(logged.issuperset(channels) for e in hidden for _, channels in names[e].exact)
    return Case(
        stratum,
        seed,
        world.response,
        to_dataset(world, _STEP_S),
        world.baseline(),
        Key(hidden, names),
        nothing,
        world.known,
        by_speed=False,
        right={} if nothing else {e: EffectSpec(effect=e, drivers=dict(drivers_of(e, world.axis))) for e in hidden},
        contribution=tuple(_contribution(world, r, hidden) for r in world.runs),
        faults=(),
        rounds=1,
        imitated=True,
    )


def _without_sensors(world: World, hidden: tuple[str, ...]) -> World:
    """Without any channel that names what is hidden, but for those that the model needs."""
    names = names_of(world.axis, world.sensors)
    own = {c for e in hidden for _, channels in names[e].exact for c in channels}
    needed = {c for e in world.known for c in drivers_of(e, world.axis).values()}
    return replace(world, sensors=tuple(s for s in world.sensors if s.name not in own - needed))


def _contribution(world: World, run: Run, hidden: tuple[str, ...]) -> Float1D:
    """What the hidden effects do to the response in a test, on the grid of the data, shape (n,) [um]."""
    per = round(_STEP_S / STEP_S)
    total = sum((run.contributions[e][world.axis_index] for e in hidden), np.zeros(run.op.n))
    return np.asarray(total[: run.op.n // per * per].reshape(-1, per).mean(axis=1))
