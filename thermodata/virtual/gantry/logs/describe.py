"""The campaign file, the model file and the truth of a world, as plain data."""

from __future__ import annotations

from typing import Any

from thermodata.virtual.gantry.catalogue import EFFECTS, drivers_of, family_of
from thermodata.virtual.gantry.logs.logbook import DWELL_S, MOVES_UM, Logbook, describe_probe
from thermodata.virtual.gantry.logs.nc import ZONE
from thermodata.virtual.gantry.plan import AXES, Operation
from thermodata.virtual.gantry.world import World


def campaign_file(world: World, book: Logbook) -> dict[str, Any]:
    """The campaign file of a lab: nothing in it tells the truth."""
    channels: dict[str, Any] = {}
    for probe in book.probes:
        name = f"d{probe.axis}"
        channels[name] = {"source": "daq", "signal": book.names[name], **describe_probe(probe)}
    for s in world.sensors:
        row: dict[str, Any] = {"source": s.source, "signal": book.names[s.name], "quantity": s.quantity}
        if s.source == "rec":
            row["unit"] = s.unit
        row["at"] = s.at
        sensor = {"serial": s.serial} if s.serial else {}
        if s.quantity == "temperature" and s.resolution:
            sensor["resolution"] = f"{s.resolution:g} K"
        channels[s.name] = row | ({"sensor": sensor} if sensor else {})
    return {
        "schema": "thermodata/campaign/1",
        "id": world.campaign,
        "machine": {
            "id": world.machine_id,
            "description": "simulated 5-axis upper-gantry milling centre",
            "spindle": world.spindle,
        },
        "sources": {
            "daq": {"reader": "crio", "files": "raw/{test}.tdms"},
            "nc": {
                "reader": "cnc",
                "files": "raw/{test}.csv",
                "timezone": ZONE,
                "encoding": "cp1250",
                "clock": {"offset": f"{book.nc_offset_s} s"},
            },
            "rec": {"reader": "mcap", "files": "raw/{test}.mcap", "clock": {"offset": f"{book.rec_offset_s} s"}},
        },
        "channels": channels,
        "calibrations": {
            f"jump_{p.axis}": {
                "kind": "jump",
                "axis": p.axis,
                "source": "daq",
                "file": f"raw/jump_{p.axis}.tdms",
                "signal": book.names[f"d{p.axis}"],
                "moves": [f"{m:g} um" for m in MOVES_UM],
                "dwell": f"{DWELL_S:g} s",
                "move_uncertainty": "0.5 um",
                "facing": p.facing,
                "increases_with": "gap",
            }
            for p in book.probes
        },
        "tests": [_test(r.op) for r in world.runs],
    }


def _test(op: Operation) -> dict[str, Any]:
    row: dict[str, Any] = {"id": op.id, "kind": op.kind, "role": op.role}
    if op.conditions:
        row["conditions"] = dict(op.conditions)
    if op.phases:
        row["phases"] = {k: [f"{a:g} s", f"{b:g} s"] for k, (a, b) in op.phases.items()}
    if not op.measuring.all():
        travels = [i for i in range(3) if (op.feed[i] > 0).any()]
        terms = [f"feed_{AXES[i]} == 0 and abs(pos_{AXES[i]} - {op.home[i]:g}) < 0.05" for i in travels]
        row["measuring"] = " and ".join(terms)
    return row


def model_file(world: World) -> dict[str, Any]:
    """The lab's baseline: every effect but the hidden one."""
    spec = world.baseline()
    return {
        "schema": "thermodata/model/1",
        "name": spec.name,
        "campaign": world.campaign,
        "response": {"axis": world.axis, "at": "tcp"},
        "step": "60 s",
        "effects": [{"effect": e.effect, "drivers": dict(e.drivers)} for e in spec.effects],
    }


def truth_file(world: World, book: Logbook) -> dict[str, Any]:
    """What the lab doesn't know."""
    hidden = None if world.hide == "none" else world.hide
    return {
        "seed": world.seed,
        "hidden": hidden,
        "family": family_of(hidden, world.axis) if hidden else None,
        "drivers": drivers_of(hidden, world.axis) if hidden else {},
        "meaning": EFFECTS[hidden].meaning if hidden else None,
        "campaign": world.campaign,
        "response": world.response,
        "axis": world.axis,
        "noise_um": world.noise_um,
        "present": list(world.present),
        "rms_um": world.rms_um,
        "levers": {e: dict(zip(AXES, map(float, v), strict=True)) for e, v in world.levers.items()},
        "probes_um_per_v": {p.axis: p.um_per_v for p in book.probes},
    }
