"""A lathe as the blind benchmark judges it."""

from __future__ import annotations

from thermodata.virtual.lathe.data import channels_of, contribution, model_of, right_effect, to_dataset
from thermodata.virtual.lathe.right_names import RIGHT
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.lathe.world import make_world
from thermodata.virtual.truth.case import Case
from thermodata.virtual.truth.marking import Key


def case_of(stratum: str, seed: int) -> Case:
    """The machine of a seed in a stratum of the lathe."""
    world = make_world(stratum, seed)
    kind = STRATA[stratum]
    nothing = not world.hidden or kind.blind or kind.outside
    channels = channels_of(world)
    broken = next((f.channel for f in world.faults if f.kind in ("offset", "stuck", "wander")), None)
    return Case(
        stratum,
        seed,
        f"d{world.axis}",
        to_dataset(world),
        model_of(world),
        Key(world.hidden, RIGHT, broken),
        nothing,
        world.base,
        world.by_speed,
        {} if nothing else {cause: right_effect(world, cause, channels) for cause in world.hidden},
        tuple(contribution(world, r) for r in world.runs),
        world.faults,
        rounds=len(world.hidden),
        imitated=False,
    )
