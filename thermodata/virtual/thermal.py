"""Steps the network through all tests of a campaign at once and keeps what is asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_matrix

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.losses import COPPER, VISCOUS, source_powers
from thermodata.virtual.machine import Machine
from thermodata.virtual.network import Stepper
from thermodata.virtual.plan import STEP_S, Operation

REFERENCE = 20.0
SOAK_STEPS = 540  # an hour and a half at rest before each test


def run(
    machine: Machine, ops: Sequence[Operation], boundary: Sequence[Float2D], observe: Float2D, rng: np.random.Generator
) -> list[Float2D]:
    """Temperatures seen through `observe`, shape (outputs, size): for each test an array (outputs, n).

    All tests have one length. Each starts from rest in the air of its first minute, the frame a little off.
    """
    n, tests = ops[0].n, len(ops)
    names = list(machine.sources)
    into = csr_matrix(np.stack([machine.sources[k] for k in names], axis=1))
    powers = [source_powers(machine, op) for op in ops]
    p = np.stack([[w.get(k, np.zeros(n)) for k in names] for w in powers], axis=-1)  # (sources, n, tests)
    p = np.ascontiguousarray(p.transpose(1, 0, 2))  # (n, sources, tests)
    outside = np.ascontiguousarray(np.stack(list(boundary), axis=-1).transpose(1, 0, 2))  # (n, boundaries, tests)
    c, h = machine.cells, machine.heat
    viscous = [
        (
            names.index(k),
            c[
                {"bearing_front": "bearing_front_outer", "bearing_rear": "bearing_rear_outer", "sleeve": "nose_sleeve"}[
                    k
                ]
            ][0],
        )
        for k in VISCOUS
    ]
    copper = [(names.index(k), c["stator"][0]) for k in COPPER]
    nuts = [
        (
            c[f"nut_{a}"][0],
            c[f"screw_{a}"],
            np.stack([machine.screw_share(i, op.stroke[i, 0], op.stroke[i, 1]) for op in ops], axis=-1).transpose(
                1, 0, 2
            ),
        )
        for i, a in enumerate("xyz")
    ]  # (n, cells, tests)
    wet = np.stack([op.coolant for op in ops], axis=-1)  # (n, tests)
    washed = [(c[k], w / len(c[k])) for k, w in machine.wash_w_per_k.items()]
    chiller = c["chiller"][0]
    fluid = machine.network.boundaries.index("fluid")
    stepper = Stepper(machine.network, STEP_S)

    setpoint = outside[0, 1] + rng.uniform(-0.5, 0.5)
    band = machine.chiller_band_k / 2
    cooling = (rng.random(tests) < 0.5).astype(np.float64)
    temperature = _at_rest(machine, outside[0], setpoint)
    slow = np.concatenate([c["bed"], c["portal"]])
    temperature[slow] += 0.05 * rng.standard_normal(tests)
    seen = np.empty((n, observe.shape[0], tests))
    rest = np.zeros_like(p[0])
    rest[names.index("cabinet")] = h["cabinet"] * 0.25
    watch = csr_matrix(observe)
    for k in range(-SOAK_STEPS, n):
        i = max(k, 0)
        q_in = rest if k < 0 else p[i]
        if k >= 0:
            q_in = q_in.copy()
            for row, cell in viscous:
                q_in[row] *= np.exp(-h["viscosity"] * (temperature[cell] - REFERENCE))
            for row, cell in copper:
                q_in[row] *= 1 + h["copper"] * (temperature[cell] - REFERENCE)
        q = into @ q_in
        for nut, screw, share in nuts:
            flow = machine.nut_w_per_k * share[i] * (temperature[nut] - temperature[screw])
            q[screw] += flow
            q[nut] -= flow.sum(axis=0)
        if k >= 0 and wet[i].any():
            for cells, w in washed:
                q[cells] += w * wet[i] * (outside[i, fluid] - temperature[cells])
        tank = temperature[chiller]
        cooling = np.where(tank > setpoint + band, 1.0, np.where(tank < setpoint - band, 0.0, cooling))
        # the pump of the chiller warms it, so that it cycles in an idle machine too
        q[chiller] += 0.3 * machine.chiller_w - machine.chiller_w * cooling
        temperature = stepper.step(temperature, q, outside[i])
        if k >= 0:
            seen[i] = watch @ temperature
    return [np.ascontiguousarray(seen[:, :, j].T) for j in range(tests)]


def _at_rest(machine: Machine, outside: Float2D, setpoint: Float1D) -> Float2D:
    """Steady temperatures of the idle machine with the chiller at its set point, shape (size, tests)."""
    q = machine.sources["cabinet"][:, None] * np.full(outside.shape[1], machine.heat["cabinet"] * 0.25)
    chiller = machine.cells["chiller"][0]
    base = machine.network.steady(q, outside)
    unit = np.zeros_like(base)
    unit[chiller] = 1.0
    answer = machine.network.steady(unit, np.zeros_like(outside))
    return np.asarray(base + answer * (setpoint - base[chiller]) / answer[chiller])
