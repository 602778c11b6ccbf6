"""A world as the dataset that its logs give after ingest, and the laboratory's model."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.modelling.inputs.coarse_readings import drawn
from thermodata.modelling.versions.candidate import candidate_spec
from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData
from thermodata.virtual.described import described
from thermodata.virtual.lathe.logged.recording import Run
from thermodata.virtual.lathe.programme import DT_S, TEST_KIND
from thermodata.virtual.lathe.right_names import RIGHT
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.lathe.world import AXES, TREAD_UM, World

STEP_S = 60.0


def model_of(world: World) -> Model:
    """The model that lacks what is hidden."""
    return Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "baseline",
            "campaign": world.campaign,
            "response": {"axis": world.axis, "at": "tcp"},
            "step": f"{STEP_S:g} s",
            "effects": [right_effect(world, c, channels_of(world)) for c in world.base],
        }
    )


def right_effect(world: World, cause: str, channels: Mapping[str, ChannelInfo]) -> EffectSpec:
    """What the library would add for a cause, on the nearest sensor that is logged. LookupError where none is."""
    exact = RIGHT[cause].exact
    if world.by_speed and cause in world.base:  # only the spindle's speed stands in the thin model
        exact = tuple(e for e in exact if "n_S" in e[1]) or exact
    for effect, names in exact:
        if all(n in channels for n in names):
            return candidate_spec(f"{effect}:{','.join(names)}", channels)
    raise LookupError(f"no sensor of '{cause}' is logged")


def channels_of(world: World) -> dict[str, ChannelInfo]:
    """Every channel as the campaign file describes it."""
    infos = described(world.sensors)
    tread = TREAD_UM if STRATA[world.stratum].staircase else None
    for a in AXES:
        infos[f"d{a}"] = ChannelInfo(
            f"d{a}", "displacement", "um", at="tcp", axis=a, relative_to="table", source="probes", resolution=tread
        )
    return infos


def to_dataset(world: World) -> Dataset:
    """Every test on a grid of `STEP_S`; temperatures in degC, displacement in um along the machine's axes."""
    infos = channels_of(world)
    tests = tuple(_test(world, r, infos) for r in world.runs)
    return drawn(Dataset(STEP_S, tests, infos, data_version=world.campaign))


def _test(world: World, run: Run, infos: dict[str, ChannelInfo]) -> TestData:
    per = round(STEP_S / DT_S)
    bins = run.displacement.shape[1] // per
    values: dict[str, Float1D] = {}
    valid: dict[str, Bool1D] = {}
    held = {s.name for s in world.sensors if s.quantity == "state"}
    courses = {n: (x, run.valid[n]) for n, x in run.readings.items()}
    courses |= {f"d{a}": (run.displacement[i], run.probed) for i, a in enumerate(AXES)}
    for name, (x, ok) in courses.items():
        x, ok = x[: bins * per].reshape(bins, per), ok[: bins * per].reshape(bins, per)
        count = ok.sum(axis=1)
        mean = x[:, -1] if name in held else np.where(ok, x, 0.0).sum(axis=1) / np.maximum(count, 1)
        values[name], valid[name] = np.where(count > 0, mean, np.nan), count > 0
    s = run.stretch
    return TestData(
        world.campaign,
        s.id,
        TEST_KIND[s.heat.work.kind],
        s.role,
        np.asarray(np.arange(bins) * STEP_S, dtype=np.float64),
        values,
        valid,
        np.ones(bins, dtype=np.bool_),
        dict(s.heat.work.conditions),
        start_unix_s=s.start_unix_s,
        machine=f"TC-{world.seed}",
        channels=infos,
    )


def contribution(world: World, run: Run) -> Float1D:
    """What the hidden causes do to the response in a test, on the grid of `to_dataset`, shape (n,) [um]."""
    row, per = AXES.index(world.axis), round(STEP_S / DT_S)
    bins = run.displacement.shape[1] // per
    total = sum((run.contributions[c][row] for c in world.hidden), np.zeros(run.displacement.shape[1]))
    return np.asarray(total[: bins * per].reshape(bins, per).mean(axis=1))
