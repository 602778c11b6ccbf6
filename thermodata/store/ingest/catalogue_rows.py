"""The catalogue's rows of a test, from its plan and what was made of it."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from datetime import datetime
from typing import Any

import numpy as np

from thermodata.calibration.result import CalibrationResult
from thermodata.schema.files.campaign import Campaign, Measuring
from thermodata.schema.units.quantity import canonical
from thermodata.store.catalogue.conditions import plain_value, plain_values
from thermodata.store.ingest.known.inventory import Row
from thermodata.store.ingest.told.declared.beyond_the_end import phases_of
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock, Span, is_relative, recorded
from thermodata.store.tidy.clock_offsets import clock_to_json
from thermodata.store.tidy.plan.plan import Bound, SourcePlan, TestPlan


def test_row(plan: TestPlan, span: Span, duration_s: float | None) -> Row:
    """Row of `test`. phases are moved to t_s, which counts from the window where there is one."""
    test = plan.test
    measuring: Any = (
        test.measuring.model_dump(mode="json", by_alias=True)
        if isinstance(test.measuring, Measuring)
        else test.measuring
    )
    return {
        "campaign": plan.campaign.id,
        "test": test.id,
        "kind": test.kind,
        "role": test.role,
        "start_ns": None if span.relative else span.zero_ns,
        "duration_s": duration_s,
        "clock": "relative" if span.relative else "absolute",
        "conditions": _json(plain_values(dict(test.conditions))),
        "pose": _json(plain_values(dict(test.pose))),
        "tool": None if test.tool is None else _json(plain_values(test.tool.model_dump(exclude_none=True))),
        "phases": _json({k: list(ends) for k, ends in phases_of(test, duration_s).items()}),
        "window_s": None if test.window is None else list(test.window),
        "history": test.history,
        "measuring": None if measuring is None else _json(measuring),
        "zero_s": test.zero.over,
        "start_state": test.start_state,
        "repeat_of": test.repeat_of,
        "notes": test.notes or None,
    }


def machine_row(campaign: Campaign, plan: TestPlan) -> Row:
    """Row of `machine`: the campaign's, with the test's overrides."""
    merged = campaign.machine.model_dump(mode="json", exclude_none=True)
    for key, value in plan.test.machine.items():
        old = merged.get(key)
        merged[key] = {**old, **value} if isinstance(old, dict) and isinstance(value, dict) else value
    attributes = {k: v for k, v in merged.items() if k not in ("id", "description")}
    return {
        "campaign": campaign.id,
        "test": plan.test.id,
        "machine": str(merged["id"]),
        "description": merged.get("description") or None,
        "attributes": _json(plain_values(attributes)),
    }


def source_rows(plan: TestPlan, clocks: Mapping[str, Clock]) -> list[Row]:
    """Rows of `source`, one a stream."""
    return [
        _source_row(plan, source, stream, raws, clocks[source.name])
        for source in plan.sources.values()
        for stream, raws in source.streams.items()
    ]


def _source_row(plan: TestPlan, source: SourcePlan, stream: str, raws: Sequence[RawStream], clock: Clock) -> Row:
    complete = [r.complete for r in raws]
    told = json.loads(clock_to_json(clock)) if clock.notes or clock.key else []
    notes = told + list(dict.fromkeys(n for r in raws for n in r.notes))
    first = min(recorded(r)[0] for r in raws)
    steps = sorted(r.step_ns for r in raws if r.step_ns > 0)
    middle = steps[(len(steps) - 1) // 2 : len(steps) // 2 + 1]
    return {
        "campaign": plan.campaign.id,
        "test": plan.test.id,
        "source": source.name,
        "stream": stream,
        "reader": raws[0].reader,
        "reader_version": raws[0].reader_version,
        "clock": "relative" if is_relative(source) else "absolute",
        "start_ns": first + clock.offset_ns + clock.base_ns,
        "rows": sum(r.rows for r in raws),
        "step_s": sum(middle) / len(middle) / 1e9 if steps else None,
        "offset_ns": clock.offset_ns,
        "complete": False if False in complete else (None if None in complete else True),
        "notes": _json(notes) if notes else "[]",
    }


def channel_rows(
    plan: TestPlan, calibrations: Mapping[str, CalibrationResult], empty: Collection[str] = ()
) -> list[Row]:
    """Rows of `channel`, in the campaign's order. empty: the channels without a value in this test."""
    return [_channel_row(plan, bound, calibrations, bound.name in empty) for bound in plan.bound.values()]


