"""The channels of one source as a draft has them: what each signal is, from all files that have it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence, Set
from dataclasses import dataclass, field

from thermodata.draft.campaign.extremes import extremes_among, extremes_note
from thermodata.draft.campaign.of_exports import as_exported
from thermodata.draft.campaign.orientation import calibration_of, moved_too, reads_a_length, sign_of
from thermodata.draft.campaign.parts import DraftChannel, DraftJump
from thermodata.draft.campaign.said_of import said_of
from thermodata.draft.campaign.wished_names import wished_name, with_series
from thermodata.draft.folder.one_signal import OneSignal, joined_over_heads, joined_over_units
from thermodata.draft.folder.sources import Group
from thermodata.draft.probes.jumps import JumpTest
from thermodata.draft.probes.same_probe import own_name
from thermodata.draft.signals.guess import called
from thermodata.draft.signals.own_scale import scale_note
from thermodata.draft.signals.quantity import Guess
from thermodata.draft.signals.two_units import with_both_units
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import channel_name, parts_of, words
from thermodata.reader.signals.row_units import UNIT_OF
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.ways_said import WAY
from thermodata.reader.text.rows.quality_columns import QUALITY_OF
from thermodata.schema.agreed.exported import (
    OF_TEST,
    UNSIGNED,
    flags_of,
    is_own,
    is_own_export,
    own_channel,
    own_sign,
)
from thermodata.schema.units.quantity import normal_unit
from thermodata.schema.words.sentences import counted, listed, with_count

_MOST_SIGNALS, _MOST_LINES = 2000, 2
_TAG_NUMBER = re.compile(r"(?i)(?:numeric|tag|item|point|node)[ _]?id$")


@dataclass(frozen=True, slots=True)
class _Making:
    """What the channels of a source are made with. names: of all its signals; twice: those that stand in several
    streams of a file; exported: it is an export of this program; several: it has several streams; taken, calibrations:
    names of channels, and jump tests, so far, which each channel adds to."""

    group: Group
    jumps: Sequence[JumpTest]
    names: Set[str]
    twice: Set[str]
    exported: bool
    several: bool
    taken: set[str]
    calibrations: list[DraftJump]


@dataclass(slots=True)
class _LeftOut:
    """What of a source is no channel. notes: on each that says something by itself; of_test: columns of an export that
    say which test it is of; flags: the store's, in an export; beside: what tells the quality or the number of another
    signal; extremes: what a logger wrote of one that it averaged, and that one."""

    source: str
    notes: list[str] = field(default_factory=list)
    of_test: set[str] = field(default_factory=set)
    flags: list[str] = field(default_factory=list)
    beside: list[str] = field(default_factory=list)
    extremes: dict[str, str] = field(default_factory=dict)

    def takes(self, one: OneSignal, names: Set[str]) -> bool:
        """Keeps what an export says of the test, and flags of other columns; whether it is either."""
        last = parts_of(split_unit(one.signal.name)[0])[-1]
        if last in OF_TEST:
            self.of_test.add(last)
        elif flags_of(one.signal.name) in names:
            self.flags.append(one.written)
        else:
            return False
        return True

    def told(self, exported: bool) -> list[str]:
        """All notes on them."""
        notes = [*self.notes]
        if exported:
            say = "says" if len(self.of_test) == 1 else "say"
            left = f"; {listed(sorted(self.of_test))} {say} of which test: left out" if self.of_test else ""
            notes.append(f"{self.source}: an export of thermodata{left}")
        if self.flags:
            notes.append(
                f"{self.source}: {with_count(self.flags, 4)}: left out, for they hold the flags of the store that the "
                "export is of; ingest flags anew"
            )
        if self.beside:
            shown = with_count(self.beside, 4)
            notes.append(
                f"{self.source}: {shown}: left out, for they tell the quality or the number of a signal beside them"
            )
        return [*notes, extremes_note(self.source, self.extremes)] if self.extremes else notes


def channels_of(
    group: Group, jumps: Sequence[JumpTest], in_tests: Set[str], taken: set[str], calibrations: list[DraftJump]
) -> tuple[list[DraftChannel], list[str]]:
    """Channels of a source, and notes. jumps: of its probes; in_tests: the own names of the signals that tests have,
    which a jump test may have under another head."""
    found = [
        one
        for one in joined_over_heads(joined_over_units(group.signals), group.files)
        if own_name(one.signal.name) not in in_tests or any(f in group.files for f in one.files)
    ]
    making = _making(group, jumps, found, taken, calibrations)
    more = len(found) - _MOST_SIGNALS
    left = _LeftOut(group.source)
    if more > 0:
        left.notes.append(f"{group.source}: {counted(more, 'more signal')}, left out of the draft")
    made, seen, extremes = [], set[str](), {} if making.exported else extremes_among(found)
    for one in found[:_MOST_SIGNALS]:
        name = one.signal.name
        if name in seen and name not in making.twice:
            continue  # the same signal, in a stream of another name
        seen.add(name)
        if making.exported and left.takes(one, making.names):
            continue
        said, note = said_of(one)
        said = as_exported(said, one.signal)
        if (why := _why_left_out(one, said, found)) is not None:
            left.notes.append(f"{group.source}: '{one.written}' {why}: left out")
        elif _is_of_others(one):
            left.beside.append(one.written)
        elif name in extremes:
            left.extremes[one.written] = extremes[name]
        else:
            made.append(_channel(making, one, said, note))
    return made, left.told(making.exported)


def _making(
    group: Group,
    jumps: Sequence[JumpTest],
    found: Sequence[OneSignal],
    taken: set[str],
    calibrations: list[DraftJump],
) -> _Making:
    counts = (Counter(s.name for s in f.signals) for f in (*group.files, *group.calibrations))
    names = {one.signal.name for one in found}
    return _Making(
        group,
        jumps,
        names,
        twice={name for count in counts for name, k in count.items() if k > 1},
        exported=is_own_export([split_unit(n)[0] for n in names])
        or any(is_own(one.signal.name, one.signal.properties) for one in found),
        several=len({one.signal.stream for one in found}) > 1,
        taken=taken,
        calibrations=calibrations,
    )


def _channel(making: _Making, one: OneSignal, said: Guess, note: str | None) -> DraftChannel:
    """note: what its files call it beside its name."""
    signal, twin = one.signal, one.signal.name in making.twice
    jump, said = _with_jump(one, said, making.jumps, twin)
    own = own_channel(split_unit(signal.name)[0]) if making.exported else None
    name = channel_name(own or wished_name(with_series(signal), said), making.taken)
    turned = making.exported and said.axis is not None and _is_signed(one)
    calibration, said = _calibrated(making, name, one, said, jump, turned)
    said = with_both_units(said, one.seen())
    only, lacking = _tests_with(one, making.group)
    notes = (note, scale_note(one.of(f) or signal for f in one.files), _way(one) if said.axis else None)
    return DraftChannel(
        name,
        making.group.source,
        f"{signal.stream}:{one.written}" if twin else one.written,
        signal.stream if making.several else None,
        said,
        calibration,
        only,
        lacking,
        "; ".join(filter(None, notes)) or None,
        turned and calibration == f"sign_{name}",
    )


def _own_sign(one: OneSignal) -> str | None:
    """The sign that exports say of a signal; unknown where one of several files says none."""
    signs = {own_sign(s.name, s.properties) for f in one.files for s in [one.of(f) or one.signal]}
    return signs.pop() if len(signs) == 1 else "unknown" if any(signs) else None


def _is_signed(one: OneSignal) -> bool:
    """Whether exports say that a displacement goes along its axis: by its sign; in CSV, whose names have their units,
    by its name alone."""
    sign, (name, unit) = _own_sign(one), split_unit(one.signal.name)
    return UNSIGNED not in name and (unit is not None if sign is None else sign != "unknown")


def _why_left_out(one: OneSignal, said: Guess, found: Sequence[OneSignal]) -> str | None:
    """Why a signal is no channel, though it says something by itself; None where it is one."""
    if said.quantity is None and one.signal.unit is None and _counts_rows(one):
        return "numbers the rows of each file"
    if (of := _unit_of(one, found)) is not None:
        return f"holds the unit of '{of.written}', which is taken"
    return None


def _with_jump(one: OneSignal, said: Guess, jumps: Sequence[JumpTest], twin: bool) -> tuple[JumpTest | None, Guess]:
    """(the jump test of a signal; what the signal is by it). twin: another stream has a signal of its name."""
    signal, keys = one.signal, [(s.stream, s.name) for s in one.spellings]
    jump = next((j for j in jumps if j.signal in keys or (not twin and any(j.is_of(*k) for k in keys))), None)
    if jump is None and said.quantity == "displacement" and not twin:
        jump, said = moved_too(signal, said, jumps)
    if jump is not None and said.quantity == "voltage":
        said = _moved_probe(said, called(signal))
    return jump, said


def _calibrated(
    making: _Making, name: str, one: OneSignal, said: Guess, jump: JumpTest | None, turned: bool
) -> tuple[str | None, Guess]:
    """(the calibration of a displacement; what the channel is by it). turned: an export has its sign already."""
    if said.quantity != "displacement":
        return None, said
    if normal_unit(said.unit or "V") in ("V", "mV") and not reads_a_length(one):
        return calibration_of(name, one.signal, said, jump, making.jumps, making.calibrations)
    if jump is None and turned:
        return f"sign_{name}", said
    if said.at == "tcp" or jump is not None:
        return sign_of(name, one.signal, said, jump, making.calibrations)
    return None, said


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


def _is_of_others(one: OneSignal) -> bool:
    """Whether a signal says something of another one and nothing of the machine: the quality by which its reader flags
    a column beside it, or the constant number of a tag (`T_air_NUMERICID`)."""
    own = one.seen()
    if own and all(QUALITY_OF in s.properties for s, _ in own):
        return True
    if one.signal.unit is not None or not _TAG_NUMBER.search(one.signal.name):
        return False
    seen = [v for _, v in own]
    return bool(seen) and all(v is not None and v.constant and v.whole for v in seen)


def _counts_rows(one: OneSignal) -> bool:
    """Whether a signal numbers the rows of each file that has it."""
    seen = [v for _, v in one.seen()]
    return bool(seen) and all(v is not None and v.counts_rows for v in seen)


def _unit_of(one: OneSignal, found: Sequence[OneSignal]) -> OneSignal | None:
    """The signal of numbers whose unit a column says, by its reader."""
    of = one.signal.properties.get(UNIT_OF)
    return next(
        (o for o in found if of is not None and (o.signal.stream, o.signal.name) == (one.signal.stream, of)), None
    )


def _moved_probe(said: Guess, name: str) -> Guess:
    """What is in volts and moved in a jump test: a displacement, along the axis that its name says."""
    letter = (axis_of(words(parts_of(name)[-1])) or "").upper()
    axis = letter if letter in ("X", "Y", "Z") else None
    return Guess("displacement", said.unit, "tcp", axis, False, ("data",), () if axis else ("axis?",))
