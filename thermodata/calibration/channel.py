"""One channel: raw readings -> declared scaling -> unit -> calibrations -> canonical unit, with range flags."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.calibration.platinum import CURVE, degrees
from thermodata.calibration.quality.ends.limit import AT_END
from thermodata.calibration.result import CalibrationResult, Sign
from thermodata.calibration.scaling import Raw, apply_scaling
from thermodata.errors import CalibrationError, UsageError
from thermodata.plugin import Array, Float1D, Scaling
from thermodata.schema.files.campaign import Channel, Sensor
from thermodata.schema.flag import Flag
from thermodata.schema.units.conversion import declared_conversion, delta_factor, linear_conversion
from thermodata.schema.units.letters import encoding_hint
from thermodata.schema.units.quantity import MEASURED, PROBED, STATES, canonical
from thermodata.schema.units.unit import is_unit, normal_unit
from thermodata.schema.units.value import split_value
from thermodata.schema.words.on_off import on_or_off

_COLDEST_DEGC = -273.15


def calibrate(
    raw: Raw,
    *,
    channel: Channel,
    signal_unit: str | None,
    scaling: Scaling | None,
    calibrations: Sequence[CalibrationResult] = (),
    name: str | None = None,
) -> tuple[Float1D, Array]:
    """(values in the canonical unit of the channel's quantity, flags), shapes (n,), float64 and uint16.

    raw: shape (n,), as the reader gave it (see scaling.apply_scaling for DAQmx); text becomes numbers, and stays
    text for a label. A value that is no number is NaN and flagged out of range. sensor.range gives SATURATED at
    its limits and OUT_OF_RANGE beyond them. signal_unit: the unit that the file states for the scaled signal; the
    campaign file's `unit` overrules it.

    Raises CalibrationError: no unit, a unit that the calibrations or the quantity can't take (a displacement in V
    without a calibration), a calibration of another axis.
    """
    if channel.quantity == "label":
        text = np.asarray(raw)
        return text, np.zeros(len(text), np.uint16)
    where = f"channels.{name}" if name else None
    if not isinstance(raw, Mapping) and raw.dtype.kind in "OSUT":
        raw = _from_text(raw, state=channel.quantity == "state")
    values = apply_scaling(scaling, raw, channel=name)
    unit = reading_unit(channel, signal_unit, calibrations, where)
    readings = values
    for calibration in calibrations:
        _same_axis(channel, calibration, where)
        values, unit = _applied(values, unit, calibration, channel, where)
    values = _canonical(values, unit, channel, bool(calibrations), where)
    flags = np.zeros(len(values), dtype=np.uint16)
    if channel.sensor is not None and channel.sensor.range is not None:
        first_unit = reading_unit(channel, signal_unit, calibrations, where)
        flags |= _range_flags(channel.sensor, readings, first_unit, values, canonical(channel.quantity), where)
    finite = np.isfinite(values)
    if not finite.all():
        values = np.where(finite, values, np.nan)
        flags[~finite] |= int(Flag.OUT_OF_RANGE)
    if channel.quantity == "temperature":
        flags[values < _COLDEST_DEGC] |= int(Flag.OUT_OF_RANGE)
    return values, flags


def channel_sign(channel: Channel, calibrations: Sequence[CalibrationResult], operands: Sequence[str] = ()) -> Sign:
    """Sign of the calibrated channel: "+" where it follows the convention of schema.units.quantity, else "unknown".

    Only a displacement or a tilt can be unknown. operands: the signs of the channels that a derived one reads.
    """
    if channel.quantity not in PROBED:
        return "+"
    if channel.derive is not None:
        return "+" if operands and all(s == "+" for s in operands) else "unknown"
    if not any(c.axis is not None and c.sign != "unknown" for c in calibrations):
        return "unknown"
    return "+"


def unit_contradiction(channel: Channel, signal_unit: str | None) -> str | None:
    """Why the campaign file's unit may not stand for the file's own: what to declare. None where both say the same,
    one says nothing (or what is no unit), or `instead_of` names the file's."""
    # what is spelled alike needs no table of units
    if channel.unit is None or not signal_unit or same_unit(signal_unit, channel.unit) or not is_unit(signal_unit):
        return None
    if channel.instead_of is not None:
        if same_unit(signal_unit, channel.instead_of):
            return None
        return f"the file says '{signal_unit}', not '{channel.instead_of}' as instead_of has it"
    return (
        f"the file says '{signal_unit}', the campaign file says '{channel.unit}'; try: leave out unit where the file "
        f"is right, or declare unit: {channel.unit}, instead_of: {signal_unit}"
    )


