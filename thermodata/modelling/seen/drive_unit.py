"""The unit of what drives a path, from the units of its channels."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.effect import law

Powers = Mapping[str, float]
"""Unit -> its power; nothing: a pure number."""


def over_unit(unit: str, *factors: Powers | None) -> str:
    """'um/K', 'um/rpm^2', 'um/(m/min)', 'um/(K mm/min)': a unit over that of a drive, the product of factors. The
    unit alone where the drive is a pure number, or has no unit (None)."""
    below = "" if any(f is None for f in factors) else written(times(*(f for f in factors if f is not None)))
    if not below:
        return unit
    return f"{unit}/({below})" if " " in below or "/" in below else f"{unit}/{below}"


def written(powers: Powers) -> str:
    """'K', 'rpm^2', '(m/min)^1.4', 'K mm/min'; '' of a pure number."""
    return " ".join(_to_the(unit, f"{power:g}") for unit, power in powers.items())


def _to_the(unit: str, power: str) -> str:
    """power: as it is shown, for a fitted one is 1 to a few digits only."""
    if power == "1":
        return unit
    return f"({unit})^{power}" if "/" in unit else f"{unit}^{power}"


def times(*factors: Powers) -> Powers:
    """The unit of a product."""
    found: dict[str, float] = {}
    for factor in factors:
        for unit, power in factor.items():
            found[unit] = found.get(unit, 0.0) + power
    return {unit: power for unit, power in found.items() if power}


def powers_of(node: law.Node, units: Mapping[str, str], reference: bool = False) -> Powers | None:
    """units: of the symbols, '1' of a pure number. reference: what is divided by a number is so by a reference in its
    own unit, as in abs(speed / 10000), which is a pure number then. None where it has no unit: a sum of different
    ones."""
    match node:
        case law.Binary("/", _, law.Number()) if reference:
            return {}
        case law.Symbol(name):
            unit = units.get(name, "1")
            return {} if unit in ("1", "") else {unit: 1.0}
        case law.Number() | law.Compare() | law.Logic():
            return {}
        case law.Absolute(of) | law.Lag(of) | law.Delay(of) | law.Filtered(of):
            return powers_of(of, units, reference)
        case law.Where(_, one, other) | law.Binary("+" | "-", one, other):
            known = [
                powers_of(part, units, reference) for part in (one, other) if not isinstance(part, law.Number)
            ] or [{}]
            return known[0] if all(part == known[0] for part in known) else None
        case law.Binary("**", base, law.Number(power)):
            own = powers_of(base, units, reference)
            return None if own is None else {unit: n * power for unit, n in own.items()}
        case law.Binary("*" | "/" as operator, left, right):
            a, b = powers_of(left, units, reference), powers_of(right, units, reference)
            if a is None or b is None:
                return None
            return times(a, b if operator == "*" else {unit: -n for unit, n in b.items()})
    return None
