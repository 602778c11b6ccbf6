"""The jump test: the axis moves a probe by known steps, and the voltage answers; a signed sensitivity comes out.

The moves are commanded in machine coordinates, so the gain maps volts to displacement of the tool centre point
along the machine's + axis, whichever way the probe looks. It is the weighted regression of the commanded
position on the plateau's voltage (the position carries the larger error), with a linear drift in time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from thermodata.calibration.facing import facing_axis, geometric_sign
from thermodata.calibration.jump import checks
from thermodata.calibration.jump.fit import answer, fit_plateaus
from thermodata.calibration.jump.plateaus import Match, Plateau, Step, find_steps, match_moves, plateaus
from thermodata.calibration.quality.ends.limit import impossible, sentinels
from thermodata.calibration.quality.value import run_stats
from thermodata.calibration.result import CalibrationResult
from thermodata.errors import CalibrationError, RailError
from thermodata.plugin import Array, Bool1D, Float1D, Int1D
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.schema.words.sentences import counted

_LEAST_SAMPLES = 20
_LEAST_ON_RAIL = 0.05  # of a jump test's samples
_LEAST_AT_REST = 3  # samples of a plateau
_AS_LARGE = 0.7  # of the smallest commanded move: a step that may be one of them


def evaluate_jump(
    name: str,
    spec: JumpCalibration,
    t_ns: Int1D,
    volts: Array,
    others: Mapping[str, Array] | None = None,
    *,
    unit: str = "V",
) -> CalibrationResult:
    """Evaluates a jump test.

    t_ns: shape (n,), of the recording; volts: shape (n,), the probe's scaled signal in `unit`; others: the other
    probes' signals, shape (n,) each, for cross-talk. spec.moves: successive relative moves in machine coordinates
    [um]. The recording may begin and end with anything else. Offset: displacement 0 at the first plateau.

    Raises RailError: the probe stands at its end of range and the moves aren't found; CalibrationError: they aren't
    found otherwise, can be read with either sign, or the sign contradicts `facing` with `increases_with`. Weaknesses
    that don't forbid use are rows of `checks`.
    """
    axis = facing_axis(name, spec.facing, spec.axis)
    moves = _checked_moves(name, spec)
    t_s, v, probes = _clean(name, np.asarray(t_ns), np.asarray(volts), dict(others or {}))
    steps, match = _matched(t_s, v, moves, spec)
    if match is None:
        raise _on_rail(name, spec, v, unit) or _not_found(name, spec, moves, steps, t_s, probes)
    _refuse_either_sign(name, match, moves, len(steps), unit)

    def dwells_of(t_s: Float1D, x: Float1D) -> list[Plateau]:
        return plateaus(t_s, x, match, steps, spec.dwell)

    dwells = dwells_of(t_s, v)
    _refuse_short(name, dwells)
    levels = np.concatenate([[0.0], np.cumsum(moves)])
    fit = fit_plateaus(dwells, levels, spec.move_uncertainty)
    _agrees_with_facing(name, spec, fit.gain, unit)
    crosstalk = {k: _crosstalk(t_s, x, dwells_of, levels) * fit.gain for k, x in probes.items()}
    return CalibrationResult(
        name=name,
        kind="jump",
        axis=axis,
        gain=fit.gain,
        gain_unit=f"um/{unit}",
        offset=fit.offset,
        sign="+" if fit.gain > 0 else "-",
        uncertainty_pct=fit.uncertainty_pct,
        noise_um=fit.noise_um,
        nonlinearity_pct=fit.nonlinearity_pct,
        drift_um=fit.drift_um,
        crosstalk=crosstalk,
        checks=checks.rows(checks.EvaluatedJump(spec, moves, fit, crosstalk, dwells, unit)),
        detail={
            "unit_in": unit,
            "unit_out": "um",
            "moves_um": moves,
            "steps_found": len(steps),
            "steps_beside": _steps_without_move(steps, match),
            "drift_um_per_h": None if fit.drift_um_per_s is None else fit.drift_um_per_s * 3600.0,
            "plateaus": [_row(p, level, rest) for p, level, rest in zip(dwells, levels, fit.residual_um, strict=True)],
        },
    )


def _refuse_either_sign(name: str, match: Match, moves: list[float], steps: int, unit: str) -> None:
    """CalibrationError where the moves fit the steps at two places, with another sign at each."""
    if match.rivals:
        raise CalibrationError(
            f"jump test '{name}': the moves can be read with either sign",
            where=f"calibrations.{name}",
            expected=f"one place for the moves {moves} um among {steps} steps",
            got=f"{1 / match.volts_per_um:+.4g} and {1 / match.rivals[0]:+.4g} um/{unit}",
            hint="write in 'moves' all moves of the recording, signed and in their order; or say which way the probe "
            "looks, which decides: facing: +Z, increases_with: gap; next time move by unequal steps, e.g. [100 um, "
            "50 um, -150 um]",
        )


def _refuse_short(name: str, dwells: Sequence[Plateau]) -> None:
    """CalibrationError where a plateau has too few samples for a mean and its scatter."""
    if any(p.n < _LEAST_AT_REST or not np.isfinite(p.mean) for p in dwells):
        raise CalibrationError(
            f"jump test '{name}': a plateau with under {_LEAST_AT_REST} samples",
            where=f"calibrations.{name}",
            expected=f"at least {_LEAST_AT_REST} samples a plateau",
            got=f"{min(p.n for p in dwells)}",
            hint="repeat the jump test: dwell longer or sample faster; until then a calibration of kind: scale, with "
            "the data sheet's gain, facing and increases_with",
        )


def _matched(t_s: Float1D, v: Float1D, moves: list[float], spec: JumpCalibration) -> tuple[list[Step], Match | None]:
    """(steps, those that are the moves); a staircase that goes much faster than declared is looked for too. Where moves
    to and fro fit at two places, with either sign, the way that the probe looks decides."""
    dwell_s = spec.dwell
    steps, _ = find_steps(t_s, v, dwell_s)
    match = match_moves(steps, moves, dwell_s)
    if match is None and len(moves) > 1:
        dwell_s /= 3
        finer, _ = find_steps(t_s, v, dwell_s)
        match = match_moves(finer, moves, dwell_s)
        steps = steps if match is None else finer
    if match is not None and match.rivals and spec.facing is not None and spec.increases_with is not None:
        match = match_moves(steps, moves, dwell_s, geometric_sign(spec.facing, spec.increases_with))
    return steps, match


def _steps_without_move(steps: list[Step], match: Match) -> int:
    """How many steps as large as a commanded move no move accounts for."""
    least = _AS_LARGE * min(abs(s.size) for s in match.steps)
    moved = {s.t_s for s in match.steps}
    return sum(abs(s.size) >= least and s.t_s not in moved for s in steps)


def _checked_moves(name: str, spec: JumpCalibration) -> list[float]:
    """The declared moves [um]; CalibrationError where they, the dwell or the uncertainty can't be those of a test."""
    moves = [float(m) for m in spec.moves] if isinstance(spec.moves, list) else []
    wrong = not moves or any(m == 0 or not np.isfinite(m) for m in moves)
    if wrong or not spec.dwell > 0 or spec.move_uncertainty < 0:
        raise CalibrationError(
            f"jump test '{name}': not a jump test",
            where=f"calibrations.{name}",
            expected="moves other than 0, a dwell above 0 s, a move_uncertainty of 0 um or more",
            got=f"moves {moves}, dwell {spec.dwell} s, move_uncertainty {spec.move_uncertainty} um",
            hint="correct these in the campaign file; what has no moves is no jump test, and its scale "
            "goes under 'gain'",
        )
    return moves


