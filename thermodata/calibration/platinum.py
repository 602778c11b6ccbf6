"""Platinum thermometers that are logged in ohm: the curve of IEC 60751, which no straight line follows to better than
a kelvin over the range of a machine."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.result import CalibrationResult
from thermodata.plugin import Float1D
from thermodata.schema.files.campaign import PlatinumCalibration

# IEC 60751: R = R0 (1 + A t + B t^2), and below 0 degC + C (t - 100) t^3 within the brackets; t in degC, -200 to 850
_A, _B, _C = 3.9083e-3, -5.775e-7, -4.183e-12
_COLDEST, _HOTTEST = -200.0, 850.0
_DIGIT = 1e-4  # of the ratio: the last one of the standard's table
R0_OHM = {"pt100": 100.0, "pt200": 200.0, "pt500": 500.0, "pt1000": 1000.0}
CURVE = "r0_ohm"  # key of a result's detail: readings go through the curve before gain and offset


def evaluate_platinum(name: str, spec: PlatinumCalibration) -> CalibrationResult:
    """The curve by its resistance at 0 degC; gain 1 and offset 0 of what comes out of it."""
    return CalibrationResult(
        name=name,
        kind=spec.kind,
        gain_unit="degC/ohm",
        detail={"unit_in": "ohm", "unit_out": "degC", CURVE: R0_OHM[spec.kind]},
    )


def degrees(ohm: Float1D, r0_ohm: float) -> Float1D:
    """The temperature [degC] at a resistance [ohm], both of shape (n,); NaN beyond the range of the standard."""
    ratio = np.asarray(ohm, dtype=np.float64) / r0_ohm
    with np.errstate(invalid="ignore"):
        ratio = np.where((ratio >= _ratio(_COLDEST) - _DIGIT) & (ratio <= _ratio(_HOTTEST) + _DIGIT), ratio, np.nan)
        t = (-_A + np.sqrt(_A * _A - 4 * _B * (1 - ratio))) / (2 * _B)
        cold = ratio < 1
        if cold.any():
            x = t[cold]
            for _ in range(6):  # Newton, from the curve above 0 degC: to rounding after four
                slope = _A + 2 * _B * x + _C * (4 * x - 300) * x * x
                x = x - (1 + _A * x + _B * x * x + _C * (x - 100) * x**3 - ratio[cold]) / slope
            t[cold] = x
    return np.asarray(t, dtype=np.float64)


def _ratio(t: float) -> float:
    return 1 + _A * t + _B * t * t + (_C * (t - 100) * t**3 if t < 0 else 0.0)
