"""The regression of a jump test: commanded positions on plateau voltages, with a drift where it can be told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.calibration.jump.plateaus import Plateau
from thermodata.plugin import Float1D, Float2D

_COLLINEAR = 0.9  # |correlation| of position and time above which drift hides


@dataclass(frozen=True, slots=True)
class JumpFit:
    """gain [um/V], offset [um], the rest as in CalibrationResult; residual_um: shape (plateaus,)."""

    gain: float
    offset: float
    uncertainty_pct: float
    noise_um: float
    nonlinearity_pct: float | None
    drift_um: float | None
    drift_um_per_s: float | None
    residual_um: Float1D
    span_um: float


def fit_plateaus(plateaus: list[Plateau], levels_um: Float1D, move_uncertainty_um: float) -> JumpFit:
    """Weighted least squares of level = offset + gain * volts - drift * time over the plateaus.

    With three plateaus or more, and positions that don't just follow time, drift is a term of the regression. On
    a staircase, or with one move, it is taken from the slopes within the plateaus, where these agree; else None.

    The uncertainty joins the scatter about the line (or, with nothing left over, the plateaus' noise) with the
    axis's positioning over the span: that one is systematic, so more plateaus don't make it smaller.
    """
    t = np.array([p.t_s for p in plateaus])
    t = t - t.mean()
    v = np.array([p.mean for p in plateaus])
    per_volt = abs(float(np.polyfit(v, levels_um, 1)[0]))
    error_v = np.array([max(p.noise, 1e-12) / np.sqrt(max(p.n, 1)) for p in plateaus])
    sigma = np.hypot(per_volt * error_v, max(move_uncertainty_um, 1e-9) / np.sqrt(2.0))

    regressed = len(plateaus) >= 3 and abs(float(np.corrcoef(levels_um, t)[0, 1])) < _COLLINEAR
    drift_v, drift_error = (None, 0.0) if regressed else _drift_within(plateaus)
    if drift_v is not None:
        v = v - drift_v * t
    columns = [np.ones_like(v), v] + ([t] if regressed else [])
    beta, covariance, rest = _weighted(np.column_stack(columns), levels_um, sigma)
    gain = float(beta[1])
    drift = -float(beta[2]) if regressed else (None if drift_v is None else drift_v * gain)

    freedom = len(plateaus) - len(columns)
    span = float(np.ptp(levels_um))
    noise_v = np.sqrt(np.mean([p.noise**2 for p in plateaus]))
    noise_part = abs(gain) * float(np.sqrt(np.mean(error_v**2))) * np.sqrt(2.0) / span
    scatter = float(np.sqrt(covariance[1, 1])) / abs(gain) if freedom > 0 else 0.0
    drift_part = abs(gain) * drift_error * float(np.ptp(t)) / span
    uncertainty = 100.0 * float(np.sqrt(scatter**2 + noise_part**2 + drift_part**2 + (move_uncertainty_um / span) ** 2))
    nonlinear = freedom > 0 and len(np.unique(levels_um)) >= 3
    length = max(p.to_s for p in plateaus) - min(p.from_s for p in plateaus)
    return JumpFit(
        gain=gain,
        offset=-gain * float(v[0]),
        uncertainty_pct=uncertainty,
        noise_um=abs(gain) * float(noise_v),
        nonlinearity_pct=100.0 * float(np.max(np.abs(rest))) / span if nonlinear else None,
        drift_um=None if drift is None else drift * length,
        drift_um_per_s=drift,
        residual_um=rest,
        span_um=span,
    )


def _drift_within(plateaus: list[Plateau]) -> tuple[float | None, float]:
    """(drift [V/s] by the slopes within the plateaus, its standard error); None where it is not significant."""
    slopes = np.array([p.slope for p in plateaus])
    length = np.array([max(2 / 3 * (p.to_s - p.from_s), 1e-9) for p in plateaus])
    own = np.array([p.noise * np.sqrt(12.0 / max(p.n, 1)) for p in plateaus]) / length
    error = float(max(np.sqrt(np.mean(own**2)), np.std(slopes, ddof=1)) / np.sqrt(len(plateaus)))
    drift = float(np.average(slopes, weights=1.0 / np.maximum(own, 1e-12) ** 2))
    return (drift, error) if abs(drift) > 3 * error else (None, error)


def answer(plateaus: list[Plateau], levels_um: Float1D) -> float:
    """Another probe's answer to the same moves [its unit/um], drift removed where it can be told; NaN if no data."""
    v = np.array([p.mean for p in plateaus])
    fine = np.isfinite(v)
    if fine.sum() < 2 or np.ptp(levels_um[fine]) == 0:
        return float("nan")
    t = np.array([p.t_s for p in plateaus])[fine]
    level = levels_um[fine]
    columns = [np.ones_like(level), level]
    if len(t) >= 3 and abs(float(np.corrcoef(level, t)[0, 1])) < _COLLINEAR:
        columns.append(t - t.mean())
    return float(np.linalg.lstsq(np.column_stack(columns), v[fine], rcond=None)[0][1])


def _weighted(X: Float2D, y: Float1D, sigma: Float1D) -> tuple[Float1D, Float2D, Float1D]:
    """(coefficients, covariance scaled by the scatter, residuals) of weighted least squares."""
    weight = 1.0 / sigma
    scale = np.maximum(np.abs(X).max(axis=0), 1e-300)  # volts and seconds differ by orders
    A = X / scale * weight[:, None]
    beta = np.linalg.lstsq(A, y * weight, rcond=None)[0]
    rest = y - X / scale @ beta
    freedom = len(y) - X.shape[1]
    variance = float(np.sum((rest * weight) ** 2) / freedom) if freedom > 0 else 1.0
    covariance = np.linalg.pinv(A.T @ A) * variance / np.outer(scale, scale)
    return beta / scale, covariance, rest
