"""Which signal of which stream each channel of a test is."""

from __future__ import annotations

import re
from collections.abc import Mapping

from thermodata.errors import UsageError
from thermodata.reader.finding.match import NoSignalError
from thermodata.reader.text.names.unit_in_name import other_unit
from thermodata.schema.files.campaign import Campaign, Channel, SourceSpec, Test
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.quantity import STATES
from thermodata.store.tidy.plan import schedule
from thermodata.store.tidy.plan.plan import SCHEDULE, Bound, SourcePlan, TestPlan
from thermodata.store.tidy.rows.in_parts import FoundSignal, find_in_parts

_Read = dict[tuple[str, str, str], tuple[str, FoundSignal]]  # (source, stream, signal) -> (channel, what it is of it)


def effective(campaign: Campaign, test: Test) -> dict[str, Channel]:
    """The channels as they are in this test: overrides applied, absent ones left out."""
    channels = {}
    for name, channel in campaign.channels.items():
        override = test.channels.get(name)
        if override is not None:
            if override.absent:
                continue
            changes = {k: getattr(override, k) for k in override.model_fields_set if k != "absent"}
            if "schedule" in changes and channel.schedule is None:
                changes |= {"source": None, "signal": None, "derive": None}
            elif "signal" in changes:
                changes |= {"derive": None, "schedule": None}
            channel = channel.model_copy(update=changes)
        channels[name] = channel
    return channels


def bind(plan: TestPlan) -> None:
    """Finds the signal of every channel; what can't be found becomes a problem with the nearest right name. Derived
    channels are those of a campaign that passed `check_derived`."""
    channels = effective(plan.campaign, plan.test)
    read: _Read = {}
    for name, channel in channels.items():
        if channel.schedule is not None:
            _bind_schedule(plan, name, channel)
        elif channel.signal is not None and channel.source is not None:
            source = plan.sources.get(channel.source)
            if source is not None and source.raws:  # a source's absence is told once, not for each channel
                _bind_signal(plan, source, name, channel, read)
    for name, channel in channels.items():
        if channel.derive is not None:
            _bind_derived(plan, channels, name, channel)
    order = list(plan.campaign.channels)
    plan.bound = {n: plan.bound[n] for n in sorted(plan.bound, key=order.index)}
    _say_what_parts_it(plan)


def _bind_schedule(plan: TestPlan, name: str, channel: Channel) -> None:
    try:
        schedule.steps(name, channel, plan.test)
    except UsageError as error:
        plan.problems.append(_refused(name, error))
        return
    plan.bound[name] = Bound(name, channel, SCHEDULE, SCHEDULE)


def _bind_signal(plan: TestPlan, source: SourcePlan, name: str, channel: Channel, read: _Read) -> None:
    """read: the signals that channels before it have, which it is added to."""
    found = _found_signal(plan, source, name, channel)
    if found is None:
        return
    before, as_before = read.setdefault((source.name, found.raw.stream, found.signal.name), (name, found))
    if as_before.parts != found.parts:
        plan.problems.append(
            f"channel '{name}': '{found.signal.name}' is in another unit in some files, and '{before}' has it "
            "otherwise of them; try: a source of its own for one of both, with the same files"
        )
        return
    source.parts |= found.parts
    if found.note is not None:
        plan.notes.append(f"channel '{name}': {found.note}")
    if channel.unit is None:
        _tell_two_units(plan, name, found, channel)
    unit = channel.unit or found.unit
    plan.bound[name] = Bound(name, channel, source.name, found.raw.stream, found.signal, unit)


def _found_signal(plan: TestPlan, source: SourcePlan, name: str, channel: Channel) -> FoundSignal | None:
    """None where there is none, which the plan tells unless the channel may lack there."""
    try:
        return find_in_parts(source.raws, channel)
    except NoSignalError as error:
        if _is_the_time(channel.signal or "", source.spec):
            plan.notes.append(f"channel '{name}' is the time of '{source.name}': its line can be deleted")
        elif not channel.may_lack(plan.test.id):
            plan.problems.append(_no_signal(name, error, plan.test.id, source.spec))
    except UsageError as error:
        plan.problems.append(_refused(name, error))
    return None


def _refused(name: str, error: UsageError) -> str:
    return f"channel '{name}': " + "; ".join(str(error).splitlines())


