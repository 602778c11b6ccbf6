"""A world as a laboratory would have it: CSV of four loggers a test, campaign file, model file; the truth apart."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.store.base.counting import counted
from thermodata.virtual.lathe.data import model_of
from thermodata.virtual.lathe.logged.recording import Run
from thermodata.virtual.lathe.programme import DT_S, TEST_KIND
from thermodata.virtual.lathe.right_names import RIGHT
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.lathe.world import AXES, World, make_world
from thermodata.virtual.new_folder import without_a_campaign

LOGGERS = ("plc", "logger", "hall", "probes")


def simulate_lathe(
    folder: Path,
    stratum: str,
    seed: int,
    *,
    hide: str | None = None,
    hours: float = 9.0,
    tests: int | None = None,
) -> dict[str, Any]:
    """Writes raw/, campaign.yaml, model.yaml, and truth/truth.json apart; the answer is that truth.

    A row every 30 s, times in UTC; gaps are rows that are not there. Raises UsageError for a folder that holds a
    campaign, for an unknown stratum and for an unknown cause.
    """
    import yaml

    folder = without_a_campaign(folder)
    world = make_world(stratum, seed, hours=hours, tests=tests, hide=hide)
    (folder / "raw").mkdir(parents=True, exist_ok=True)
    (folder / "truth").mkdir(exist_ok=True)
    for run in counted(world.runs, "tests"):
        for logger in LOGGERS:
            _write(folder / "raw" / f"{run.stretch.id}_{logger}.csv", world, run, logger)
    model = model_of(world).model_dump(mode="json", by_alias=True, exclude_defaults=True)
    model |= {"schema": "thermodata/model/1"}
    for name, data in (("campaign", campaign_file(world)), ("model", model)):
        text = yaml.safe_dump(data, sort_keys=False, width=120, allow_unicode=True)
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    truth = truth_of(world) | {"campaign_file": str(folder / "campaign.yaml"), "model_file": str(folder / "model.yaml")}
    (folder / "truth" / "truth.json").write_text(json.dumps(truth, indent=1), encoding="utf-8")
    return truth


def truth_of(world: World) -> dict[str, Any]:
    """What the laboratory doesn't know."""
    return {
        "machine": "lathe",
        "stratum": world.stratum,
        "meaning": STRATA[world.stratum].meaning,
        "seed": world.seed,
        "campaign": world.campaign,
        "response": f"d{world.axis}",
        "hidden": list(world.hidden),
        "base": list(world.base),
        "right": {c: [f"{e}:{','.join(names)}" for e, names in RIGHT[c].exact] for c in world.hidden},
        "faults": [asdict(f) for f in world.faults],
        "decoy_of": world.decoy_of,
        "rms_um": world.rms_um,
    }


def campaign_file(world: World) -> dict[str, Any]:
    """The campaign file: nothing in it tells the truth."""
    channels: dict[str, Any] = {
        f"d{a}": {
            "source": "probes",
            "signal": f"d{a} [um]",
            "quantity": "displacement",
            "unit": "um",
            "axis": a,
            "at": "tcp",
            "relative_to": "table",
            "calibration": f"scale_{a}",
        }
        for a in AXES
    }
    for s in world.sensors:
        channels[s.name] = {"source": s.source, "signal": s.name, "quantity": s.quantity, "unit": s.unit}
        channels[s.name] |= {"at": s.at} if s.at else {}
        if s.quantity == "temperature":
            channels[s.name] |= {"sensor": {"resolution": f"{s.resolution:g} K"}}
    return {
        "schema": "thermodata/campaign/1",
        "id": world.campaign,
        "machine": {"id": f"TC-{world.seed}", "description": "simulated turning centre"},
        "sources": {
            name: {"reader": "table", "files": f"raw/{{test}}_{name}.csv", "timezone": "UTC"} for name in LOGGERS
        },
        "channels": channels,
        "calibrations": {
            f"scale_{a}": {
                "kind": "scale",
                "axis": a,
                "gain": "1 um/um",
                "facing": f"-{a}",
                "increases_with": "approach",
            }
            for a in AXES
        },
        "tests": [
            {
                "id": r.stretch.id,
                "kind": TEST_KIND[r.stretch.heat.work.kind],
                "role": r.stretch.role,
                "conditions": dict(r.stretch.heat.work.conditions),
            }
            for r in world.runs
        ],
    }


def _write(path: Path, world: World, run: Run, logger: str) -> None:
    columns: Mapping[str, Float1D]
    if logger == "probes":
        columns, wrote = {f"d{a} [um]": run.displacement[i] for i, a in enumerate(AXES)}, run.probed
    else:
        mine = [s.name for s in world.sensors if s.source == logger]
        columns = {n: run.readings[n] for n in mine}
        wrote = run.valid[mine[0]] if mine else run.probed
    _csv(path, columns, wrote, run.stretch.start_unix_s)


def _csv(path: Path, columns: Mapping[str, Float1D], wrote: Bool1D, start_unix_s: float) -> None:
    start = datetime.fromtimestamp(round(start_unix_s), UTC)
    lines = [",".join(["time", *columns])]
    for i in np.flatnonzero(wrote):
        time = start + timedelta(seconds=DT_S * int(i))
        lines.append(",".join([f"{time:%Y-%m-%d %H:%M:%S}", *(f"{x[i]:.6g}" for x in columns.values())]))
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
