"""Units with a power of ten or a fraction before them, for logs of whole numbers: '10^3/min', '1/10 °C', '0,1 µm'."""

from __future__ import annotations

import re
from functools import lru_cache

_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
# 1000 and 10 alone only before a stroke: 'dX [100 um]' and 'U [10 V]' may be ranges
_SCALED = re.compile(
    r"(?:10(?:\^|\*\*)(?P<power>-?\d{1,2})|10(?P<raised>⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]{1,2})|1[eE](?P<exponent>[+-]?\d{1,2})"
    r"|1/(?P<share>10{1,6})(?=\s*[*·×]?\s*[^\W\d_]|\s*[*·×]?\s*[°%])|(?P<fraction>0[.,]0{0,5}1)(?!\d)"
    r"|(?P<thousands>1000)(?=\s*(?:/|1/)))"
    r"\s*[*·×]?\s*(?P<unit>(?:1\s*/\s*|/\s*)?[^\W\d_].*|[°%].*)"
)


@lru_cache(maxsize=4096)
def scaled_unit(text: str) -> tuple[float, str]:
    """(factor, unit): '10^3/min' -> (1000.0, '/min'), '1/10 °C' -> (0.1, '°C'); (1.0, the text) where nothing stands
    before the unit.

    A factor behind it ('°C*10') is left alone: the value may be multiplied by it, or the unit.
    """
    found = _SCALED.fullmatch(text.strip().strip("[]()").strip())
    if found is None:
        return 1.0, text
    power = found["power"] or (found["raised"] or "").translate(_RAISED) or found["exponent"]
    if power:
        factor = float(f"1e{power}")
    elif found["share"]:
        factor = 1.0 / float(found["share"])
    else:
        factor = float((found["fraction"] or found["thousands"]).replace(",", "."))
    return factor, found["unit"]
