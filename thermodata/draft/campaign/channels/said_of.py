"""What a signal is by all files that have it: its names, units, values, and what their heads and legends say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from thermodata.draft.campaign.channels.beside_others import coldest_in, in_fahrenheit
from thermodata.draft.files.sample import MOST_WORDS
from thermodata.draft.folder.beside.legend import IN_LEGEND, TOLD_TOO
from thermodata.draft.folder.into_sources.one_signal import OneSignal
from thermodata.draft.signals.guess import called, guess, told_of
from thermodata.draft.signals.head_said import with_head, with_text
from thermodata.draft.signals.implied_speed import with_speed_asked
from thermodata.draft.signals.quantity.guessed import Guess, range_text
from thermodata.draft.signals.told_units.other_units import unit_question
from thermodata.draft.signals.told_units.scale_said import as_scaled, with_scale_asked
from thermodata.draft.signals.told_units.standard_units import with_standard_unit
from thermodata.draft.signals.values import Values, in_unit, joined
from thermodata.plugin import Signal
from thermodata.reader.text.preamble.units_said import HEAD
from thermodata.reader.text.rows.quality_columns import STATE_OF
from thermodata.schema.words.on_off import SHOWN


@dataclass(frozen=True, slots=True)
class _InFiles:
    """A signal as each of its files has it. usual: the unit that most of them say, of those that say one; units, names:
    how often each is said; by_path: its values in each, in the file's own unit; heads: what stands over it -> the
    files; own: file name -> the signal there; values: of all files, in the usual unit, None where one lacks them;
    two_words: of a signal of texts, the two that stand in all files together, and both in one of them."""

    usual: str | None
    units: Counter[str | None]
    names: Counter[str]
    by_path: dict[str, Values | None]
    heads: dict[str, list[str]]
    own: dict[str, Signal]
    values: Values | None
    two_words: tuple[str, ...]


def _in_files(one: OneSignal) -> _InFiles:
    signals = [(f, one.of(f) or one.signal) for f in one.files]
    units = Counter(own.unit for _, own in signals)
    usual = next((unit for unit, _ in units.most_common() if unit), None)
    by_path = {str(f.path): f.sample.values.get((own.stream, own.name)) for f, own in signals}
    values = None
    heads: dict[str, list[str]] = {}
    for f, own in signals:
        values = joined(values, in_unit(by_path[str(f.path)], own.unit, usual))
        heads.setdefault(own.properties.get(HEAD, ""), []).append(f.path.name)
    words_of_no_switch = one.signal.dtype == "str" and None in by_path.values()
    return _InFiles(
        usual=usual,
        units=units,
        names=Counter(own.properties.get("description", "") for _, own in signals),
        by_path=by_path,
        heads=heads,
        own={f.path.name: own for f, own in signals},
        values=None if words_of_no_switch else values,
        two_words=_two_words([w for f, own in signals if (w := f.sample.words.get((own.stream, own.name)))]),
    )


def _two_words(by_file: Sequence[frozenset[str]]) -> tuple[str, ...]:
    """by_file: words of a signal in each of its files. Names of parts and tools are numbered, and no switch."""
    both = frozenset[str]().union(*by_file)
    numbered = any(c.isdigit() for word in both for c in word)
    return tuple(sorted(both)) if len(both) == MOST_WORDS and both in by_file and not numbered else ()


def said_of(one: OneSignal) -> tuple[Guess, str | None]:
    """The guess of a signal from all files that have it, with a question where they disagree on it; the note says what
    they call it beside its name."""
    signal, files = one.signal, _in_files(one)
    said = _by_name_and_values(signal, files)
    where = signal.properties.get(IN_LEGEND)
    only = next(iter(files.names)) if len(files.names) == 1 else ""
    tag = only or ("" if where else _tag_over(one, files, said))
    note = f"called '{tag}' in {where or 'the file'}" if tag else None
    if any(files.heads):
        said, note = with_head(said, signal, note, files.heads, files.values)
    said = with_scale_asked(with_text(said, next(iter(files.own.values()), signal)), files.own or {"": signal})
    if STATE_OF in signal.properties and said.quantity != "state":
        return _as_state(said, signal.properties[STATE_OF], files.values), note
    if len(files.units) > 1 and said.quantity:
        return _with_units_asked(said, files.units), note
    if said.quantity == "label" and files.two_words:
        return _with_switch_asked(said, files.two_words), note
    return _with_questions(one, said, files), note


def _tag_over(one: OneSignal, files: _InFiles, said: Guess) -> str:
    """What stands over the name of a signal alone in all its files, as the tag over a logger's address, where the guess
    rests on it, or asks for a place; '' where it says nothing, and where the name holds it."""
    over = {own.properties.get("group", "") for own in files.own.values()}
    tag = over.pop() if len(over) == 1 else ""
    own = next(iter(files.own.values()), None)
    shared = sum(s.properties.get("group") == tag for s in one.files[0].signals) > 1 if one.files else True
    if not tag or own is None or tag in own.name or shared:
        return ""
    bare = guess(own.name, files.usual, own.dtype, files.values)
    by_it = (bare.quantity, bare.at, bare.axis) != (said.quantity, said.at, said.axis)
    return tag if by_it or any(q.startswith("at:") for q in said.questions) else ""


def _by_name_and_values(signal: Signal, files: _InFiles) -> Guess:
    """By its name, unit, values and legend."""
    name, told, where = called(signal), told_of(signal), signal.properties.get(IN_LEGEND)
    # a scaling that stands in the file is applied at ingest: the numbers seen here are not yet in the unit
    said = guess(name, files.usual, signal.dtype, None if signal.scaling else files.values, told)
    if (scaled := as_scaled(files.values, files.own.values())) is not None:
        # what values ask that are counts, the scale answers
        said = min(said, guess(name, files.usual, signal.dtype, scaled, told), key=lambda g: len(g.questions))
    said = with_speed_asked(with_standard_unit(replace(said, sure=False) if where else said, signal), signal, name)
    if TOLD_TOO in signal.properties and said.quantity:
        asked = f"which is it? {where} says '{signal.properties['description']}' and '{signal.properties[TOLD_TOO]}'"
        said = replace(said, questions=(*said.questions, asked))
    return said


def _as_state(said: Guess, of: str, values: Values | None) -> Guess:
    """A column that tells the state of another one, by codes."""
    asked = (
        f"the state of '{of}'? ({range_text(values)}) which codes are bad is not known "
        "here: all rows count; leave those out by the test's measuring, or by a window"
    )
    known = values is not None and values.low >= 0 and values.high <= 1  # on and off
    as_state = replace(said, quantity="state", unit=None, instead_of=None, why_not=None, sure=False, basis=("name",))
    return replace(as_state, questions=() if known else (asked,))


def _with_switch_asked(said: Guess, two: tuple[str, ...]) -> Guess:
    """With the question whether a text of two words is a switch."""
    asked = (
        f"a switch? its words are '{two[0][:20]}' and '{two[1][:20]}', and which is on is not known here: write 1 and "
        f"0 into the files, or words that are ({SHOWN}); a label keeps its words and drives nothing"
    )
    return replace(said, sure=False, questions=(*said.questions, asked))


def _with_units_asked(said: Guess, units: Counter[str | None]) -> Guess:
    """With the question for the unit where files say several, or some none. units: how often each is said."""
    names = ", ".join(f"{u or 'none'} ({n})" for u, n in units.most_common())
    known = [u for u in units if u]
    if len(known) == 1:
        asked = f"unit: {known[0]} in all files? they say {names}"
        return replace(said, sure=False, questions=(*said.questions, asked))
    asked = f"unit: the files disagree: {names}; each file's own is taken"
    return replace(said, unit=None, instead_of=None, sure=False, questions=(*said.questions, asked))


def _with_questions(one: OneSignal, said: Guess, files: _InFiles) -> Guess:
    """With what is asked of its unit, and of files that call it by other names."""
    coldest = {str(f.path): coldest_in(f) for f in one.files} if said.quantity == "temperature" else None
    unit = unit_question(said.quantity, files.by_path, coldest) if None in files.units else in_fahrenheit(said, one)
    questions = [unit] if unit else []
    if len(files.names) > 1 and said.quantity:
        names = ", ".join(f"'{w}' ({n})" if w else f"nothing ({n})" for w, n in files.names.most_common())
        questions.append(f"the same in all tests? the files call it {names}")
    return replace(said, sure=False, questions=(*said.questions, *questions)) if questions else said
