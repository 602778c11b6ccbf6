"""Units with a power of ten or a fraction before them, or a power of ten that divides them, for logs of whole numbers:
'10^3/min', '1/10 °C', '0,1 µm', 'x0.1 °C', '°C/10'."""

from __future__ import annotations

import math
import re
from functools import lru_cache

from thermodata.schema.units.signs import plain_letters

_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
# 1000 and 10 alone only before a stroke: 'dX [100 um]' and 'U [10 V]' may be ranges
_SCALED = re.compile(
    r"(?:[x×*]\s*(?=0[.,]))?(?:10(?:\^|\*\*)(?P<power>-?\d{1,2})|10(?P<raised>⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]{1,2})|1[eE](?P<exponent>[+-]?\d{1,2})"
    r"|1/(?P<share>10{1,6})(?=\s*[*·×]?\s*[^\W\d_]|\s*[*·×]?\s*[°%])|(?P<fraction>0[.,]0{0,5}1)(?!\d)"
    r"|(?P<thousands>1000)(?=\s*(?:/|1/)))"
    r"\s*[*·×]?\s*(?P<unit>(?:1\s*/\s*|/\s*)?[^\W\d_].*|[°º%].*)"
)
_DIVIDED = re.compile(r"(?P<unit>(?:[^\W\d_]|[°º%])[^/]*?)\s*/\s*(?P<by>10{1,6})")

_COUNTED = re.compile(
    r"(?P<share>1/)?(?P<number>\d+(?:[.,]\d+)?(?:[eE][+-]?\d{1,2})?)\s*[*·×]?\s*(?P<unit>[^\W\d_].*|[°º%].*)"
)


@lru_cache(maxsize=4096)
def scaled_unit(text: str) -> tuple[float, str]:
    """(factor, unit): '10^3/min' -> (1000.0, '/min'), '1/10 °C' and '°C/10' -> (0.1, '°C'); (1.0, the text) where
    nothing scales the unit.

    A factor that multiplies it ('°C*10', 'x1000 rpm') is left alone: it may be meant for the value, or for the unit.
    """
    bare = plain_letters(text).strip().strip("[]()").strip()
    found = _SCALED.fullmatch(bare)
    if found is None:
        divided = _DIVIDED.fullmatch(bare)
        return (1.0 / float(divided["by"]), divided["unit"]) if divided else (1.0, text)
    power = found["power"] or (found["raised"] or "").translate(_RAISED) or found["exponent"]
    if power:
        factor = float(f"1e{power}")
    elif found["share"]:
        factor = 1.0 / float(found["share"])
    else:
        factor = float((found["fraction"] or found["thousands"]).replace(",", "."))
    return factor, found["unit"]


def counted_unit(text: str) -> tuple[float, str] | None:
    """(how much one count is, its unit) where somebody declares that: '0.0078125 degC', '1/128 degC', '20 nm'. None of
    any other text. A file that says so may mean a range."""
    found = _COUNTED.fullmatch(plain_letters(text).strip())
    if found is None:
        return None
    number = float(found["number"].replace(",", "."))
    factor = 1.0 / number if found["share"] and number else number
    return (factor, found["unit"]) if factor > 0 and math.isfinite(factor) else None


def with_power_of_ten(factor: float, unit: str) -> str | None:
    """The unit that a count is of where a unit's values have such a factor before them: (0.1, 'um') -> '0.1 um',
    (10.0, 'um') -> '10^1 um'; None of another factor than a power of ten."""
    power = round(math.log10(factor)) if factor > 0 else 0
    if power == 0 or not math.isclose(factor, 10.0**power, rel_tol=1e-9):
        return None
    return f"10^{power} {unit}" if power > 0 else f"{10.0**power:.{-power}f} {unit}"
