"""Steps the network through all tests of a campaign at once and keeps what is asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_matrix

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.gantry.heat.losses import COPPER, VISCOUS, source_powers
from thermodata.virtual.gantry.heat.machine import Machine
from thermodata.virtual.gantry.heat.network import Stepper
from thermodata.virtual.gantry.plan import STEP_S, Operation

REFERENCE = 20.0
SOAK_STEPS = 540  # an hour and a half at rest before each test
# the cell whose warmth thins the oil of what rubs
WARMED_BY = {"bearing_front": "bearing_front_outer", "bearing_rear": "bearing_rear_outer", "sleeve": "nose_sleeve"}


def run(
    machine: Machine, ops: Sequence[Operation], boundary: Sequence[Float2D], observe: Float2D, rng: np.random.Generator
) -> list[Float2D]:
    """Temperatures seen through `observe`, shape (outputs, size): for each test an array (outputs, n).

    All tests have one length. Each starts from rest in the air of its first minute, the frame a little off.
    """
    n, tests = ops[0].n, len(ops)
    outside = np.ascontiguousarray(np.stack(list(boundary), axis=-1).transpose(1, 0, 2))  # (n, boundaries, tests)
    heat = _Heat(machine, ops, outside)
    chiller = _Chiller(machine, outside[0, 1] + rng.uniform(-0.5, 0.5), (rng.random(tests) < 0.5).astype(np.float64))
    temperature = _at_rest(machine, outside[0], chiller.setpoint)
    slow = np.concatenate([machine.cells["bed"], machine.cells["portal"]])
    temperature[slow] += 0.05 * rng.standard_normal(tests)
    stepper, watch = Stepper(machine.network, STEP_S), csr_matrix(observe)
    seen = np.empty((n, observe.shape[0], tests))
    for k in range(-SOAK_STEPS, n):
        i = max(k, 0)
        q = heat.into_cells(i, temperature, works=k >= 0)
        q[chiller.cell] += chiller.heat(temperature[chiller.cell])
        temperature = stepper.step(temperature, q, outside[i])
        if k >= 0:
            seen[i] = watch @ temperature
    return [np.ascontiguousarray(seen[:, :, j].T) for j in range(tests)]


class _Heat:
    """What the machine's work makes, and moves from cell to cell outside of the network, of all tests at once."""

    def __init__(self, machine: Machine, ops: Sequence[Operation], outside: Float2D) -> None:
        """outside: of the boundaries, shape (n, boundaries, tests)."""
        n, names, c = ops[0].n, list(machine.sources), machine.cells
        self.machine, self.outside = machine, outside
        self.into = csr_matrix(np.stack([machine.sources[k] for k in names], axis=1))
        powers = [source_powers(machine, op) for op in ops]
        p = np.stack([[w.get(k, np.zeros(n)) for k in names] for w in powers], axis=-1)  # (sources, n, tests)
        self.powers = np.ascontiguousarray(p.transpose(1, 0, 2))  # (n, sources, tests)
        self.at_rest = np.zeros_like(self.powers[0])
        self.at_rest[names.index("cabinet")] = machine.heat["cabinet"] * 0.25
        self.viscous = [(names.index(k), c[WARMED_BY[k]][0]) for k in VISCOUS]
        self.copper = [(names.index(k), c["stator"][0]) for k in COPPER]
        self.nuts = [
            (
                c[f"nut_{a}"][0],
                c[f"screw_{a}"],
                np.stack([machine.screw_share(i, op.stroke[i, 0], op.stroke[i, 1]) for op in ops], axis=-1).transpose(
                    1, 0, 2
                ),
            )
            for i, a in enumerate("xyz")
        ]  # (n, cells, tests)
        self.wet = np.stack([op.coolant for op in ops], axis=-1)  # (n, tests)
        self.washed = [(c[k], w / len(c[k])) for k, w in machine.wash_w_per_k.items()]
        self.fluid = machine.network.boundaries.index("fluid")

    def into_cells(self, i: int, temperature: Float2D, *, works: bool) -> Float2D:
        """Heat into each cell [W], shape (size, tests), at sample i. works: not while the machine soaks."""
        q = np.asarray(self.into @ (self._heat_made_w(i, temperature) if works else self.at_rest))
        for nut, screw, share in self.nuts:
            flow = self.machine.nut_w_per_k * share[i] * (temperature[nut] - temperature[screw])
            q[screw] += flow
            q[nut] -= flow.sum(axis=0)
        if works and self.wet[i].any():
            for cells, w in self.washed:
                q[cells] += w * self.wet[i] * (self.outside[i, self.fluid] - temperature[cells])
        return q

    def _heat_made_w(self, i: int, temperature: Float2D) -> Float2D:
        """By each source [W], shape (sources, tests): warm oil rubs less, and warm copper loses more."""
        made, heat = self.powers[i].copy(), self.machine.heat
        for row, cell in self.viscous:
            made[row] *= np.exp(-heat["viscosity"] * (temperature[cell] - REFERENCE))
        for row, cell in self.copper:
            made[row] *= 1 + heat["copper"] * (temperature[cell] - REFERENCE)
        return np.asarray(made)


class _Chiller:
    """Cools its tank between two temperatures about its set point, in each test by itself."""

    def __init__(self, machine: Machine, setpoint: Float1D, cooling: Float1D) -> None:
        """setpoint, cooling: shape (tests,); cooling is 1 where it begins on."""
        self.cell, self.power_w = machine.cells["chiller"][0], machine.chiller_w
        self.setpoint, self.band, self.cooling = setpoint, machine.chiller_band_k / 2, cooling

    def heat(self, tank: Float1D) -> Float1D:
        """Into the tank [W]; the next step is taken."""
        above, below = tank > self.setpoint + self.band, tank < self.setpoint - self.band
        self.cooling = np.where(above, 1.0, np.where(below, 0.0, self.cooling))
        # its pump warms it, so that it cycles in an idle machine too
        return np.asarray(0.3 * self.power_w - self.power_w * self.cooling)


def _at_rest(machine: Machine, outside: Float2D, setpoint: Float1D) -> Float2D:
    """Steady temperatures of the idle machine with the chiller at its set point, shape (size, tests)."""
    q = machine.sources["cabinet"][:, None] * np.full(outside.shape[1], machine.heat["cabinet"] * 0.25)
    chiller = machine.cells["chiller"][0]
    base = machine.network.steady(q, outside)
    unit = np.zeros_like(base)
    unit[chiller] = 1.0
    answer = machine.network.steady(unit, np.zeros_like(outside))
    return np.asarray(base + answer * (setpoint - base[chiller]) / answer[chiller])
