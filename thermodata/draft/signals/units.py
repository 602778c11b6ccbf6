"""What a unit says about a quantity, and units that stand in a name."""

from __future__ import annotations

import re

from thermodata.errors import UsageError
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.unit_in_name import AT_END, unit_at_end
from thermodata.schema.units.conversion import converts as converts_to
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import CANONICAL_UNIT, STATES
from thermodata.schema.units.scale import scaled_unit
from thermodata.schema.units.signs import bare_unit
from thermodata.schema.units.unit import is_unit, normal_unit

_BY_UNIT: dict[str, tuple[str, ...]] = {
    "degC": ("temperature", "temperature_difference"),
    "degF": ("temperature", "temperature_difference"),
    "K": ("temperature", "temperature_difference"),
    "um": ("displacement",),
    "nm": ("displacement",),
    "pm": ("displacement",),
    "mm": ("position", "displacement"),
    "rpm": ("rotational_speed",),
    "turn/second": ("rotational_speed",),
    "V": ("voltage", "displacement"),
    "mV": ("voltage", "displacement"),
    "percent": ("load", "humidity"),
    "per_unit": ("load", "humidity"),
    "dimensionless": ("state",),
    "A": ("current",),
    "mA": ("current",),
    "kW": ("power",),
    "W": ("power",),
    "N*m": ("torque",),
    "W/m**2": ("irradiance",),
    "urad": ("tilt",),
    "deg": ("angle",),
    "bar": ("pressure",),
    "l/min": ("flow",),
    "ohm": ("resistance",),
    "m/min": ("feed",),
    "m": ("position", "displacement"),
    "cm": ("position",),
    "inch": ("position", "displacement"),
    "in": ("position", "displacement"),
    "thou": ("displacement",),
}
SHARES = ("percent", "permille", "‰", "per_unit")  # of what, their names say
# of 1, at the end of a name; a humidity ratio is kg of water to one of air
SHARE_WORDS = {"load": ("pu", "p.u.", "frac", "fract", "fraction", "ratio"), "humidity": ("pu", "frac", "fraction")}
_FREQUENCY = re.compile(r"[munkMG]?hz|1?/(?:ms|s|sec|h|d)|(?:s|h|d)(?:\^?-1|⁻¹)|cps", re.IGNORECASE)
_SLOPE = re.compile(r"[uμnm]?m/m")
_ANGLE = re.compile(r"[uμnm]?rad|m?deg|°|grad|gon|arcsec|arcmin|mas", re.IGNORECASE)
_ENERGY = re.compile(r"(?:Wh|J|[Cc]al|BTU)$")  # pint takes an energy for a torque
_LOOSE = ("label", "state", "load", "humidity", "tilt", "angle")  # pint turns any bare number into these
_COUNTS = re.compile(r"\[\s*(?P<all>\d+(?:[.,]\d+)?\s*(?P<unit>[^\W\d_][^\[\]]*|[°º%][^\[\]]*))\]\s*$")
_VALUE = re.compile(r"[/.](?:value|values|val|data|reading)(?:\[\d+\])?$", re.IGNORECASE)
_LABELS = re.compile(r"\s*\{[^{}]*\}$")
_INCH = re.compile(r"[XYZUVW][_ ]?(?P<said>(?:ERR|POS|ACT|CMD|DEV|DISP|COMP)[A-Z_ ]*)? ?\(IN\)$")
_VOLTS_AT_END = re.compile(r"(?<=[^_.\s])[_.\s]+(volts?)$", re.IGNORECASE)
_F_AT_END = re.compile(r"[_.\s(-]F\)?$")

_RATE_AT_END = re.compile(r"(?<=[^\s_])[_\s]+((?:mm|m|l)/(?:min|s)|U/min)$")  # not 1/min: 'T 1/min' is a smallest value


def rate_at_end(name: str) -> tuple[str, str | None]:
    """(the name without it, a unit with a stroke at its end or None): 'X feed m/min' -> ('X feed', 'm/min'), whose
    stroke parts no path of names."""
    match = _RATE_AT_END.search(name.strip())
    return (name.strip()[: match.start()], match[1]) if match else (name, None)


def described(text: str, quantity: str | None) -> str | None:
    """The unit at the end of what a file says of a signal, where it is one of its quantity: 'Istdrehzahl Grad/s'. Of
    one that nothing else tells of, the volts that are all that it says."""
    if quantity is None and normal_unit(text.strip()) in ("V", "mV"):
        return text.strip()
    last = text.split()[-1] if text.split() else ""
    said = split_unit(text)[1] or (last if "/" in last else "")
    return said if said and quantity is not None and is_unit(said) and may_be(said, quantity) else None