def _tell_two_units(plan: TestPlan, name: str, found: FoundSignal, channel: Channel) -> None:
    """Tells of a signal whose name says another unit than its file, where the campaign file says none. One of both is
    wrong where they convert; where not, the name may be of before the file's scaling."""
    own = other_unit(found.signal.name, found.signal.unit, channel.quantity == "temperature_difference")
    if own is None or found.signal.scaling is not None or channel.quantity in STATES:
        return
    by = str(found.signal.unit)
    (plan.problems if converts(own, by) else plan.notes).append(
        f"channel '{name}': the name '{found.signal.name}' says {own}, and the file gives it in {by}, which is taken; "
        f'try: unit: "{by}" in the channel, or, where the name is right, unit: "{own}", instead_of: "{by}"'
    )


def _say_what_parts_it(plan: TestPlan) -> None:
    """Where the displacements of a test stand in a file of many tests."""
    shared = [s.name for s in plan.reference if s.shared] if plan.test.window is None else []
    name = plan.test.id
    if plan.cut_by:
        plan.notes.append(
            f"test '{name}': its displacements stand in a log of many tests, which is cut where the files of "
            f"'{', '.join(plan.cut_by)}' begin and end; if that is wrong: window: [from, to]"
        )
    elif shared and len(plan.campaign.tests) > 1 and len(shared) == len(plan.reference):
        plan.problems.append(
            f"test '{name}': all of '{', '.join(shared)}' is taken for it, as for the other tests, for nothing says "
            "when it was; try: window: [from, to] in the test"
        )


def _no_signal(name: str, error: NoSignalError, test: str, spec: SourceSpec) -> str:
    said = "; ".join(str(error).splitlines())
    lead = " Or" if "try: " in said else "; try:"
    time = "; delete the channel where its column is the time that is declared" if _times(spec) else ""
    return f"channel '{name}': {said}{lead} 'missing_in: [{test}]' in the channel where the test's files lack it{time}"


def _is_the_time(wanted: str, spec: SourceSpec) -> bool:
    """Whether a name is that of a column which the source declares as its time: that is no signal."""
    return any(isinstance(c, str) and c.casefold() == wanted.casefold() for c in _times(spec))


def _times(spec: SourceSpec) -> list[int | str]:
    """The columns that a source declares as its times."""
    said = spec.table.time if spec.table is not None else None
    each = said if isinstance(said, list) else [said] if said is not None else []
    return [c for one in each if one.column is not None for c in _as_list(one.column)]


def _as_list(columns: int | str | list[int | str]) -> list[int | str]:
    return columns if isinstance(columns, list) else [columns]


def _operands(expression: str) -> list[str]:
    """The channels of an expression in the order of their first appearance."""
    from thermodata.calibration.expression.parser import parse

    words, names = re.findall(r"[^\W\d]\w*(?:\.[^\W\d]\w*)*", expression), parse(expression, rates=True).names
    return list(dict.fromkeys(word for word in words if word in names))


def _bind_derived(plan: TestPlan, channels: Mapping[str, Channel], name: str, channel: Channel) -> Bound | None:
    """None where an operand is absent in this test: so is what derives from it."""
    if name in plan.bound:
        return plan.bound[name]
    home: Bound | None = None
    for operand in _operands(channel.derive or ""):
        bound = plan.bound.get(operand)
        if bound is None and operand in channels and channels[operand].derive is not None:
            bound = _bind_derived(plan, channels, operand, channels[operand])
        if bound is None:
            return None
        if home is None or (home.source == SCHEDULE and bound.source != SCHEDULE):
            home = bound
    if home is None:
        plan.problems.append(f"channel '{name}': derive names no channel: {channel.derive}")
        return None
    if (other := _rated_elsewhere(plan, channel, home)) is not None:
        plan.problems.append(
            f"channel '{name}': a rate is of the rows of its own log, and '{other.name}' has none where '{home.name}' "
            f"stands; try: derive rate({other.name}) as a channel of its own, and write that one here"
        )
        return None
    plan.bound[name] = Bound(name, channel, home.source, home.stream, None, channel.unit)
    return plan.bound[name]


def _rated_elsewhere(plan: TestPlan, channel: Channel, home: Bound) -> Bound | None:
    """A channel whose rate an expression takes, and that has no rows of its own where it is derived."""
    from thermodata.calibration.expression.parser import parse

    rated = [plan.bound[n] for n in sorted(parse(channel.derive or "", rates=True).rated)]
    there = (home.source, home.stream)
    return next((b for b in rated if b.signal is None or (b.source, b.stream) != there), None)