def same_unit(one: str, other: str) -> bool:
    """Whether two spellings mean one unit."""
    try:
        factor, offset = declared_conversion(one, other)
    except UsageError:
        return False
    return bool(abs(factor - 1) < 1e-9 and abs(offset) < 1e-9)


def reading_unit(
    channel: Channel, signal_unit: str | None, calibrations: Sequence[CalibrationResult], where: str | None
) -> str:
    """The unit of the scaled reading, before any calibration. CalibrationError where nothing tells it."""
    unit = channel.unit or signal_unit
    # a row of units says 'auto' or '0/1' of what has none
    if channel.quantity in STATES and (not unit or (channel.unit is None and not is_unit(unit))):
        return "1"
    if unit:
        return unit
    if calibrations and calibrations[0].unit_in:
        return calibrations[0].unit_in
    raise CalibrationError(
        f"no unit is known of {where or 'a channel'}",
        where=where,
        expected=f"a unit that converts to {canonical(channel.quantity)}",
        got="none in the file, none declared",
        hint=f"add 'unit: {canonical(channel.quantity)}' (or what the signal is in) to the channel",
    )


def _applied(
    values: Float1D, unit: str, calibration: CalibrationResult, channel: Channel, where: str | None
) -> tuple[Float1D, str]:
    if calibration.unit_in:
        try:
            factor, shift = declared_conversion(unit, calibration.unit_in)
        except UsageError as error:
            raise CalibrationError(
                f"calibration '{calibration.name}' takes {calibration.unit_in}, the channel gives {unit}",
                where=where,
                expected=calibration.unit_in,
                got=unit,
                hint=_to_take(unit, channel, (where or "").rpartition(".")[2]),
            ) from error
        values = values * factor + shift if (factor, shift) != (1.0, 0.0) else values
        if (r0_ohm := calibration.detail.get(CURVE)) is not None:
            values = degrees(values, float(r0_ohm))
        unit = calibration.unit_out
    offset = calibration.offset
    written = str(calibration.detail.get("offset_unit") or "")
    if offset and written and not calibration.unit_in:
        try:
            offset *= delta_factor(written, unit)
        except UsageError as error:
            raise CalibrationError(
                f"calibration '{calibration.name}': its offset is in {written}, the channel in {unit}",
                where=where,
                expected=unit,
                got=written,
                hint="write the offset in the channel's unit, or correct 'unit' of the channel",
            ) from error
    return values * calibration.gain + offset, unit


def _to_take(unit: str, channel: Channel, name: str) -> str:
    """What to try where a calibration takes another unit. A reading that is in a unit of its quantity is in no other
    one: the log that has it was scaled before."""
    try:
        linear_conversion(unit, canonical(channel.quantity))
    except UsageError:
        return "declare the channel's unit, or use the calibration of the right sensor"
    return (
        f"in each test whose log has it in {normal_unit(unit)}, channels: {{{name}: {{calibration: []}}}} takes it as "
        f"it stands, and a calibration that takes {normal_unit(unit)} in place of [] also says which way it counts"
    )


