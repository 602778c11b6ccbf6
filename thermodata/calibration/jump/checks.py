"""What a jump test is judged by: each check is one row of value, threshold, passed and advice."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.jump.fit import JumpFit
from thermodata.calibration.jump.limits import DWELL
from thermodata.calibration.jump.plateaus import Plateau
from thermodata.calibration.jump.plausible import probe_exists
from thermodata.calibration.result import Check, check
from thermodata.calibration.static import ratio_units
from thermodata.errors import UsageError
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.schema.units.conversion import delta_factor
from thermodata.schema.units.value import split_value

DATA_SHEET_PCT = 10.0
UNCERTAINTY_PCT = 5.0
NONLINEARITY_PCT = 2.0
DRIFT_PCT = 5.0
NOISE_PCT = 5.0
CROSSTALK_PCT = 10.0


@dataclass(frozen=True, slots=True)
class EvaluatedJump:
    """A jump test as it was evaluated. moves: the commanded ones [um]; crosstalk: other probe -> what it answers of the
    move [%]; plateaus: those between the moves, in order; unit: of the readings."""

    spec: JumpCalibration
    moves: Sequence[float]
    fit: JumpFit
    crosstalk: Mapping[str, float]
    plateaus: Sequence[Plateau]
    unit: str


def rows(seen: EvaluatedJump) -> list[Check]:
    """All checks of one jump test that can be made of it."""
    return [row for rule in _RULES if (row := rule(seen)) is not None]


def the_moves_tell_the_sensitivity(seen: EvaluatedJump) -> Check:
    advice = "move further or more often: the axis's positioning weighs too much on these moves"
    return _at_most("uncertainty_pct", seen.fit.uncertainty_pct, UNCERTAINTY_PCT, advice)


def the_noise_is_small_beside_the_moves(seen: EvaluatedJump) -> Check:
    smallest = min(abs(m) for m in seen.moves)
    advice = "larger moves, or look for the noise: earthing, a turning spindle, a loose probe"
    return _at_most("noise_pct_of_move", 100.0 * seen.fit.noise_um / smallest, NOISE_PCT, advice)


def all_steps_tell_the_same(seen: EvaluatedJump) -> Check | None:
    if seen.fit.nonlinearity_pct is None:
        return None
    advice = "the steps give different sensitivities: is the probe within its linear range?"
    return _at_most("nonlinearity_pct", seen.fit.nonlinearity_pct, NONLINEARITY_PCT, advice)


def nothing_drifts_meanwhile(seen: EvaluatedJump) -> Check | None:
    fit = seen.fit
    if fit.drift_um is None:
        return None
    advice = "let the machine and the probe's amplifier come to rest first"
    return _at_most("drift_pct", 100.0 * abs(fit.drift_um) / fit.span_um, DRIFT_PCT, advice)


def no_other_probe_answers(seen: EvaluatedJump) -> Check | None:
    if (most := _most_crosstalk(seen)) is None:
        return None
    advice = (
        f"'{most[0]}' answers this axis too: align the probes with the axes, or, where the nest is turned, give each "
        'axis a channel that derives from both: {derive: "(a + b) * ... um / 1 V"}'
    )
    return _at_most("crosstalk_pct", most[1], CROSSTALK_PCT, advice)


def the_probe_itself_answers_most(seen: EvaluatedJump) -> Check | None:
    if (most := _most_crosstalk(seen)) is None:
        return None
    advice = f"'{most[0]}' answers the move of {seen.spec.axis} more than '{seen.spec.signal}': swapped cables?"
    return check("answers_most", most[1], 100.0, most[1] < 100.0, advice)


def the_data_sheet_agrees(seen: EvaluatedJump) -> Check | None:
    return None if seen.spec.gain is None else _data_sheet(seen.spec.gain, seen.fit, seen.unit)


def such_a_probe_exists(seen: EvaluatedJump) -> Check | None:
    return probe_exists(seen.spec, seen.moves, seen.fit, seen.unit)


def the_plateaus_last_as_declared(seen: EvaluatedJump) -> Check:
    plateaus, declared = seen.plateaus, seen.spec.dwell
    dwell = float(np.median([p.to_s - p.from_s for p in plateaus[1:-1]])) if len(plateaus) > 2 else declared
    advice = "the plateaus don't last as long as declared: are these the commanded moves?"
    return check("dwell_s", dwell, declared, DWELL[0] * declared <= dwell <= DWELL[1] * declared, advice)


_RULES: Sequence[Callable[[EvaluatedJump], Check | None]] = (
    the_moves_tell_the_sensitivity,
    the_noise_is_small_beside_the_moves,
    all_steps_tell_the_same,
    nothing_drifts_meanwhile,
    no_other_probe_answers,
    the_probe_itself_answers_most,
    the_data_sheet_agrees,
    such_a_probe_exists,
    the_plateaus_last_as_declared,
)


def _most_crosstalk(seen: EvaluatedJump) -> tuple[str, float] | None:
    """(the probe beside that answers most, how much [%]); None where none is known."""
    answers = {k: abs(c) for k, c in seen.crosstalk.items() if np.isfinite(c)}
    return max(answers.items(), key=lambda answer: answer[1]) if answers else None


def _at_most(name: str, value: float, limit: float, advice: str) -> Check:
    return check(name, value, limit, value <= limit, advice)


def _data_sheet(gain: str | float, fit: JumpFit, unit: str) -> Check:
    value, written = split_value(gain)
    advice = f"the data sheet says {gain}, measured {fit.gain:.6g} um/{unit}: right probe, target and moves?"
    try:
        out, into = ratio_units(written, "gain")
        expected = abs(value) * delta_factor(out, "um") / delta_factor(into, unit)
    except UsageError:
        return check(
            "data_sheet_gain_pct", None, DATA_SHEET_PCT, False, f"gain '{gain}' is not a displacement over {unit}"
        )
    off = 100.0 * abs(abs(fit.gain) / expected - 1.0) if expected else float("inf")
    return _at_most("data_sheet_gain_pct", off, DATA_SHEET_PCT, advice)