def without_value(name: str) -> str:
    """A path of names without a last one that says nothing: 'mc/probe/dZ_um/value' -> 'mc/probe/dZ_um'."""
    return _VALUE.sub("", name) or name


def volts_at_end(name: str) -> str | None:
    """The volts that a name ends with as a word: 'x_volt' -> 'volt'. Not that of 'Volt', which is its whole name."""
    match = _VOLTS_AT_END.search(name.strip())
    return match[1] if match else None


def without_volts(text: str) -> str:
    """A name without the volts that it ends with, which are its unit: 'probes x volt' is as 'probes x', in volts."""
    return _VOLTS_AT_END.sub("", text.strip())


def without_labels(name: str) -> str:
    """A name without Prometheus' labels behind it: 'displacement_um {axis="X"}' -> 'displacement_um'."""
    return _LABELS.sub("", name) or name


def inches(name: str) -> str | None:
    """The inch of 'X_ERR(IN)', in capitals as controls print; beside an axis alone, for 'COOLANT (IN)' is an inlet."""
    return "in" if _INCH.match(name.strip()) else None


def may_be_an_inlet(name: str) -> bool:
    """Whether an (IN) stands behind the letter of an axis alone: the inch of a control, or where a coolant comes in."""
    found = _INCH.match(name.strip())
    return found is not None and not found["said"]


def counts_or_range(name: str) -> str | None:
    """'10 nm' of 'd6Z [10 nm]': what one count is, or how far the values may go, which only the lab knows."""
    match = _COUNTS.search(name)
    return match["all"] if match and is_unit(match["unit"]) else None


def may_be_fahrenheit(name: str) -> bool:
    """Whether a name ends with an F that may be its unit, as in 'T_bearing_F', which may be the front one as well."""
    return _F_AT_END.search(name.strip()) is not None


def without_rate(name: str, unit: str | None) -> str:
    """A name without the unit at its end, where that is `unit` and a rate: 'feed_x_m_min' -> 'feed_x', whose 'min' is a
    minute and no smallest value."""
    written = unit_at_end(name)
    if written is None or "/" not in written or unit is None or normal_unit(written) != normal_unit(unit):
        return name
    return AT_END.sub("", name.strip()) or name


def quantities_of(unit: str) -> tuple[str, ...]:
    """Quantities that can have this unit, the likeliest first; () where none can.

    What is only a number with a name ('%', 'deg') is left to the name where several fit.
    """
    bare, normal = bare_unit(unit), normal_unit(scaled_unit(unit)[1])
    if _FREQUENCY.fullmatch(bare) or _SLOPE.fullmatch(bare) or _ENERGY.search(bare):
        return ()  # a frequency, a strain, or an energy, unless the name knows better
    if normal in _BY_UNIT:
        return _BY_UNIT[normal]
    return tuple(q for q in CANONICAL_UNIT if q not in _LOOSE and converts(unit, q))


def kelvins(unit: str) -> float | None:
    """How many K a unit is that counts from absolute zero ('mK', '0,1 K'), None where it is another."""
    scale, bare = scaled_unit(unit)
    size = {"K": 1.0, "dK": 0.1, "cK": 0.01, "mK": 0.001}.get(normal_unit(bare))
    return None if size is None else scale * size


def factor_to(unit: str, target: str) -> float:
    """How many of the target one of a unit is; 0 where it does not convert."""
    try:
        return abs(linear_conversion(unit, target)[0])
    except UsageError:
        return 0.0


def to_degc(unit: str) -> tuple[float, float]:
    """(factor, offset) from a unit of temperature to degC; as if it were degC where it is none."""
    try:
        return linear_conversion(unit, "degC")
    except UsageError:
        return 1.0, 0.0


def is_inclination(unit: str) -> bool:
    """Whether a unit is one of angles or of slopes, which a name may make a tilt: 'mm/m', 'µm/m', 'arcsec'."""
    bare = bare_unit(unit)
    return _SLOPE.fullmatch(bare) is not None or _ANGLE.fullmatch(bare) is not None


def converts(unit: str, quantity: str) -> bool:
    """Whether values in this unit can be values of this quantity."""
    return converts_to(unit, CANONICAL_UNIT[quantity])


def may_be(unit: str, quantity: str) -> bool:
    """Whether a unit is one of a quantity, of shares and angles too, which pint takes for any number."""
    if quantity in ("tilt", "angle"):
        return is_inclination(unit)
    if quantity in ("load", "humidity"):
        return normal_unit(unit) in SHARES
    return quantity not in STATES and converts(unit, quantity)