def _clean(
    name: str, t_ns: Int1D, volts: Array, probes: dict[str, Array]
) -> tuple[Float1D, Float1D, dict[str, Float1D]]:
    """Times [s] that strictly increase and volts that are readings; the other probes at the same samples."""
    for label, x in [("the probe", volts), *probes.items()]:
        if x.shape != t_ns.shape or t_ns.ndim != 1:
            raise CalibrationError(
                f"jump test '{name}': {label} has another length than the time",
                expected=str(t_ns.shape),
                got=str(x.shape),
            )
    v = volts.astype(np.float64, copy=False)
    keep = readings(t_ns, v)
    if keep.sum() < _LEAST_SAMPLES:
        raise CalibrationError(
            f"jump test '{name}': hardly any data",
            where=f"calibrations.{name}",
            expected=f"at least {_LEAST_SAMPLES} samples",
            got=str(int(keep.sum())),
            hint="is this the right file and signal?",
        )
    t = t_ns[keep]
    return ((t - t[0]) / 1e9, v[keep], {k: np.asarray(x, dtype=np.float64)[keep] for k, x in probes.items()})


def readings(t_ns: Int1D, volts: Float1D) -> Bool1D:
    """Which samples count, shape (n,): those that a probe can have, each later than all before. The times of plateaus
    count from the first of them. t_ns: shape (n,); volts: shape (n,), the probe's scaled signal."""
    keep = _is_reading(volts)
    if keep.any():
        newest = np.maximum.accumulate(np.where(keep, t_ns, t_ns.min()))
        keep[1:] &= t_ns[1:] > newest[:-1]
    return keep


