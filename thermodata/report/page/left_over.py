"""What a model leaves over: the residual of all open tests, what of it is slow, and the noise."""

from __future__ import annotations

import numpy as np

from thermodata.chart.decimate import block_mean
from thermodata.report.collected.data import ReportData
from thermodata.report.page.drawn import noise_of
from thermodata.report.words.glossary import NOISE
from thermodata.report.words.numbers import duration, number

SLOW_S = 1800.0
"""An error that keeps its sign for so long is systematic [s]."""
FEW = 2
"""Means of a calibration test, the last of them of less, that tell nothing slow."""


def what_is_left(data: ReportData) -> list[tuple[str, str, str]]:
    """(what, figure, note): the residual of all open tests, what of it is slow, and the noise; of the responses in the
    unit of the first."""
    tests = [p for p in data.tests if p.response in data.told_together]
    if not tests:
        return []
    step = tests[0].step_s
    whole = _rms([p.residual for p in tests])
    sizes = [max(1, round(SLOW_S / p.step_s)) for p in tests]
    # about zero by the fit, a calibration test of few such means has none that could keep a sign: alone it tells none
    telling = any(p.role != "calibration" or len(p.residual) > FEW * size for p, size in zip(tests, sizes, strict=True))
    slow = _rms([_slow(p.residual, size) for p, size in zip(tests, sizes, strict=True)]) if telling else None
    of = f", of {' and '.join(data.told_together)}" if len(data.responses) > 1 else ""
    noises = ((name, noise_of(data, name)) for name in data.told_together)
    noisy, noise = next(((name, n) for name, n in noises if n is not None), ("", None))
    length = NOISE.format(length=duration(step))
    rows = [
        ("left over in all open tests", whole, f"calibration and verification tests together{of}"),
        (f"of it, in means of {duration(SLOW_S)}", slow, "keeps its sign for long: systematic, not noise"),
        ("noise", noise, f"of {noisy}: {length}" if of else length),
    ]
    return [(what, number(value), note) for what, value, note in rows if value is not None]


def _slow(residual: np.ndarray, size: int) -> np.ndarray:
    """At each sample the mean of its block, so that a block weighs what it holds: the last one may hold one sample."""
    means = np.repeat(block_mean(residual, size), size)[: len(residual)]
    return np.where(np.isfinite(residual), means, np.nan)


def _rms(residuals: list[np.ndarray]) -> float | None:
    seen = np.concatenate([np.zeros(0), *(r[np.isfinite(r)] for r in residuals)])
    return float(np.sqrt(np.mean(seen**2))) if len(seen) else None
