"""A value as the straight line that made it of what the file says: for whoever checks a calibration by hand."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any


def offset_of(step: Mapping[str, Any]) -> str:
    """'20.0 um' of a calibration in an answer of `trace`; '' where it has no gain, or none is added."""
    if step.get("gain") is None or not step.get("offset_value"):
        return ""
    return f"{step['offset_value']} {(step['gain_unit'] or '').partition('/')[0]}".rstrip()


def sum_of(found: Mapping[str, Any]) -> str:
    """'gain * raw + offset = value' of a traced sample; '' where one straight line does not make the value."""
    sample, steps = found["sample"], [s for s in found["calibrations"] if s.get("gain") is not None]
    raw, value = (sample["raw"] or {}).get("raw_value"), sample["value"]
    if len(steps) != 1 or not isinstance(raw, int | float) or not isinstance(value, int | float):
        return ""
    gain, offset = steps[0]["gain"], steps[0].get("offset_value") or 0.0
    if not math.isclose(gain * raw + offset, value, rel_tol=1e-5, abs_tol=1e-9):
        return ""  # a unit or a scaling of the file stands between
    return f"{gain!r} * {raw!r} {offset:+.17g} = {value!r} {found['unit']}"
