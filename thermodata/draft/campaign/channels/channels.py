"""The channels of one source as a draft has them: what each signal is, from all files that have it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace

from thermodata.draft.campaign.channels.left_out import LeftOut
from thermodata.draft.campaign.channels.of_exports import as_exported
from thermodata.draft.campaign.channels.said_of import said_of
from thermodata.draft.campaign.channels.wished_names import wished_name, with_series
from thermodata.draft.campaign.jumps.orientation import Turned, calibration_of, moved_too, reads_a_length, sign_of
from thermodata.draft.campaign.parts import DraftChannel, DraftJump
from thermodata.draft.folder.into_sources.one_signal import OneSignal, joined_over_heads, joined_over_units
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.probes.at_rail import at_rail
from thermodata.draft.probes.jumps import JumpTest, is_length, is_nameless
from thermodata.draft.probes.same_probe import own_name
from thermodata.draft.signals.guess import called
from thermodata.draft.signals.quantity.guessed import NOTHING, Guess
from thermodata.draft.signals.told_before import as_told, name_told
from thermodata.draft.signals.told_units.own_scale import scale_note
from thermodata.draft.signals.told_units.two_units import with_both_units
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import channel_name, parts_of, words
from thermodata.draft.words.place import place_of
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.ways_said import WAY
from thermodata.schema.agreed.exported import UNSIGNED, is_own, is_own_export, own_channel, own_sign
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.sentences import counted

_MOST_SIGNALS, _MOST_LINES = 2000, 2


@dataclass(frozen=True, slots=True)
class ChannelsOfSource:
    """What the signals of one source make. calibrations: jump tests of its channels; notes: on what is left out."""

    channels: tuple[DraftChannel, ...]
    calibrations: tuple[DraftJump, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Source:
    """A source, and what its signals say together. jumps: of its probes; twice: names that stand in several streams of
    a file; exported: it is an export of this program; several: it has several streams."""

    group: Group
    jumps: Sequence[JumpTest]
    twice: Set[str]
    exported: bool
    several: bool


def channels_of(group: Group, jumps: Sequence[JumpTest], in_tests: Set[str], taken: Set[str]) -> ChannelsOfSource:
    """The channels of a source. jumps: of its probes; in_tests: the own names of the signals that tests have, which a
    jump test may have under another head; taken: the names of other channels, in lower case."""
    found = [
        one
        for one in joined_over_heads(joined_over_units(group.signals), group.files)
        if own_name(one.signal.name) not in in_tests or any(f in group.files for f in one.files)
    ]
    source = _source(group, jumps, found)
    left = LeftOut(group.source, found, source.exported)
    channels: list[DraftChannel] = []
    calibrations: list[DraftJump] = []
    names = {*taken}
    for one in _each_once(found[:_MOST_SIGNALS], source.twice):
        said, note = said_of(one)
        said = as_told(as_exported(said, one.signal), one.signal)
        if left.takes(one, said):
            continue
        channel, jump = _channel(source, one, said, note, names)
        names.add(channel.name.lower())
        channels.append(channel)
        calibrations += [jump] if jump is not None else []
    more = len(found) - _MOST_SIGNALS
    cut = [f"{group.source}: {counted(more, 'more signal')}, left out of the draft"] if more > 0 else []
    return ChannelsOfSource(tuple(channels), tuple(calibrations), (*cut, *left.told()))


def _source(group: Group, jumps: Sequence[JumpTest], found: Sequence[OneSignal]) -> _Source:
    counts = (Counter(s.name for s in f.signals) for f in (*group.files, *group.calibrations))
    return _Source(
        group,
        jumps,
        twice={name for count in counts for name, k in count.items() if k > 1},
        exported=is_own_export([split_unit(one.signal.name)[0] for one in found])
        or any(is_own(one.signal.name, one.signal.properties) for one in found),
        several=len({one.signal.stream for one in found}) > 1,
    )


def _each_once(found: Sequence[OneSignal], twice: Set[str]) -> Iterator[OneSignal]:
    """Without those that are a signal before them, in a stream of another name."""
    seen = set[str]()
    for one in found:
        if one.signal.name not in seen or one.signal.name in twice:
            yield one
        seen.add(one.signal.name)


def _channel(
    source: _Source, one: OneSignal, said: Guess, note: str | None, taken: Set[str]
) -> tuple[DraftChannel, DraftJump | None]:
    """(the channel of a signal, the jump test that turns it). note: what its files call it beside its name."""
    signal, twin = one.signal, one.signal.name in source.twice
    jump, said = _with_jump(one, said, source.jumps, twin)
    own = own_channel(split_unit(signal.name)[0]) if source.exported else None
    name = channel_name(own or name_told(signal) or wished_name(with_series(signal), said), taken)
    signed = source.exported and said.axis is not None and _is_signed(one)
    turned = _turned(source, name, one, said, jump, signed)
    only, lacking = _tests_with(one, source.group)
    notes = (note, scale_note(one.of(f) or signal for f in one.files), _way(one) if turned.said.axis else None)
    channel = DraftChannel(
        name,
        source.group.source,
        f"{signal.stream}:{one.written}" if twin else one.written,
        signal.stream if source.several else None,
        with_both_units(turned.said, one.seen()),
        turned.calibration,
        only,
        lacking,
        "; ".join(filter(None, notes)) or None,
        signed and turned.calibration == f"sign_{name}",
    )
    return channel, turned.jump


def _turned(source: _Source, name: str, one: OneSignal, said: Guess, jump: JumpTest | None, signed: bool) -> Turned:
    """How a displacement comes to the axes of the machine; of anything else nothing. signed: an export has its sign."""
    if said.quantity != "displacement":
        return Turned(said)
    if normal_unit(said.unit or "V") in ("V", "mV") and not reads_a_length(one):
        if (asked := at_rail([v for _, v in one.seen()], said.unit)) is not None:
            return Turned(replace(said, sure=False, questions=(*said.questions, asked)))
        return calibration_of(name, one.signal, said, jump, source.jumps)
    if jump is None and signed:
        return Turned(said, f"sign_{name}")
    if said.at == "tcp" or jump is not None:
        return sign_of(name, one.signal, said, jump)
    return Turned(said)


def _own_sign(one: OneSignal) -> str | None:
    """The sign that exports say of a signal; unknown where one of several files says none."""
    signs = {own_sign(s.name, s.properties) for f in one.files for s in [one.of(f) or one.signal]}
    return signs.pop() if len(signs) == 1 else "unknown" if any(signs) else None


def _is_signed(one: OneSignal) -> bool:
    """Whether exports say that a displacement goes along its axis: by its sign; in CSV, whose names have their units,
    by its name alone."""
    sign, (name, unit) = _own_sign(one), split_unit(one.signal.name)
    return UNSIGNED not in name and (unit is not None if sign is None else sign != "unknown")


def _with_jump(one: OneSignal, said: Guess, jumps: Sequence[JumpTest], twin: bool) -> tuple[JumpTest | None, Guess]:
    """(the jump test of a signal; what the signal is by it). twin: another stream has a signal of its name."""
    signal, keys = one.signal, [(s.stream, s.name) for s in one.spellings]
    jump = next((j for j in jumps if j.signal in keys or (not twin and any(j.is_of(*k) for k in keys))), None)
    if jump is None and said.quantity == "displacement" and not twin:
        jump, said = moved_too(signal, said, jumps)
    if jump is not None and (said.quantity == "voltage" or is_length(said) or is_nameless(said)):
        said = _moved_probe(said, called(signal), jump.file.path.stem)
    return jump, said


def _tests_with(one: OneSignal, group: Group) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """(tests that have a signal, those that lack it); both empty where all have it, or none."""
    own = {id(f) for f in one.files}
    having = {t for t, fs in group.tests.items() if any(id(f) in own for f in fs)}
    if not having or len(having) == len(group.tests):
        return (), ()
    return tuple(t for t in group.tests if t in having), tuple(t for t in group.tests if t not in having)


def _way(one: OneSignal) -> str | None:
    """What the heads of its files say of the sign of a displacement, or of its jumps."""
    lines = dict.fromkeys(s.properties[WAY] for f in one.files if (s := one.of(f)) and WAY in s.properties)
    shown = "', '".join(list(lines)[:_MOST_LINES])
    return f"the head of the file says '{shown}'" if lines else None


def _moved_probe(said: Guess, name: str, jump: str) -> Guess:
    """What is in volts, a length or nothing that is known, and moved in a jump test: a displacement, along the axis
    that its name says. jump: what the test's file is called, which may have the part that the probe looks at."""
    letter = (axis_of(words(parts_of(name)[-1])) or "").upper()
    axis = letter if letter in ("X", "Y", "Z") else None
    place = place_of(words(jump), "displacement")
    unit = (said.why_not or "").replace(NOTHING, "unit: um, mm, m or V?", 1)  # of what nothing else told
    questions = (*filter(None, (unit, place.question)), *(() if axis else ("axis?",)))
    return Guess("displacement", said.unit, place.at, axis, False, ("data",), questions)
