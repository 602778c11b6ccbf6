"""Columns of numbers as text: a base64 of 4 or 2 bytes a value, where digits would take ten."""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np

from thermodata.plugin import Float1D

_LEVELS = 65534  # of an unsigned 16-bit integer; the last code is 'nothing there'
_MISSING = 65535


def packed(values: Float1D, coarse: bool = False) -> dict[str, Any]:
    """values: any shape, NaN is a gap. `coarse` keeps a value to 1/65534 of the column's span, else it is a float32."""
    if not coarse:
        raw = np.ascontiguousarray(values, dtype="<f4")
        return {"f4": _text(raw)}
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    step = (high - low) / _LEVELS or 1.0
    codes = np.full(values.shape, _MISSING, "<u2")
    there = np.isfinite(values)
    codes[there] = np.rint((values[there] - low) / step).astype("<u2")
    return {"u2": _text(codes), "low": low, "step": step}


def exactly(values: Float1D) -> dict[str, Any]:
    """Times need all their digits: a float64 in base64, or start, step and count where they are even."""
    n = len(values)
    if n > 2:
        step = float(values[-1] - values[0]) / (n - 1)
        even = values[0] + step * np.arange(n)
        # a clock that counts from 1970 has a quarter of a microsecond for its last digit
        nearly = max(1e-6 * abs(step), 2 * float(np.spacing(np.abs(values).max())))
        if np.abs(even - values).max() <= nearly:
            return {"start": float(values[0]), "step": step, "n": n}
    return {"f8": _text(np.ascontiguousarray(values, dtype="<f8"))}


def script_json(value: Any) -> str:
    """JSON for inside a script element: '</script>' in a string would end it, '<' as an escape can't."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _text(raw: Any) -> str:
    return base64.b64encode(raw.tobytes()).decode("ascii")
