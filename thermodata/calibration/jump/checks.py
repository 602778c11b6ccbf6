"""What a jump test is judged by: each check is one row of value, threshold, passed and advice."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.jump.fit import JumpFit
from thermodata.calibration.jump.limits import DWELL
from thermodata.calibration.jump.plateaus import Plateau
from thermodata.calibration.jump.plausible import probe_exists
from thermodata.calibration.result import Check, check
from thermodata.calibration.static import ratio_units
from thermodata.errors import UsageError
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.schema.units.quantity import delta_factor, split_value

DATA_SHEET_PCT = 10.0
UNCERTAINTY_PCT = 5.0
NONLINEARITY_PCT = 2.0
DRIFT_PCT = 5.0
NOISE_PCT = 5.0
CROSSTALK_PCT = 10.0


def rows(
    spec: JumpCalibration,
    moves: list[float],
    fit: JumpFit,
    crosstalk: dict[str, float],
    plateaus: list[Plateau],
    unit: str,
) -> list[Check]:
    """All checks of one jump test. unit: of the readings."""
    smallest = min(abs(m) for m in moves)
    noise_pct = 100.0 * fit.noise_um / smallest
    answers = {k: abs(c) for k, c in crosstalk.items() if np.isfinite(c)}
    table = [
        _at_most(
            "uncertainty_pct",
            fit.uncertainty_pct,
            UNCERTAINTY_PCT,
            "move further or more often: the axis's positioning weighs too much on these moves",
        ),
        _at_most(
            "noise_pct_of_move",
            noise_pct,
            NOISE_PCT,
            "larger moves, or look for the noise: earthing, a turning spindle, a loose probe",
        ),
    ]
    if fit.nonlinearity_pct is not None:
        advice = "the steps give different sensitivities: is the probe within its linear range?"
        table.append(_at_most("nonlinearity_pct", fit.nonlinearity_pct, NONLINEARITY_PCT, advice))
    if fit.drift_um is not None:
        advice = "let the machine and the probe's amplifier come to rest first"
        table.append(_at_most("drift_pct", 100.0 * abs(fit.drift_um) / fit.span_um, DRIFT_PCT, advice))
    if answers:
        most = max(answers, key=lambda k: answers[k])
        advice = (
            f"'{most}' answers this axis too: align the probes with the axes, or, where the nest is turned, give each "
            'axis a channel that derives from both: {derive: "(a + b) * ... um / 1 V"}'
        )
        table.append(_at_most("crosstalk_pct", answers[most], CROSSTALK_PCT, advice))
        advice = f"'{most}' answers the move of {spec.axis} more than '{spec.signal}': swapped cables?"
        table.append(check("answers_most", answers[most], 100.0, answers[most] < 100.0, advice))
    if spec.gain is not None:
        table.append(_data_sheet(spec, fit, unit))
    probe = probe_exists(spec, moves, fit, unit)
    if probe is not None:
        table.append(probe)
    dwell = float(np.median([p.to_s - p.from_s for p in plateaus[1:-1]])) if len(plateaus) > 2 else spec.dwell
    table.append(
        check(
            "dwell_s",
            dwell,
            spec.dwell,
            DWELL[0] * spec.dwell <= dwell <= DWELL[1] * spec.dwell,
            "the plateaus don't last as long as declared: are these the commanded moves?",
        )
    )
    return table


def _at_most(name: str, value: float, limit: float, advice: str) -> Check:
    return check(name, value, limit, value <= limit, advice)


def _data_sheet(spec: JumpCalibration, fit: JumpFit, unit: str) -> Check:
    assert spec.gain is not None
    value, written = split_value(spec.gain)
    advice = f"the data sheet says {spec.gain}, measured {fit.gain:.6g} um/{unit}: right probe, target and moves?"
    try:
        out, into = ratio_units(written, "gain")
        expected = abs(value) * delta_factor(out, "um") / delta_factor(into, unit)
    except UsageError:
        return check(
            "data_sheet_gain_pct", None, DATA_SHEET_PCT, False, f"gain '{spec.gain}' is not a displacement over {unit}"
        )
    off = 100.0 * abs(abs(fit.gain) / expected - 1.0) if expected else float("inf")
    return _at_most("data_sheet_gain_pct", off, DATA_SHEET_PCT, advice)
