"""Whether a jump test makes a probe that can exist: moves in mm that were um, or the reverse, scale all by 1000."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.calibration.jump.fit import JumpFit
from thermodata.calibration.result import Check, check
from thermodata.errors import UsageError
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.schema.units.conversion import delta_factor

# Of probes behind an amplifier in volts: eddy current 5 to 400 um/V, capacitive from 0.5, an LVDT of +-50 mm 5000.
COARSEST_UM_PER_V = 5000.0
FINEST_UM_PER_V = 0.2
# A probe that is so coarse, or so fine, is taken for one if its noise says so as well: what is to show thermal
# displacements reads to some micrometres, and no machine stands still to half a nanometre.
MOST_NOISE_UM = 5.0
LEAST_NOISE_UM = 0.0005


def probe_exists(spec: JumpCalibration, moves_um: Sequence[float], fit: JumpFit, unit: str) -> Check | None:
    """The row of a probe that reads volts; None of others, and where a data sheet says what it is."""
    if spec.gain is not None:
        return None
    try:
        gain = abs(fit.gain) / delta_factor(unit, "V")
    except UsageError:
        return None
    if abs(delta_factor(unit, "V") - 1.0) > 1e-9:
        return None  # bare mV come from bridges, of any sensitivity
    fine = gain < FINEST_UM_PER_V and fit.noise_um < LEAST_NOISE_UM
    coarse = gain > COARSEST_UM_PER_V and fit.noise_um > MOST_NOISE_UM
    limit = FINEST_UM_PER_V if fine else COARSEST_UM_PER_V
    taken, right, size = ("um", "mm", 1.0) if fine else ("mm", "um", 1000.0)
    moves = ", ".join(f"{m / size:+g}" for m in moves_um[:3])
    advice = (
        f"no displacement probe has {gain / size:.4g} {taken}/V with a noise of {fit.noise_um:.3g} um: are the moves "
        f"{moves} {right} rather than {taken}?"
    )
    return check("probe_um_per_v", gain, limit, not (fine or coarse), advice)
