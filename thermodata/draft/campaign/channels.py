"""The channels of one source as a draft has them: what each signal is, from all files that have it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence, Set
from dataclasses import replace

from thermodata.draft.campaign.beside_others import coldest_in, in_fahrenheit
from thermodata.draft.campaign.of_exports import as_exported
from thermodata.draft.campaign.orientation import calibration_of, moved_too, reads_a_length, sign_of
from thermodata.draft.campaign.parts import DraftChannel, DraftJump
from thermodata.draft.campaign.wished_names import wished_name, with_series
from thermodata.draft.folder.legend import IN_LEGEND, TOLD_TOO
from thermodata.draft.folder.one_signal import OneSignal, joined_over_heads, joined_over_units
from thermodata.draft.folder.sources import Group
from thermodata.draft.probes.jumps import JumpTest
from thermodata.draft.probes.same_probe import own_name
from thermodata.draft.signals.guess import called, guess, told_of
from thermodata.draft.signals.head_said import with_head, with_text
from thermodata.draft.signals.other_units import unit_question
from thermodata.draft.signals.own_scale import scale_note
from thermodata.draft.signals.quantity import Guess, range_text
from thermodata.draft.signals.scale_said import as_scaled, with_scale_asked
from thermodata.draft.signals.standard_units import with_standard_unit
from thermodata.draft.signals.two_units import with_both_units
from thermodata.draft.signals.values import Values, in_unit, joined
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import channel_name, parts_of, words
from thermodata.plugin import Signal
from thermodata.reader.signals.row_units import UNIT_OF
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.units_said import HEAD
from thermodata.reader.text.preamble.ways_said import WAY
from thermodata.reader.text.rows.quality_columns import QUALITY_OF, STATE_OF
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
    more = len(found) - _MOST_SIGNALS
    notes = [f"{group.source}: {counted(more, 'more signal')}, left out of the draft"] if more > 0 else []
    twice = {
        n for f in (*group.files, *group.calibrations) for n, k in Counter(s.name for s in f.signals).items() if k > 1
    }
    names = {one.signal.name for one in found}
    exported = is_own_export([split_unit(n)[0] for n in names]) or any(
        is_own(one.signal.name, one.signal.properties) for one in found
    )
    several = len({one.signal.stream for one in found}) > 1
    made, seen, beside, of_test, flags = [], set(), list[str](), set[str](), list[str]()
    for one in found[:_MOST_SIGNALS]:
        signal, twin = one.signal, one.signal.name in twice
        if signal.name in seen and not twin:
            continue  # the same signal, in a stream of another name
        seen.add(signal.name)
        if exported and (last := parts_of(split_unit(signal.name)[0])[-1]) in OF_TEST:
            of_test.add(last)
            continue
        if exported and flags_of(signal.name) in names:
            flags.append(one.written)
            continue
        said, note = _said(one)
        said = as_exported(said, signal)
        if (why := _why_left_out(one, said, found)) is not None:
            notes.append(f"{group.source}: '{one.written}' {why}: left out")
            continue
        if _is_of_others(one):
            beside.append(one.written)
            continue
        jump, said = _with_jump(one, said, jumps, twin)
        own = own_channel(split_unit(signal.name)[0]) if exported else None
        name = channel_name(own or wished_name(with_series(signal), said), taken)
        turned = exported and said.axis is not None and _is_signed(one)
        calibration, said = _calibrated(name, one, said, jump, turned, jumps, calibrations)
        said = with_both_units(said, one.seen())
        only, lacking = _tests_with(one, group)
        notes_of = (note, scale_note(one.of(f) or signal for f in one.files), _way(one) if said.axis else None)
        made.append(
            DraftChannel(
                name,
                group.source,
                f"{signal.stream}:{one.written}" if twin else one.written,
                signal.stream if several else None,
                said,
                calibration,
                only,
                lacking,
                "; ".join(filter(None, notes_of)) or None,
                turned and calibration == f"sign_{name}",
            )
        )
    if exported:
        say = "says" if len(of_test) == 1 else "say"
        left = f"; {listed(sorted(of_test))} {say} of which test: left out" if of_test else ""
        notes.append(f"{group.source}: an export of thermodata{left}")
    if flags:
        notes.append(
            f"{group.source}: {with_count(flags, 4)}: left out, for they hold the flags of the store that the export "
            "is of; ingest flags anew"
        )
    if beside:
        shown = with_count(beside, 4)
        notes.append(
            f"{group.source}: {shown}: left out, for they tell the quality or the number of a signal beside them"
        )
    return made, notes


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
    name: str,
    one: OneSignal,
    said: Guess,
    jump: JumpTest | None,
    turned: bool,
    jumps: Sequence[JumpTest],
    calibrations: list[DraftJump],
) -> tuple[str | None, Guess]:
    """(the calibration of a displacement; what the channel is by it). turned: an export has its sign already."""
    if said.quantity != "displacement":
        return None, said
    if normal_unit(said.unit or "V") in ("V", "mV") and not reads_a_length(one):
        return calibration_of(name, one.signal, said, jump, jumps, calibrations)
    if jump is None and turned:
        return f"sign_{name}", said
    if said.at == "tcp" or jump is not None:
        return sign_of(name, one.signal, said, jump, calibrations)
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


def _said(one: OneSignal) -> tuple[Guess, str | None]:
    """The guess of a signal from all files that have it, with a question where they disagree on it; the note says what
    they call it beside its name."""
    values, signal = None, one.signal
    units = Counter((one.of(f) or signal).unit for f in one.files)
    usual = units.most_common(1)[0][0]
    called_so: Counter[str] = Counter()
    seen: dict[str, Values | None] = {}
    heads: dict[str, list[str]] = {}
    own_signals: dict[str, Signal] = {}
    for f in one.files:
        own = one.of(f) or signal
        seen[str(f.path)] = f.sample.values.get((own.stream, own.name))
        values = joined(values, in_unit(seen[str(f.path)], own.unit, usual))
        called_so[own.properties.get("description", "")] += 1
        own_signals[f.path.name] = own
        heads.setdefault(own.properties.get(HEAD, ""), []).append(f.path.name)
    if signal.dtype == "str" and None in seen.values():
        values = None  # words in one test that are no switch's
    where = signal.properties.get(IN_LEGEND)
    note: str | None = f"called '{next(iter(called_so))}' in {where or 'the file'}"
    note = note if len(called_so) == 1 and "" not in called_so else None
    # a scaling that stands in the file is applied at ingest: the numbers seen here are not yet in the unit
    said = guess(called(signal), usual, signal.dtype, None if signal.scaling else values, told_of(signal))
    if (scaled := as_scaled(values, own_signals.values())) is not None:
        # what values ask that are counts, the scale answers
        said = min(
            said, guess(called(signal), usual, signal.dtype, scaled, told_of(signal)), key=lambda g: len(g.questions)
        )
    said = with_standard_unit(replace(said, sure=False) if where else said, signal)
    if TOLD_TOO in signal.properties and said.quantity:
        asked = f"which is it? {where} says '{signal.properties['description']}' and '{signal.properties[TOLD_TOO]}'"
        said = replace(said, questions=(*said.questions, asked))
    if any(heads):
        said, note = with_head(said, signal, note, heads, values)
    said = with_scale_asked(with_text(said, next(iter(own_signals.values()), signal)), own_signals or {"": signal})
    if STATE_OF in signal.properties and said.quantity != "state":
        asked = (
            f"the state of '{signal.properties[STATE_OF]}'? ({range_text(values)}) which codes are bad is not known "
            "here: all rows count; leave those out by the test's measuring, or by a window"
        )
        known = values is not None and values.low >= 0 and values.high <= 1  # on and off
        as_state = replace(
            said, quantity="state", unit=None, instead_of=None, why_not=None, sure=False, basis=("name",)
        )
        return replace(as_state, questions=() if known else (asked,)), note
    if len(units) > 1 and said.quantity:
        names = ", ".join(f"{u or 'none'} ({n})" for u, n in units.most_common())
        asked = f"unit: the files disagree: {names}; each file's own is taken"
        return replace(said, unit=None, instead_of=None, sure=False, questions=(*said.questions, asked)), note
    coldest = {str(f.path): coldest_in(f) for f in one.files} if said.quantity == "temperature" else None
    questions = [unit_question(said.quantity, seen, coldest) if None in units else in_fahrenheit(said, one)]
    if len(called_so) > 1 and said.quantity:
        names = ", ".join(f"'{w}' ({n})" if w else f"nothing ({n})" for w, n in called_so.most_common())
        questions.append(f"the same in all tests? the files call it {names}")
    if asked_of := [q for q in questions if q]:
        said = replace(said, sure=False, questions=(*said.questions, *asked_of))
    return said, note
