"""Content keys of the tidy layer: what a file of it is made from, so that an edit re-tidies only what changed."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence

from thermodata.calibration.measuring import measuring_names
from thermodata.calibration.result import CalibrationResult
from thermodata.schema.files.campaign import Channel
from thermodata.schema.units.quantity import MEASURED
from thermodata.store.base.files import key_of
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock, Span
from thermodata.store.tidy.flags.overrule import rules_of
from thermodata.store.tidy.plan import derive
from thermodata.store.tidy.plan.plan import SCHEDULE, Bound, TestPlan
from thermodata.store.tidy.rows.on_change import BY_HAND
from thermodata.store.tidy.values.series import Member

# counts the changes of calibration, flagging and layout that make older tidy files out of date
TIDY_VERSION = "25"


def member_key(
    plan: TestPlan,
    member: Member,
    columns: Sequence[tuple[str, bool]],
    clocks: Mapping[str, Clock],
    span: Span,
    texts: ChannelTexts,
) -> str:
    """The key of the tidy files of one stream of a test. Everything that its bytes depend on, and nothing else."""
    # `repr` writes the names of Span, Clock and their fields into the keys: to rename one makes every tidy file anew
    here = [b for b in plan.bound.values() if (b.source, b.stream) == member]
    used: dict[str, Bound] = {}
    for bound in here:
        _collect(plan, bound, used)
    measuring = plan.test.measuring if any(b.channel.quantity in MEASURED for b in here) else None
    for name in measuring_names(measuring):
        if name in plan.bound:
            _collect(plan, plan.bound[name], used)
    names = {b.name for b in here}
    rules = [r for r in rules_of(plan.campaign, plan.test.id) if r.channel is None or r.channel in names]
    members = {(b.source, b.stream) for b in used.values()} | {member}
    parts = [TIDY_VERSION, repr(member), repr(list(columns)), repr(span), repr(measuring)]
    if rules:
        parts.append(repr([r.model_dump(mode="json", exclude={"tests"}) for r in rules]))
    for name in sorted(used):
        parts.append(texts.of(used[name]))
        if used[name].channel.quantity in BY_HAND and (beside := plan.step_beside(used[name])):
            parts.append(repr((name, beside)))
    for source, stream in sorted(members):
        if source in plan.sources:
            source_plan = plan.sources[source]
            clock = clocks[source]
            own = {r.path for r in source_plan.streams.get(stream, [])}
            if otherwise := sorted((k, repr(v)) for k, v in source_plan.parts.items() if k[0] in own):
                parts.append(repr(otherwise))
            parts += [
                source,
                stream,
                repr([(r.key, r.path, *_moved(r)) for r in source_plan.streams.get(stream, [])]),
                repr(
                    (
                        clock.offset_ns,
                        clock.drift_ppm,
                        clock.base_ns,
                        clock.suspect,
                        source_plan.spec.clock.resets,
                        source_plan.shared,
                    )
                ),
            ]
    if any(s == SCHEDULE for s, _ in members):
        # the schedule's grid ends with the reference sources
        parts += [
            repr([(r.key, *_moved(r), clocks[s.name]) for s in plan.reference for r in s.raws]),
            json.dumps(plan.test.conditions, sort_keys=True, default=str),
        ]
    if any(s in plan.sources and plan.sources[s].shared for s, _ in members):
        parts.append(repr([(r.key, *_moved(r), clocks[s.name]) for s in plan.reference for r in s.raws]))
    return key_of(*parts)


def _moved(raw: RawStream) -> tuple[int, ...]:
    return (raw.moved_ns,) if raw.moved_ns else ()


def _collect(plan: TestPlan, bound: Bound, into: dict[str, Bound]) -> None:
    if bound.name in into:
        return
    into[bound.name] = bound
    if bound.channel.derive is not None:
        for name in derive.names(bound.channel.derive):
            if name in plan.bound:
                _collect(plan, plan.bound[name], into)


class ChannelTexts:
    """The texts of the channels of many tests, most of which are the same: told for each as by `channel_text`."""

    def __init__(self, calibrations: Mapping[str, CalibrationResult]) -> None:
        self._calibrations = calibrations
        # with its channel, so that no other comes to have its identity
        self._known: dict[tuple[object, ...], tuple[Channel, str]] = {}

    def of(self, bound: Bound) -> str:
        """The text of one channel of a test."""
        signal = bound.signal
        if signal is not None and signal.scaling is not None:
            return channel_text(bound, self._calibrations)
        told = None if signal is None else (signal.name, signal.stream, signal.unit, signal.dtype)
        key = (id(bound.channel), bound.name, bound.unit, told)
        if key not in self._known:
            self._known[key] = bound.channel, channel_text(bound, self._calibrations)
        return self._known[key][1]


def channel_text(bound: Bound, calibrations: Mapping[str, CalibrationResult]) -> str:
    """A channel's origin, unit and calibrations as text: all that its values depend on beside the raw data."""
    # a place, a note or a role changes the catalogue's row, never the values
    data = bound.channel.model_dump(mode="json", exclude={"at", "relative_to", "notes"})
    named = bound.channel.calibration
    names = [named] if isinstance(named, str) else list(named or [])
    return json.dumps(
        [
            bound.name,
            data,
            bound.unit,
            None if bound.signal is None else dataclasses.asdict(dataclasses.replace(bound.signal, properties={})),
            [(n, repr(calibrations.get(n))) for n in names],
        ],
        sort_keys=True,
        default=str,
    )
