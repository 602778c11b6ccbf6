"""Whether a gain has the unit of what drives its effect: a rule of the kit (`thermodata.testing.effect`)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from thermodata.plugin import Effect
from thermodata.testing.effect_drivers import start, variants

# quantities, and the part of a gain's unit by which it is linear in them
_PER_UNIT = (
    (frozenset({"temperature", "temperature_difference"}), "/K"),
    (frozenset({"power"}), "/kW"),
    (frozenset({"position"}), "/m/"),
    (frozenset({"*"}), "/u"),
)


def its_gains_have_the_units_of_what_drives_them(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        for quantities, mark in _PER_UNIT:
            roles = [n.role for n in effect.needs if n.quantity in quantities and n.role in drivers.values]
            others = [n for n in effect.needs if n.role in drivers.values and n.role not in roles]
            # the same in a unit of half the size: all that is told in it doubles, drivers and parameters
            more = {r: v * (2.0 if r in roles else 1.0) for r, v in drivers.values.items()}
            given = start(effect)
            wider = {p.name: given[p.name] * (2.0 if f"/{p.unit}" == mark else 1.0) for p in effect.params}
            once, twice = effect.basis(drivers, given), effect.basis(replace(drivers, values=more), wider)
            for gain, before, after in zip(effect.gains, once.T, twice.T, strict=True):
                power = _power(gain.unit, mark)
                if roles and power and not np.allclose(after, 2.0**power * before, rtol=1e-6, atol=1e-9):
                    how = "double" if power == 1 else f"go with the power {power}"
                    yield f"'{gain.name}' is in {gain.unit}, and its column does not {how} with {', '.join(roles)}"
                if roles and not others and gain.unit == "um" and mark == "/K":
                    yield f"'{gain.name}' is in um, and nothing but a temperature drives it: it is um/K"


def _power(unit: str, mark: str) -> int:
    """The power of what a unit is divided by: 2 of um/K2, um/K^2 or um/K²; 0 where it stands in no such place."""
    found = re.search(re.escape(mark) + r"(?:(?:\^|\*\*)?(\d)|([²³])|(?![A-Za-z]))", unit)
    if found is None:
        return 0
    return int(found[1]) if found[1] else {"²": 2, "³": 3}.get(found[2] or "", 1)
