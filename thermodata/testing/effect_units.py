"""Whether units are the library's, and a gain has that of what drives its effect: rules of the kit for effects."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from thermodata.plugin import Effect, Need
from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.schema.units.unit import compound_unit, difference_unit, is_unit
from thermodata.testing.effect_drivers import start, variants

# quantities, and the part of a gain's unit by which it is linear in them
_PER_UNIT = (
    (frozenset({"temperature", "temperature_difference"}), "/K"),
    (frozenset({"power"}), "/kW"),
    (frozenset({"position"}), "/m/"),
    (frozenset({"*"}), "/u"),
)
_TIMES = ("min", "h")  # what a gain may be by, whatever drives the effect
_PLAIN = ("1", "%", "Hz")  # of a parameter: a number, a share, a rate of samples
_ANY_UNIT = re.compile(r"/u(?![A-Za-z])")  # of what an effect of any quantity is driven by
# growth of an axis is by the metre, where its place is in millimetres; a torque that turns is a power
_BESIDE = {"position": "m", "torque": "kW"}
_POWER = re.compile(r"(?<=[A-Za-z%])(?:\^|\*\*)?[0-9²³]")


def its_units_are_those_of_the_library(effect: Effect) -> Iterator[str]:
    """Fits, checks and tables print values with the units that an effect states, and convert none of them."""
    own = [difference_unit(u) for u in (*CANONICAL_UNIT.values(), "min")]
    for param in effect.params:
        if param.unit not in _PLAIN and not _is_made_of(param.unit, own):
            yield f"'{param.name}' is in {param.unit!r}: a time is in min, a number in 1, others in {', '.join(own)}"
    by = list(dict.fromkeys(u for need in effect.needs for u in _units_of(need)))
    for gain in effect.gains:
        first, slash, rest = (_ANY_UNIT.sub("", gain.unit) if "u" in by else gain.unit).partition("/")
        if first != "um" or (slash and not _is_made_of(rest.replace("/", "*"), [*by, *_TIMES])):
            yield f"'{gain.name}' is in {gain.unit!r}: it is um, or um by {', '.join([*by, *_TIMES])}"


def _units_of(need: Need) -> list[str]:
    """What a gain may be by: the unit of a change of what drives it."""
    if need.quantity == "*":
        return ["u"]
    own = CANONICAL_UNIT.get(need.quantity, "1")
    return [difference_unit(own), *([_BESIDE[need.quantity]] if need.quantity in _BESIDE else [])]


def _is_made_of(unit: str, parts: Iterable[str]) -> bool:
    """Whether a unit is one of the others, or a product or quotient of them."""
    bare = _POWER.sub("", unit)
    known = {name for part in parts if part != "u" for name in _names(_POWER.sub("", part))}
    return is_unit(bare) and "degC" not in bare and _names(bare) <= known


def _names(unit: str) -> set[str]:
    """What pint calls the parts of a unit: {'meter', 'minute'} of m/min."""
    return set(re.findall(r"[A-Za-z_]+", compound_unit(unit, "*", "")))


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
