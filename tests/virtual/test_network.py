"""Energy: what goes into the network comes out at rest, and is stored meanwhile."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.plugin import Float2D
from thermodata.virtual.gantry.heat.hall import BOUNDARIES
from thermodata.virtual.gantry.heat.machine import CONDUCTIVITY, RHO_C, Machine, build
from thermodata.virtual.gantry.heat.network import Builder, Network, Stepper


@pytest.fixture(scope="module")
def machine() -> Machine:
    return build(np.random.default_rng(5), np.array([400.0, 350.0, 240.0]))


def _outflow_w(network: Network, temperature: Float2D, boundary: Float2D) -> float:
    """Heat that leaves to the boundaries."""
    return float(sum(k.w_per_k * (temperature[k.a, 0] - boundary[k.b, 0]) for k in network.outside))


def test_at_rest_all_heat_leaves_to_the_surroundings(machine: Machine) -> None:
    air = np.full((len(BOUNDARIES), 1), 21.0)
    q = sum(machine.sources[k] * 100.0 for k in ("bearing_front", "motor", "cabinet", "nut_z", "table"))[:, None]
    t = machine.network.steady(q, air)
    assert _outflow_w(machine.network, t, air) == pytest.approx(500.0, rel=1e-9)
    assert t.min() >= 21.0 - 1e-9  # heat only warms


def test_without_sources_everything_is_as_warm_as_the_air(machine: Machine) -> None:
    air = np.full((len(BOUNDARIES), 2), 20.0)
    t = machine.network.steady(np.zeros((machine.network.size, 2)), air)
    np.testing.assert_allclose(t, 20.0, atol=1e-9)


def test_stored_heat_is_what_came_in_less_what_left(machine: Machine) -> None:
    net, step = machine.network, 10.0
    air = np.full((len(BOUNDARIES), 1), 20.0)
    q = (machine.sources["motor"] * 800.0)[:, None]
    stepper, t = Stepper(net, step), np.full((net.size, 1), 20.0)
    lost = 0.0
    for _ in range(360):
        t = stepper.step(t, q, air)
        lost += _outflow_w(net, t, air) * step
    stored = float(net.capacity @ (t[:, 0] - 20.0))
    assert stored + lost == pytest.approx(800.0 * 3600.0, rel=1e-9)
    assert stored > 0.1 * 800.0 * 3600.0


def test_stepping_ends_at_the_steady_state() -> None:
    b = Builder(("air",))
    rod = b.body("rod", 2000.0, 5, 3.0)
    b.air(rod, "air", 2.0)
    net = b.network()
    q = np.zeros((5, 1))
    q[0] = 50.0
    air = np.full((1, 1), 22.0)
    stepper, t = Stepper(net, 10.0), np.full((5, 1), 22.0)
    for _ in range(3000):
        t = stepper.step(t, q, air)
    np.testing.assert_allclose(t, net.steady(q, air), atol=1e-6)
    assert np.all(np.diff(t[:, 0]) < 0)  # hottest where the heat goes in


def test_a_rod_has_the_time_constant_of_the_heat_equation() -> None:
    length, area, n = 0.5, 1e-3, 40
    b = Builder(("end",))
    rod = b.body("rod", RHO_C * area * length, n, CONDUCTIVITY * area / (length / n))
    b.air(rod[-1], "end", CONDUCTIVITY * area / (length / n / 2))
    stepper, t = Stepper(b.network(), 10.0), np.full((n, 1), 1.0)
    zero, values = np.zeros((n, 1)), []
    for _ in range(1500):
        t = stepper.step(t, zero, np.zeros((1, 1)))
        values.append(t[0, 0])
    late = np.log(values[600:1400])
    tau = -10.0 / np.polyfit(np.arange(len(late)), late, 1)[0]
    assert tau == pytest.approx(4 * length**2 * RHO_C / (np.pi**2 * CONDUCTIVITY), rel=0.02)


def test_a_moving_nut_heats_the_part_of_the_screw_that_it_travels(machine: Machine) -> None:
    lo, hi = np.array([200.0]), np.array([280.0])
    share = machine.screw_share(2, lo, hi)[:, 0]
    assert share.sum() == pytest.approx(1.0)
    middle = machine.screw_start[2] + (np.arange(12) + 0.5) * machine.screw_length[2] / 12
    assert share[np.abs(middle - 240.0) > 200.0].sum() == 0.0
