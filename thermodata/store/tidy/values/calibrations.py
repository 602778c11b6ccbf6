"""Evaluates the calibrations of a campaign; jump tests are read through the same readers and the same raw layer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from thermodata.calibration.result import CalibrationResult
from thermodata.errors import CalibrationError, RailError, ThermodataError, UsageError
from thermodata.plugin import Array
from thermodata.schema.files.campaign import Campaign, Channel, JumpCalibration, LinearCalibration, PlatinumCalibration
from thermodata.schema.units.conversion import converts, linear_conversion
from thermodata.schema.units.quantity import PROBED
from thermodata.schema.words.sentences import counted
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock, build
from thermodata.store.tidy.plan import derive
from thermodata.store.tidy.rows.in_parts import find_signal
from thermodata.store.tidy.rows.timeline import Timeline


def evaluate(
    store: Path, campaign: Campaign, jump_files: Mapping[str, list[RawStream]]
) -> tuple[dict[str, CalibrationResult], list[str]]:
    """(results by name, problems). jump_files: calibration -> the raw streams of its file, where there are any.

    CalibrationError where a calibration contradicts itself: nothing is ingested with it. A jump test that
    can't be read or found, or whose probe stands at its end of range, is a problem, and the channels that use it are
    left without values.
    """
    from thermodata.calibration.jump.evaluate import evaluate_jump
    from thermodata.calibration.platinum import evaluate_platinum
    from thermodata.calibration.static import evaluate_linear, evaluate_scale

    results: dict[str, CalibrationResult] = {}
    problems: list[str] = []
    for name, spec in campaign.calibrations.items():
        if isinstance(spec, JumpCalibration):
            raws = jump_files.get(name)
            if spec.moves == "unknown":
                problems.append(
                    f"calibration '{name}': its moves are unknown, so nothing is calibrated with it; try: "
                    "write the commanded moves, for example moves: [100 um, -100 um]"
                )
                continue
            if not raws:
                continue
            try:
                data = jump_data(store, campaign, spec, raws)
            except CalibrationError:
                raise
            except ThermodataError as error:
                problems.append(f"calibration '{name}': " + "; ".join(str(error).splitlines()))
                continue
            try:
                results[name] = evaluate_jump(name, spec, data.line.t_ns, data.volts, data.others, unit=data.unit)
            except RailError as error:  # the probe's own trouble: the other channels don't lean on it
                problems.append(f"calibration '{name}': " + "; ".join(str(error).splitlines()))
                continue
            beside = results[name].detail["steps_beside"]
            if beside:
                many = len(spec.moves)
                problems.append(
                    f"calibration '{name}': {counted(beside, 'more step')} as large as the "
                    f"{counted(many, 'commanded move')} in "
                    f"'{spec.signal}' of {spec.file}; which of them the moves are is a guess: write all moves"
                )
        elif isinstance(spec, LinearCalibration):
            results[name] = evaluate_linear(name, spec, _unit_of(campaign, name))
        elif isinstance(spec, PlatinumCalibration):
            results[name] = evaluate_platinum(name, spec)
        else:
            results[name] = evaluate_scale(name, spec, of_displacement=_is_of_displacement(campaign, name))
    return results, problems


def _unit_of(campaign: Campaign, calibration: str) -> str | None:
    """The declared unit of the channels that use a calibration, where they agree on one."""
    units = {c.unit for c in _users(campaign, calibration)}
    return next(iter(units)) if len(units) == 1 else None


def _is_of_displacement(campaign: Campaign, calibration: str) -> bool:
    """Whether a displacement or a tilt uses a calibration; one that nobody uses yet may be for one."""
    quantities = {c.quantity for c in _users(campaign, calibration)}
    return not quantities or bool(quantities & PROBED)


def _users(campaign: Campaign, calibration: str) -> list[Channel]:
    return [
        c
        for c in campaign.channels.values()
        if c.calibration == calibration or (isinstance(c.calibration, list) and calibration in c.calibration)
    ]


@dataclass(frozen=True, slots=True)
class JumpData:
    """The recording of a jump test. line: its rows in the order of time. signal: of the probe, as its file calls it.
    volts: what it says, shape (n,), and others, the other probes by signal, in unit: V where that is a voltage."""

    line: Timeline
    signal: str
    volts: Array
    others: dict[str, Array]
    unit: str


def jump_data(store: Path, campaign: Campaign, spec: JumpCalibration, raws: list[RawStream]) -> JumpData:
    """raws: the streams of its file. UsageError where the signal is not there, or has no values."""
    raw, signal, written = find_signal(raws, spec.signal)
    line = build(store, [r for r in raws if r.stream == raw.stream], Clock(), resets_allowed=False)
    written = (
        next(
            (
                c.unit
                for c in campaign.channels.values()
                if c.source == spec.source and c.signal == spec.signal and c.unit
            ),
            None,
        )
        or written
        or "V"
    )
    unit = "V" if converts(written, "V") else written
    probe = _values_in_unit(store, line, raw, signal.name, written, unit)
    others: dict[str, Array] = {}
    for channel in probes_across(campaign, spec):
        try:
            _, other, other_unit = find_signal([raw], channel.signal or "")
        except ThermodataError:  # the jump test's file need not hold every probe
            continue
        other_unit = channel.unit or other_unit or unit
        if other.name != signal.name and other.name not in others and converts(other_unit, unit):
            others[other.name] = _values_in_unit(store, line, raw, other.name, other_unit, unit)
    return JumpData(line, signal.name, probe, others, unit)


def probes_across(campaign: Campaign, spec: JumpCalibration) -> list[Channel]:
    """The probes that a jump test should leave at rest: of the same log, and not declared along the axis that moves,
    as a second one beside the probe, or at the other end of a ram, is."""
    return [
        c
        for c in campaign.channels.values()
        if c.source == spec.source
        and c.quantity == "displacement"
        and c.signal
        and (c.axis is None or c.axis != spec.axis or c.signal == spec.signal)
    ]


def _values_in_unit(store: Path, line: Timeline, raw: RawStream, name: str, unit: str, target: str) -> Array:
    from thermodata.calibration.scaling import apply_scaling

    signal = next(s for s in raw.signals if s.name == name)
    column = line.column(store, name, 0, len(line.t_ns))
    if column is None:
        raise UsageError(
            f"signal '{name}' has no values",
            where=raw.source_path,
            hint="take the calibration from another file, or leave it out",
        )
    values = apply_scaling(signal.scaling, derive.numbers(column) if column.dtype == object else column)
    factor, offset = linear_conversion(unit, target)
    return values * factor + offset