def _canonical(values: Float1D, unit: str, channel: Channel, calibrated: bool, where: str | None) -> Float1D:
    target = canonical(channel.quantity)
    try:
        # a difference has no zero point: 5 degC of difference are 5 K
        difference = channel.quantity == "temperature_difference"
        factor, shift = (declared_conversion if channel.unit else linear_conversion)(unit, target)
        shift = 0.0 if difference else shift
    except UsageError as error:
        raise CalibrationError(
            f"a {channel.quantity} in {unit}" + ("" if calibrated else " without a calibration"),
            where=where,
            expected=f"a unit that converts to {target}",
            got=unit,
            hint=encoding_hint(unit) + _to_calibrate(channel.quantity, f"{target}/{normal_unit(unit)}"),
        ) from error
    return values if (factor, shift) == (1.0, 0.0) else values * factor + shift


def _to_calibrate(quantity: str, ratio: str) -> str:
    """What to try where a reading is in no unit of its quantity. Only what is displaced can be moved by a known way."""
    gain = f"(kind: {'scale' if quantity in MEASURED else 'linear'}, gain: ... {ratio})"
    if quantity == "displacement":
        return f"add 'calibration:' with a jump test (kind: jump) or the data sheet's gain {gain}, or correct the unit"
    if quantity == "temperature" and ratio.rpartition("/")[2] == "ohm":
        return "correct the quantity, or add 'calibration:' with the sensor's curve (kind: pt100, or pt1000)"
    return f"correct the unit or the quantity, or add 'calibration:' with the sensor's gain {gain}"


def _same_axis(channel: Channel, calibration: CalibrationResult, where: str | None) -> None:
    if channel.axis is not None and calibration.axis is not None and channel.axis != calibration.axis:
        raise CalibrationError(
            f"the channel measures {channel.axis}, its calibration '{calibration.name}' moved {calibration.axis}",
            where=where,
            expected=f"a calibration of axis {channel.axis}",
            got=f"axis {calibration.axis}",
            hint="use the jump test of this axis, or correct 'axis'",
        )


def _range_flags(
    sensor: Sensor, readings: Float1D, reading: str, values: Float1D, target: str, where: str | None
) -> Array:
    """The range is in the unit of the reading, or (written so) in the canonical unit."""
    assert sensor.range is not None
    unit = next((u for u in (split_value(v)[1] for v in sensor.range) if u), reading)
    x, goal = readings, reading
    try:
        linear_conversion(unit, reading)
    except UsageError:
        x, goal = values, target
    limits = []
    for limit in sensor.range:
        value, written = split_value(limit)
        factor, shift = linear_conversion(written or unit, goal)
        limits.append(value * factor + shift)
    low, high = limits
    if not low < high:
        raise CalibrationError(
            "a sensor range without width",
            where=where,
            expected="[low, high] with low < high",
            got=f"[{sensor.range[0]}, {sensor.range[1]}]",
            hint="the ends between which the sensor's data sheet lets it measure",
        )
    edge = AT_END * (high - low)
    flags = np.zeros(len(x), dtype=np.uint16)
    with np.errstate(invalid="ignore"):
        inside = (x > low + edge) & (x < high - edge)
        if not inside.all():
            outside = (x < low - edge) | (x > high + edge)
            flags[outside] = int(Flag.OUT_OF_RANGE)
            flags[~inside & ~outside & np.isfinite(x)] = int(Flag.SATURATED)
    return flags


def number_in(text: str) -> float:
    """A number written as text, with a point or a comma; NaN for what is none (UNAVAILABLE, an empty cell)."""
    try:
        return float(text.replace(",", ".") if text.count(",") == 1 and "." not in text else text)
    except ValueError:
        return math.nan


def _from_text(raw: Array, state: bool) -> Float1D:
    """Numbers written as text; NaN for what is none (UNAVAILABLE, an empty cell)."""
    words, index = np.unique(np.asarray(raw, dtype=object).astype(str), return_inverse=True)
    numbers = np.full(len(words), np.nan)
    for i, word in enumerate(words.tolist()):
        switched = on_or_off(word) if state else None
        numbers[i] = number_in(word.strip().casefold()) if switched is None else switched
    result: Float1D = numbers[index.reshape(-1)]
    return result
