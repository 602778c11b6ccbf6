"""What the cRIO writes: TDMS with eddy probes in volts and Pt100s in degC, and the jump tests of the probes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.plugin import Float1D
from thermodata.virtual.gantry.logs.logbook import DWELL_S, MOVES_UM, PROBE_RANGE_V, Logbook
from thermodata.virtual.gantry.plan import STEP_S
from thermodata.virtual.gantry.world import Run, World

JUMP_RATE_HZ = 10.0


def write_test(path: Path, world: World, run: Run, book: Logbook, rate_hz: float, rng: np.random.Generator) -> None:
    """One test's recording; while an axis travels, the target is out of the probes' range and they rail."""
    op = run.op
    t = np.arange(int(op.n * STEP_S * rate_hz)) / rate_hz
    step = np.minimum((t / STEP_S).astype(np.int64), op.n - 1)
    away = ~op.measuring[step]
    um = np.stack([np.interp(t, op.t_s, d) for d in run.displacement])
    columns: dict[str, tuple[Float1D, str]] = {}
    for i, probe in enumerate(book.probes):
        cross = book.crosstalk * (um.sum(axis=0) - um[i])
        volts = probe.volts(um[i] + cross, rng, world.white_um)
        volts[away] = PROBE_RANGE_V
        columns[book.names[f"d{probe.axis}"]] = volts, "V"
    for s in world.sensors:
        if s.source == "daq":
            x = np.interp(t, op.t_s, run.readings[s.name]) + 0.3 * s.noise_k * rng.standard_normal(len(t))
            columns[book.names[s.name]] = np.round(x / s.resolution) * s.resolution, "degC"
    write_recording(path, columns, run.start_unix_s, 1.0 / rate_hz, {"test": op.id, "machine": world.machine_id})


def write_jump(path: Path, world: World, axis: int, book: Logbook, rng: np.random.Generator) -> None:
    """The axis moves the target by known steps; every probe is logged, so cross-talk shows."""
    levels = np.concatenate([[0.0, 0.0], np.cumsum([m + 0.3 * rng.standard_normal() for m in MOVES_UM])])
    per = int(DWELL_S * JUMP_RATE_HZ)
    ramp = int(0.4 * JUMP_RATE_HZ)
    moved = np.repeat(levels, per)
    moved = np.convolve(np.pad(moved, (ramp, ramp), mode="edge"), np.ones(ramp) / ramp, mode="same")[ramp:-ramp]
    drift = np.cumsum(rng.standard_normal(len(moved))) * 0.002
    columns: dict[str, tuple[Float1D, str]] = {}
    for i, probe in enumerate(book.probes):
        um = (moved if i == axis else book.crosstalk * moved) + drift
        columns[book.names[f"d{probe.axis}"]] = probe.volts(um, rng, world.white_um), "V"
    start = min(r.start_unix_s for r in world.runs) - 3600.0 * (3 - axis)
    write_recording(path, columns, start, 1.0 / JUMP_RATE_HZ, {"test": f"jump {'XYZ'[axis]}"})


def write_recording(
    path: Path, columns: dict[str, tuple[Float1D, str]], start_s: float, step_s: float, properties: dict[str, str]
) -> None:
    """columns: 'group/channel' -> (values, unit), shapes (n,), one a step_s from start_s [UTC s]."""
    from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

    start = np.datetime64(round(start_s * 1e6), "us")
    objects = [RootObject(properties={"name": path.stem, **properties})]
    objects += [GroupObject(g) for g in dict.fromkeys(name.split("/")[0] for name in columns)]
    for name, (values, unit) in columns.items():
        group, _, channel = name.partition("/")
        objects.append(
            ChannelObject(
                group,
                channel,
                values,
                properties={
                    "wf_start_time": start,
                    "wf_start_offset": 0.0,
                    "wf_increment": step_s,
                    "wf_samples": len(values),
                    "unit_string": unit,
                },
            )
        )
    with TdmsWriter(path) as writer:
        writer.write_segment(objects)
