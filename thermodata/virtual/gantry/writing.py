"""Writes a world as a lab would have it: raw logs, campaign file, model file; and the truth in a folder apart."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import UsageError
from thermodata.store.base.counting import counted
from thermodata.virtual.gantry.logs.describe import campaign_file, model_file, truth_file
from thermodata.virtual.gantry.logs.logbook import Logbook
from thermodata.virtual.gantry.logs.mcap import write_mcap
from thermodata.virtual.gantry.logs.nc import write_nc
from thermodata.virtual.gantry.logs.tdms import write_jump, write_test
from thermodata.virtual.gantry.plan import AXES
from thermodata.virtual.gantry.world import Run, World, make_world
from thermodata.virtual.new_folder import without_a_campaign


@dataclass(frozen=True, slots=True)
class Truth:
    """What is true of a simulated campaign. hidden: None where the baseline lacks nothing.

    drivers: role -> channel of the hidden effect. noise_um: slow noise of the probes. rms_um: effect -> test ->
    standard deviation of its contribution to the response [um]. campaign_file, model_file: what the lab has.
    """

    hidden: str | None
    family: str | None
    drivers: Mapping[str, str]
    response: str
    noise_um: float
    present: tuple[str, ...]
    rms_um: Mapping[str, Mapping[str, float]]
    seed: int
    campaign: str
    campaign_file: str
    model_file: str


def simulate(
    folder: Path,
    hide: str = "none",
    seed: int = 0,
    *,
    tests: int | None = None,
    hours: float = 12.0,
    rate_hz: float = 0.5,
    measured: bool = True,
    progress: Callable[[str], None] | None = None,
) -> Truth:
    """Simulates a campaign into `folder`: raw/, campaign.yaml, model.yaml, and truth/ apart.

    hide: an effect of `HIDEABLE`, which the machine has and the baseline lacks, or "none". rate_hz: of the cRIO.
    measured=False: the hidden effect's drivers aren't logged either. Raises UsageError for an unknown effect and
    for a folder that holds a campaign.
    """
    folder = without_a_campaign(folder)
    if not 0.1 <= rate_hz <= 10.0:
        raise UsageError("a rate that the simulation can't log", expected="0.1 to 10 Hz", got=f"{rate_hz} Hz")
    say = progress or (lambda _: None)
    world = make_world(hide, seed, tests=tests, hours=hours, measured=measured)
    book = Logbook.draw(world)
    raw = folder / "raw"
    raw.mkdir(parents=True, exist_ok=True)
    (folder / "truth").mkdir(exist_ok=True)
    for i, axis in enumerate(AXES):
        write_jump(raw / f"jump_{axis}.tdms", world, i, book, np.random.default_rng([seed, 32_452_843, i]))
    for number, run in enumerate(counted(world.runs, "tests")):
        rng = np.random.default_rng([seed, 49_979_687, number])
        write_test(raw / f"{run.op.id}.tdms", world, run, book, rate_hz, rng)
        write_nc(raw / f"{run.op.id}.csv", world, run, book)
        write_mcap(raw / f"{run.op.id}.mcap", world, run, book)
        _write_truth(folder / "truth" / f"{run.op.id}.parquet", run, world)
        say(f"{run.op.id}: {hours:g} h")
    _yaml(folder / "campaign.yaml", campaign_file(world, book))
    _yaml(folder / "model.yaml", model_file(world))
    truth = truth_file(world, book)
    (folder / "truth" / "truth.json").write_text(json.dumps(truth, indent=1), encoding="utf-8")
    return Truth(
        truth["hidden"],
        truth["family"],
        truth["drivers"],
        world.response,
        world.noise_um,
        world.present,
        world.rms_um,
        seed,
        world.campaign,
        str(folder / "campaign.yaml"),
        str(folder / "model.yaml"),
    )


def _yaml(path: Path, data: Mapping[str, Any]) -> None:
    """One line a source, channel, calibration, test and effect, as people write these files."""
    import yaml

    def flow(value: Any) -> str:
        return (
            yaml.safe_dump(value, sort_keys=False, allow_unicode=True, width=10_000, default_flow_style=True)
            .removesuffix("\n")
            .removesuffix("\n...")
        )

    lines = []
    for key, value in data.items():
        if isinstance(value, dict) and any(isinstance(v, dict) for v in value.values()):
            lines += [f"{key}:", *(f"  {flow(k)}: {flow(v)}" for k, v in value.items())]
        elif isinstance(value, list):
            lines += [f"{key}:", *(f"  - {flow(v)}" for v in value)]
        else:
            lines.append(f"{key}: {flow(value)}")
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")


def _write_truth(path: Path, run: Run, world: World) -> None:
    """t_s, dX, dY, dZ with the probes' slow noise, and <effect>_<axis>: every contribution [um]."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    columns: dict[str, Any] = {"t_s": run.op.t_s, "measuring": run.op.measuring}
    columns |= {f"d{a}": run.displacement[i] for i, a in enumerate(AXES)}
    for e in world.present:
        columns |= {f"{e}_{a}": run.contributions[e][i] for i, a in enumerate(AXES)}
    pq.write_table(pa.table(columns), path)
