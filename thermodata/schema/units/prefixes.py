"""Which of pint's units a lab can have meant: pint joins any prefix to any unit, and many of a lab's words are such.

It reads 'Grad' as 10**9 radians, 'PS' as petasiemens, 'cfm' as 10**-17 m, 'slpm' as a power, 'Min' as 25 km and 'dc'
as the speed of light. What none of our quantities is measured in is no unit here, so that it is asked for.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

# unit -> the prefixes that are usual with it
_PREFIXES: Mapping[str, str] = {
    "meter": "pico nano micro milli centi deci kilo",
    "gram": "micro milli kilo",
    "second": "nano micro milli",
    "ampere": "nano micro milli kilo",
    "volt": "nano micro milli kilo",
    "ohm": "micro milli kilo mega giga",
    "siemens": "micro milli",
    "farad": "pico nano micro milli",
    "henry": "micro milli",
    "coulomb": "pico nano micro milli",
    "watt": "micro milli kilo mega",
    "volt_ampere": "milli kilo mega",
    "watt_hour": "kilo mega",
    "joule": "micro milli kilo mega giga",
    "calorie": "kilo",
    "newton": "micro milli centi deca kilo mega",
    "force_kilogram": "",
    "pascal": "milli hecto kilo mega giga",
    "bar": "micro milli",
    "hertz": "milli kilo mega giga",
    "liter": "micro milli centi deci hecto",
    "kelvin": "micro milli centi deci",
    "radian": "nano micro milli",
    "degree": "milli",
    "arcsecond": "milli",
    "turn": "kilo",
    "revolution": "kilo",
    "revolutions_per_minute": "kilo",
    "lux": "kilo",
    "lumen": "kilo",
    "mole": "micro milli",
    "inch": "micro",
    "meter_Hg": "milli centi",
    "meter_H2O": "milli centi",
}
_ALONE_TEXT = """
minute hour day week year degree_Celsius delta_degree_Celsius degree_Fahrenheit delta_degree_Fahrenheit
degree_Rankine delta_degree_Rankine arcminute grade foot thou yard mile micron angstrom gallon
imperial_gallon cubic_centimeter horsepower metric_horsepower british_thermal_unit pound ounce metric_ton
force_pound pound_force_per_square_inch standard_atmosphere technical_atmosphere torr inch_Hg inch_H2O
standard_gravity percent permille per_unit ppm dimensionless count bit byte decibel counts_per_second
"""
_ALONE = frozenset(_ALONE_TEXT.split())


def usual(registry: Any, names: Iterable[str]) -> bool:
    """Whether each of pint's names is a unit with a prefix, if any, that a lab writes."""
    return all(_has_usual_prefix(registry, name) for name in names)


def _has_usual_prefix(registry: Any, name: str) -> bool:
    if name in _ALONE or name in _PREFIXES:
        return True
    return any(
        prefix in _PREFIXES[unit].split() for prefix, unit, _ in registry.parse_unit_name(name) if unit in _PREFIXES
    )
