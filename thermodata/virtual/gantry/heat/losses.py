"""Heat sources [W] from what the machine does, and the control's spindle power [kW]."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D
from thermodata.virtual.gantry.heat.machine import SCREW_CELLS, Machine
from thermodata.virtual.gantry.plan import MAX_SPEED, Operation

VISCOUS = ("bearing_front", "bearing_rear", "sleeve")  # losses that fall as the lubricant warms
COPPER = ("motor",)  # losses that rise with the winding's resistance


def source_powers(machine: Machine, op: Operation) -> dict[str, Float1D]:
    """Every source of the machine over one test, shape (n,) each, at the reference temperature of 20 degC."""
    h = machine.heat
    n = np.abs(op.speed) / MAX_SPEED
    turning = (n > 0).astype(np.float64)
    out = {
        "bearing_front": h["front"] * n ** h["bearing_exponent"],
        "bearing_rear": h["rear"] * n ** h["bearing_exponent"],
        # a motor turns badly at low speed: magnetising losses are there as soon as it turns
        "motor": h["motor_base"] * turning + h["motor"] * n**1.2 + 90.0 * op.cutting,
        "sleeve": h["sleeve"] * n ** h["sleeve_exponent"],
        "tool": h["tool"] * op.cutting,
        "part": h["part"] * (op.cutting + 0.7 * idle_power(op)),
        "table": h["table"] * (np.abs(op.table_speed) / 500.0) ** h["table_exponent"],
        "windage": h["windage"] * n**1.8,
        "cabinet": h["cabinet"] * (0.25 + 0.35 * op.drives + 0.4 * n + 0.08 * op.cutting + 0.02 * op.feed.sum(axis=0)),
        "pump": h["pump"] * op.pump,
    }
    for i, a in enumerate("xyz"):
        v = op.feed[i] / 10.0
        share = machine.screw_share(i, op.stroke[i, 0], op.stroke[i, 1])
        for k in range(SCREW_CELLS):
            out[f"screw_{a}_{k}"] = h["screw"] * v * share[k]
        out[f"nut_{a}"] = h["nut"] * v
        out[f"screw_bearing_{a}"] = 6.0 * v
        # a vertical axis is held by its motor; feeding adds friction, turning round adds acceleration
        holding = h["holding"] * (1.0 if a == "z" else 0.4)
        out[f"feed_motor_{a}"] = holding * op.drives + h["feed_motor"] * v**1.4
    return out


def idle_power(op: Operation) -> Float1D:
    """What the spindle draws without cutting [kW]."""
    n = np.abs(op.speed) / MAX_SPEED
    return np.asarray(0.04 * (n > 0) + 0.3 * n**1.5)


def spindle_power(op: Operation) -> Float1D:
    """What the control shows as spindle power [kW]."""
    return np.asarray(op.cutting + idle_power(op))
