"""A world as the dataset that its logs give after ingest: means of the valid samples of each bin, states held."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.files.model import Model
from thermodata.schema.units.value import value_in
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData
from thermodata.virtual.described import described
from thermodata.virtual.gantry.plan import AXES, STEP_S
from thermodata.virtual.gantry.world import Run, World, make_world


def dataset(
    hide: str = "none",
    seed: int = 0,
    step_s: float = 60.0,
    *,
    tests: int | None = None,
    hours: float = 12.0,
    measured: bool = True,
) -> tuple[Dataset, Model]:
    """The data that the logs of this world give after ingest, and the lab's baseline model; no files are written.

    Sensor noise and resolution are in it; displacements are in um along the machine's axes.
    """
    world = make_world(hide, seed, tests=tests, hours=hours, measured=measured)
    return to_dataset(world, step_s), world.baseline()


def to_dataset(world: World, step_s: float) -> Dataset:
    """Every test on a grid of step_s [s], a multiple of 10 s."""
    infos = described(world.sensors)
    for a in AXES:
        infos[f"d{a}"] = ChannelInfo(f"d{a}", "displacement", "um", at="tcp", axis=a, relative_to="table", source="daq")
    tests = tuple(_test(world, r, step_s, infos, i) for i, r in enumerate(world.runs))
    return Dataset(step_s, tests, infos, data_version=f"virtual-{world.hide}-{world.seed}")


def _test(world: World, run: Run, step_s: float, infos: dict[str, ChannelInfo], number: int) -> TestData:
    op = run.op
    per = max(1, round(step_s / STEP_S))
    bins = op.n // per
    values: dict[str, Float1D] = {}
    valid: dict[str, Bool1D] = {}
    for s in world.sensors:
        x = run.readings[s.name][: bins * per].reshape(bins, per)
        values[s.name] = x[:, -1].copy() if s.quantity == "state" else x.mean(axis=1)
        valid[s.name] = np.ones(bins, dtype=np.bool_)
    rng = np.random.default_rng([world.seed, 104_729, number])
    mask = op.measuring[: bins * per].reshape(bins, per)
    count = mask.sum(axis=1)
    for i, a in enumerate(AXES):
        fast = world.white_um * rng.standard_normal(bins * per) / np.sqrt(STEP_S / 2)
        x = (run.displacement[i, : bins * per] + fast).reshape(bins, per)
        mean = np.where(mask, x, 0.0).sum(axis=1) / np.maximum(count, 1)
        values[f"d{a}"] = np.where(count > 0, mean, np.nan)
        valid[f"d{a}"] = count > 0
    conditions: dict[str, float | str] = {"spindle": world.spindle}
    for key, text in op.conditions.items():
        unit = {"speed": "rpm", "table_speed": "rpm", "feed": "m/min"}.get(key)
        conditions[key] = value_in(text, unit) if unit else text
    t_s = np.asarray(np.arange(bins) * step_s, dtype=np.float64)
    return TestData(
        world.campaign,
        op.id,
        op.kind,
        op.role,
        t_s,
        values,
        valid,
        np.ones(bins, dtype=np.bool_),
        conditions,
        dict(op.phases),
        start_unix_s=run.start_unix_s,
        machine=world.machine_id,
        channels=infos,
    )
