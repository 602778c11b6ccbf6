"""Quantities, canonical units, and the one sign convention.

Sign: a displacement is positive when the tool centre point moves along the machine's + axis relative to
the table. Every channel comes to it by data (the jump test, or the probe's facing), never by a stray minus.
"""

from __future__ import annotations

from typing import Literal, get_args

from thermodata.errors import UsageError, nearest

Quantity = Literal[
    "displacement",
    "tilt",
    "angle",
    "temperature",
    "temperature_difference",
    "rotational_speed",
    "feed",
    "power",
    "load",
    "current",
    "torque",
    "position",
    "flow",
    "pressure",
    "humidity",
    "irradiance",
    "voltage",
    "resistance",
    "state",
    "label",
]
QUANTITIES: tuple[str, ...] = get_args(Quantity)

CANONICAL_UNIT: dict[str, str] = {
    "displacement": "um",
    "tilt": "urad",
    "angle": "deg",
    "temperature": "degC",
    "temperature_difference": "K",
    "rotational_speed": "rpm",
    "feed": "m/min",
    "power": "kW",
    "load": "%",
    "current": "A",
    "torque": "N m",
    "position": "mm",
    "flow": "l/min",
    "pressure": "bar",
    "humidity": "%",
    "irradiance": "W/m2",
    "voltage": "V",
    "resistance": "Ohm",
    "state": "1",
    "label": "1",
}

MEASURED = ("displacement", "tilt", "angle")  # what a model explains, or shows it
PROBED = frozenset({"displacement", "tilt"})  # what a probe reads at the tool, of an axis and with a sign
NOT_DRIVERS = PROBED | {"label"}  # no cause of a displacement
STATES = frozenset({"state", "label"})  # held between samples, and without a unit
# an axis that goes to and fro rubs either way, while its mean is nothing; power that a drive feeds back heats nothing
UNDIRECTED = frozenset({"rotational_speed", "feed", "load", "current", "torque"})
SECONDS_PER_UNIT = {"s": 1.0, "min": 60.0, "h": 3600.0}  # of the time constants of effects

# What each is, in the words of the people who log it.
QUANTITY_MEANING: dict[str, str] = {
    "displacement": "of the tool centre point, or of another place, along an axis; what is modelled",
    "tilt": "a small rotation, from two displacements and their distance",
    "angle": "where a rotary axis or a table stands",
    "temperature": "of a part, a fluid or the air",
    "temperature_difference": "between two places, where only the difference is logged",
    "rotational_speed": "of spindle, table or rotary axis",
    "feed": "speed of a linear axis",
    "power": "drawn by a drive or a machine",
    "load": "of a drive, as a share of what it may give",
    "current": "of a motor or a drive",
    "torque": "of a motor or a drive",
    "position": "where a linear axis stands",
    "flow": "of coolant, oil or air",
    "pressure": "of a fluid or of compressed air",
    "humidity": "relative, of the air",
    "irradiance": "of sunlight on the machine",
    "voltage": "of a sensor that is not calibrated, or of a drive",
    "resistance": "of a sensor that is not converted",
    "state": "on or off, open or closed: 1 or 0, held between samples",
    "label": "text, such as a program's or a tool's name; held, never averaged",
}


def canonical(quantity: str) -> str:
    """The canonical unit of a quantity."""
    if quantity not in CANONICAL_UNIT:
        raise UsageError(
            f"no quantity '{quantity}'",
            expected=", ".join(QUANTITIES),
            got=quantity,
            hint=f"did you mean '{close}'?" if (close := nearest(quantity, QUANTITIES)) else None,
        )
    return CANONICAL_UNIT[quantity]
