"""Content keys of the tidy layer: what a file of it is made from, so that an edit re-tidies only what changed."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from thermodata.calibration.measuring import measuring_names
from thermodata.calibration.result import CalibrationResult
from thermodata.schema.files.campaign import Channel
from thermodata.schema.units.quantity import MEASURED
from thermodata.store.base.files import key_of
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import Clock, Span
from thermodata.store.tidy.flags.overrule import rules_of
from thermodata.store.tidy.plan import derive
from thermodata.store.tidy.plan.plan import SCHEDULE, Bound, SourcePlan, TestPlan
from thermodata.store.tidy.rows.on_change import BY_HAND
from thermodata.store.tidy.values.series import Member

# counts the changes of calibration, flagging and layout that make older tidy files out of date
TIDY_VERSION = "41"


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
    measuring = plan.test.measuring if any(b.channel.quantity in MEASURED for b in here) else None
    used = _used(plan, here, measuring_names(measuring))
    members = sorted({(b.source, b.stream) for b in used.values()} | {member})
    parts = [TIDY_VERSION, repr(member), repr(list(columns)), repr(span), repr(measuring)]
    parts += _of_rules(plan, {b.name for b in here})
    parts += _of_channels(plan, used, texts)
    for source, stream in members:
        if source in plan.sources:
            parts += _of_stream(plan.sources[source], source, stream, clocks[source])
    if any(source == SCHEDULE for source, _ in members):
        # the schedule's grid ends with the reference sources
        parts += [_of_reference(plan, clocks), json.dumps(plan.test.conditions, sort_keys=True, default=str)]
    if any(source in plan.sources and plan.sources[source].shared for source, _ in members):
        parts.append(_of_reference(plan, clocks))
    return key_of(*parts)


def _used(plan: TestPlan, here: Iterable[Bound], measuring: Iterable[str]) -> dict[str, Bound]:
    """The channels of a stream, and all that they and the rule of what is measured are made from."""
    used: dict[str, Bound] = {}
    for bound in (*here, *(plan.bound[name] for name in measuring if name in plan.bound)):
        _collect(plan, bound, used)
    return used


def _of_rules(plan: TestPlan, names: Set[str]) -> Iterator[str]:
    """What a person overruled in these channels; nothing where that is nothing."""
    rules = [r for r in rules_of(plan.campaign, plan.test.id) if r.channel is None or r.channel in names]
    if rules:
        yield repr([r.model_dump(mode="json", exclude={"tests"}) for r in rules])


def _of_channels(plan: TestPlan, used: Mapping[str, Bound], texts: ChannelTexts) -> Iterator[str]:
    for name in sorted(used):
        yield texts.of(used[name])
        if used[name].channel.quantity in BY_HAND and (beside := plan.step_beside(used[name])):
            yield repr((name, beside))


def _of_stream(plan: SourcePlan, source: str, stream: str, clock: Clock) -> Iterator[str]:
    """Its raw files, the parts of them that are of this test, and its clock."""
    raws = plan.streams.get(stream, [])
    own = {r.path for r in raws}
    if parts := sorted((k, repr(v)) for k, v in plan.parts.items() if k[0] in own):
        yield repr(parts)
    yield from (source, stream, repr([(r.key, r.path, *_shift_of(r)) for r in raws]))
    yield repr((clock.offset_ns, clock.drift_ppm, clock.base_ns, clock.suspect, plan.spec.clock.resets, plan.shared))


def _of_reference(plan: TestPlan, clocks: Mapping[str, Clock]) -> str:
    """The raw files and clocks that say when the test ran."""
    return repr([(r.key, *_shift_of(r), clocks[s.name]) for s in plan.reference for r in s.raws])


def _shift_of(raw: RawStream) -> tuple[int, ...]:
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
