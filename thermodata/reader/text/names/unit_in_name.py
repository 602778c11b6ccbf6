"""Units at the end of a name, and a name that says another unit than its file does: 'dZ [mm]' above 'µm'."""

from __future__ import annotations

import re

from thermodata.errors import UsageError
from thermodata.plugin import Signal
from thermodata.reader.text.names.header import split_unit
from thermodata.schema.units.conversion import delta_factor, linear_conversion
from thermodata.schema.units.signs import bare_unit
from thermodata.schema.units.unit import is_unit, normal_unit

# After a separator: unmistakable ones only.
AT_END = re.compile(
    r"(?:^|[_.\s-])(deg[CF]|[°º][CF]|[℃℉]|Celsius|Fahrenheit|k?rpm|RPM|rps|kW|um|µm|μm|mm|inch|thou|lpm|ipm|m?bar|"
    r"kPa|hPa|MPa|psi|mA|mV|Nm|urad|pct|%|‰|promille?|permille|"
    r"(?:mm|m|l|1|U)[_/](?:min))$"
)
_SPELLED = {"pct": "%", "promille": "permille", "promile": "permille", "fahrenheit": "degF"}
_WORDS = ("min", "in", "deg", "rev", "inc", "bit")  # of another kind than the file's unit, these are words
# '[10 nm]': what one count is, or how far the values may go
_COUNTED = re.compile(r"\s*\d+(?:[.,]\d+)?\s*(?:[^\W\d_]|[°%])")
_DEGREES = re.compile(r"°|º|˚|deg|grad", re.IGNORECASE)  # of an angle as much as of a temperature
_NEARLY = 1e-3


def unit_at_end(name: str) -> str | None:
    """The unit that a name ends with: 'x_mm' -> 'mm', 'level.mm' -> 'mm', 'F_mm_min' -> 'mm/min'; None where none."""
    match = AT_END.search(name.strip())
    return _SPELLED.get(match[1].lower(), match[1].replace("_", "/")) if match else None


def other_unit(name: str, unit: str | None, difference: bool = False) -> str | None:
    """The unit that a name says, where it contradicts that of its file; None where both mean one unit, or one says
    none. difference: whether the values are of a difference, to which 1 K is 1 degC."""
    own = split_unit(name)[1] or unit_at_end(name)
    if own is None or not unit or bare_unit(own) == bare_unit(unit) or any(map(_COUNTED.match, (own, unit))):
        return None
    if not (is_unit(own) and is_unit(unit)) or normal_unit(unit) == "dimensionless":
        return None
    try:
        factor, offset = (delta_factor(own, unit), 0.0) if difference else linear_conversion(own, unit)
    except UsageError:
        # a letter may be a phase or an axis, and a word no unit: 'current (A)' in 'V' is not told from 'voltage (A)'
        alone = len(own) == 1 and not name.rstrip().endswith("]")
        word = alone or own.casefold() in _WORDS or _DEGREES.fullmatch(own)
        return None if word else own
    return None if abs(factor - 1) < _NEARLY and abs(offset) < _NEARLY else own


def other_unit_note(signal: Signal) -> str | None:
    """What is told of a signal whose name contradicts the unit that its file says of it."""
    own = other_unit(signal.name, signal.unit)
    # what a scaling makes of a reading is in the file's unit, and its name may be of before
    if own is None or signal.scaling is not None:
        return None
    return f"'{signal.name}' says {own}, and the file gives it in {signal.unit}, which is taken"