def _is_reading(x: Float1D) -> Bool1D:
    """Where x, shape (n,), is no logger's mark for "over range" or "no value": a step to one hides all moves."""
    return np.isfinite(x) & ~impossible(x, "displacement") & ~sentinels(x, run_stats(x))


def _on_rail(name: str, spec: JumpCalibration, v: Float1D, unit: str) -> RailError | None:
    """The error of a probe that stands at the end of its range: its largest or smallest reading, again and again, where
    the others have noise on them."""
    found: list[tuple[float, float]] = []
    for end in sorted({float(v.min()), float(v.max())}):
        there = v == end
        share = float(there.mean())
        elsewhere = v[~there]
        repeats = float(np.mean(np.diff(elsewhere) == 0)) if elsewhere.size > 1 else 0.0
        if share >= _LEAST_ON_RAIL and float(np.mean(there[1:] & there[:-1])) >= 0.5 * share and repeats < 0.3:
            found.append((end, share))
    if not found:
        return None
    said = " and ".join(f"{end:.4g} {unit} in {100 * share:.0f} % of the record" for end, share in found)
    return RailError(
        f"jump test '{name}': the probe '{spec.signal}' stands at its end of range, where it does not show the moves",
        where=f"calibrations.{name}",
        expected="a probe that stays within its range through all moves",
        got=said,
        hint="set the probe nearer to the middle of its range, or move by less, and repeat the jump test",
    )


def _not_found(
    name: str, spec: JumpCalibration, moves: list[float], steps: list[Step], t_s: Float1D, probes: Mapping[str, Float1D]
) -> CalibrationError:
    """The error of moves that no steps answer, with the other probes that show them: their cables may be swapped."""
    answering = []
    for other, x in probes.items():
        fine = _is_reading(x)
        if (
            fine.sum() >= _LEAST_SAMPLES
            and match_moves(find_steps(t_s[fine], x[fine], spec.dwell)[0], moves, spec.dwell) is not None
        ):
            answering.append(other)
    seen = ", ".join(f"{s.size:+.3g} at {s.t_s:.1f} s" for s in steps[:12]) or "no step at all"
    hint = f"check moves and dwell ({spec.dwell:g} s) against the recording"
    if answering:
        hint = f"{', '.join(repr(a) for a in answering)} shows these moves: are the cables swapped?"
    return CalibrationError(
        f"jump test '{name}': the commanded moves are not found in '{spec.signal}'",
        where=f"calibrations.{name}",
        expected=f"{counted(len(moves), 'step')} in proportion to {moves} um",
        got=seen,
        hint=hint,
    )


def _agrees_with_facing(name: str, spec: JumpCalibration, gain: float, unit: str) -> None:
    """CalibrationError where the sign is not that of a probe which looks as it is declared. gain: [um/unit]."""
    if spec.facing is None or spec.increases_with is None:
        return
    sign = geometric_sign(spec.facing, spec.increases_with)
    if sign * gain < 0:
        raise CalibrationError(
            f"jump test '{name}': the measured sign contradicts the way the probe looks",
            where=f"calibrations.{name}",
            expected=f"{sign * abs(gain):+.6g} um/{unit} (facing {spec.facing}, increases with {spec.increases_with})",
            got=f"{gain:+.6g} um/{unit} measured",
            hint="check facing and increases_with, the signs of the moves (machine coordinates), and the cables",
        )


def _crosstalk(
    t_s: Float1D, x: Float1D, dwells_of: Callable[[Float1D, Float1D], list[Plateau]], levels: Float1D
) -> float:
    """100 times the other probe's answer to the move [its unit/um], signed; NaN where it has no data."""
    fine = _is_reading(x)
    if fine.sum() < _LEAST_SAMPLES:
        return float("nan")
    return 100.0 * answer(dwells_of(t_s[fine], x[fine]), levels)


def _row(p: Plateau, level: float, rest: float) -> dict[str, float | int]:
    """A plateau as the answer tells it. level: the commanded position [um]; rest: what the regression leaves [um]."""
    return {
        "from_s": p.from_s,
        "to_s": p.to_s,
        "commanded_um": float(level),
        "volts": p.mean,
        "noise_volts": p.noise,
        "residual_um": float(rest),
        "n": p.n,
    }
