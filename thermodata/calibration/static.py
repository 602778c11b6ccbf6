"""Calibrations that need no measurement: a data sheet's scale, and a linear correction."""

from __future__ import annotations

from thermodata.calibration.facing import facing_axis, geometric_sign
from thermodata.calibration.result import CalibrationResult, Check, Sign, check
from thermodata.errors import CalibrationError, UsageError
from thermodata.schema.files.campaign import LinearCalibration, ScaleCalibration
from thermodata.schema.units.conversion import delta_factor
from thermodata.schema.units.value import split_value

SAME_LENGTH = 2.0  # a lever of a gauge may stretch a length by so much, or shrink it


def ratio_units(unit: str, name: str) -> tuple[str, str]:
    """'um/V' -> ('um', 'V'): what comes out, and what goes in (split at the last '/')."""
    out, slash, into = unit.rpartition("/")
    if not slash or not out.strip() or not into.strip():
        raise CalibrationError(
            f"calibration '{name}': the gain has no unit of the form out/in",
            where=f"calibrations.{name}.gain",
            expected="for example '250 um/V'",
            got=repr(unit),
            hint="write what comes out over what the sensor gives",
        )
    return out.strip(), into.strip()


def _gain(name: str, spec: ScaleCalibration | LinearCalibration) -> tuple[float, str]:
    """(the declared gain, its unit); CalibrationError where it is zero."""
    gain, unit = split_value(spec.gain)
    if gain == 0:
        raise CalibrationError(
            f"calibration '{name}': a gain of zero",
            where=f"calibrations.{name}.gain",
            expected="a number other than 0",
            got=str(spec.gain),
            hint="the gain is what one unit of the raw signal means: gain: 25 um/V",
        )
    return gain, unit


def evaluate_scale(name: str, spec: ScaleCalibration, *, of_displacement: bool = True) -> CalibrationResult:
    """A data-sheet gain with the way the probe looks; without `facing` the sign stays unknown. of_displacement: whether
    a displacement or a tilt is scaled; what else is measured has no side to look from, and the gain's own sign.

    Raises CalibrationError where the gain has no unit, is zero, or carries a sign beside `facing`.
    """
    gain, unit = _gain(name, spec)
    unit_out, unit_in = ratio_units(unit, name)
    axis = facing_axis(name, spec.facing, spec.axis)
    sign: Sign = "unknown"
    if spec.facing is not None:
        if gain < 0:
            raise CalibrationError(
                f"calibration '{name}': the sign is given twice",
                where=f"calibrations.{name}",
                expected="a positive gain beside 'facing', which gives the sign",
                got=f"gain {spec.gain}",
                hint="drop the minus and say increases_with: approach, if the reading falls as the gap grows",
            )
        gain *= geometric_sign(spec.facing, spec.increases_with)
    if spec.facing is not None or not of_displacement:
        sign = "+" if gain > 0 else "-"
    offset = _offset(name, spec.offset, unit_out)
    uncertainty = _percent_of_gain(name, spec, abs(gain), unit)
    known = sign != "unknown"
    return CalibrationResult(
        name=name,
        kind="scale",
        axis=axis,
        gain=gain,
        gain_unit=f"{unit_out}/{unit_in}",
        offset=offset,
        sign=sign,
        uncertainty_pct=uncertainty,
        detail={
            "unit_in": unit_in,
            "unit_out": unit_out,
            "facing": spec.facing,
            "increases_with": spec.increases_with if spec.facing else None,
        },
        checks=[
            check(
                "sign_known",
                None,
                None,
                known,
                "give 'facing' (the way the probe looks), or make a jump test: until then the channel can "
                "be modelled, not compared in sign",
            ),
            *_lengths(spec, abs(gain), unit_out, unit_in),
        ],
    )


def evaluate_linear(name: str, spec: LinearCalibration, unit: str | None = None) -> CalibrationResult:
    """value = gain * reading + offset. unit: what the reading is in where the gain has no unit of its own
    ("" or None: whatever unit the channel has). Offsets are differences: -0.12 K on a channel in degC is
    -0.12 degC, in degF -0.216.
    """
    gain, gain_unit = _gain(name, spec)
    unit_out, unit_in = ratio_units(gain_unit, name) if gain_unit not in ("", "1") else (unit or "", unit or "")
    written = split_value(spec.offset)[1]
    offset = _offset(name, spec.offset, unit_out or written)
    return CalibrationResult(
        name=name,
        kind="linear",
        gain=gain,
        gain_unit=gain_unit or "1",
        offset=offset,
        detail={"unit_in": unit_in, "unit_out": unit_out, "offset_unit": unit_out or written},
    )


def _lengths(spec: ScaleCalibration, gain: float, unit_out: str, unit_in: str) -> list[Check]:
    """Whether what reads a length stays near that length: '1 um/mm' makes a thousandth of it."""
    try:
        size = gain * delta_factor(unit_out, "um") / delta_factor(unit_in, "um")
    except UsageError:
        return []  # volts, or whatever else the sensor gives
    if not size:
        return []
    advice = f"'{spec.gain}' takes 1 {unit_in} for {gain:g} {unit_out}: write 1 {unit_in}/{unit_in} to keep it"
    return [check("length_kept", size, SAME_LENGTH, 1 / SAME_LENGTH <= size <= SAME_LENGTH, advice)]


def _offset(name: str, offset: str | float | int, unit: str) -> float:
    value, written = split_value(offset)
    if not written or not unit:
        return value
    try:
        return value * delta_factor(written, unit)
    except UsageError as error:
        raise CalibrationError(
            f"calibration '{name}': the offset is not in the unit of the result",
            where=f"calibrations.{name}.offset",
            expected=unit,
            got=str(offset),
            hint=f"the offset is added after the gain: give it in {unit}",
        ) from error


def _percent_of_gain(name: str, spec: ScaleCalibration, gain: float, gain_unit: str) -> float | None:
    if spec.uncertainty is None:
        return None
    value, unit = split_value(spec.uncertainty)
    if unit in ("%", "percent"):
        return value
    if not unit:
        raise CalibrationError(
            f"calibration '{name}': an uncertainty without a unit",
            where=f"calibrations.{name}.uncertainty",
            expected="for example '2 %'",
            got=str(spec.uncertainty),
            hint="in per cent of the gain, or in the channel's unit",
        )
    return 100.0 * value * delta_factor(unit, gain_unit) / gain