def _channel_row(plan: TestPlan, bound: Bound, calibrations: Mapping[str, CalibrationResult], empty: bool) -> Row:
    channel = bound.channel
    named = [channel.calibration] if isinstance(channel.calibration, str) else list(channel.calibration or [])
    sensor = None if channel.sensor is None else channel.sensor.model_dump(mode="json", exclude_none=True)
    return {
        "campaign": plan.campaign.id,
        "test": plan.test.id,
        "channel": bound.name,
        "source": bound.source,
        "stream": bound.stream,
        "signal": bound.signal.name if bound.signal else None,
        "quantity": channel.quantity,
        # of a signal whose unit nobody knows there is no value in any
        "unit": "" if empty and bound.signal is not None and bound.unit is None else canonical(channel.quantity),
        "raw_unit": bound.unit,
        "axis": channel.axis,
        "at": channel.at,
        "relative_to": channel.relative_to,
        "sign": sign_of(plan, bound, calibrations),
        "calibration": ", ".join(named) or None,
        "dtype": bound.signal.dtype if bound.signal else ("str" if bound.is_text else "float64"),
        "sensor": None if sensor is None else _json(sensor),
        "notes": channel.notes or None,
    }


def sign_of(plan: TestPlan, bound: Bound, calibrations: Mapping[str, CalibrationResult]) -> str:
    """'+' once values follow the sign convention; 'unknown' for a displacement that nothing orients."""
    from thermodata.calibration.channel import channel_sign
    from thermodata.store.tidy.plan.derive import names

    named = (
        [bound.channel.calibration]
        if isinstance(bound.channel.calibration, str)
        else list(bound.channel.calibration or [])
    )
    operands = (
        []
        if bound.channel.derive is None
        else [
            sign_of(plan, plan.bound[n], calibrations) for n in sorted(names(bound.channel.derive)) if n in plan.bound
        ]
    )
    return channel_sign(bound.channel, [calibrations[n] for n in named if n in calibrations], operands)


def raw_rows(plan: TestPlan, now: datetime) -> list[Row]:
    """Rows of `file` for the raw layer."""
    return [
        raw_row(plan.campaign.id, plan.test.id, source.name, raw, "test", now)
        for source in plan.sources.values()
        for raw in source.raws
    ]


def raw_row(campaign: str, test: str, source: str, raw: RawStream, part: str, now: datetime) -> Row:
    """A row of the table `file`. test: '' for a jump test; source: then the name of its calibration; part: test or
    calibration."""
    return {
        "campaign": campaign,
        "test": test,
        "source": source,
        "stream": raw.stream,
        "layer": "raw",
        "part": part,
        "key": raw.key,
        "path": raw.path,
        "source_path": raw.source_path,
        "sha256": raw.sha256,
        "bytes": raw.bytes,
        "rows": raw.rows,
        "columns": raw.to_json(),
        "losses": raw.losses_json(),
        "added_at": now,
    }


def calibration_row(campaign: str, result: CalibrationResult) -> Row:
    """A row of the table `calibration`; what is no finite number is NULL."""
    row = result.row(campaign)
    return {
        k: _json(v)
        if k in ("crosstalk", "checks", "detail")
        else (None if isinstance(v, float) and not np.isfinite(v) else v)
        for k, v in row.items()
    }


def _json(value: Any) -> str:
    return json.dumps(value, sort_keys=True, default=_json_default)


def _json_default(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(plain_value(value))


__all__ = [
    "calibration_row",
    "channel_rows",
    "machine_row",
    "raw_row",
    "raw_rows",
    "sign_of",
    "source_rows",
    "test_row",
]
