"""What a signal is: its quantity, unit, place and axis, by name, unit and values, and how sure that is.

The unit decides where the name does not, the name where there is no unit, the values where there is neither; what they
disagree on, and what none of them says, becomes a question. A quantity is never made up.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import lru_cache

from thermodata.draft.signals import units
from thermodata.draft.signals.implied_speed import with_speed_asked
from thermodata.draft.signals.placed import placed
from thermodata.draft.signals.quantity.guessed import NO_READING, NOTHING, OF_NONE, Guess, range_text
from thermodata.draft.signals.quantity.quantity_of import quantity_of
from thermodata.draft.signals.told_before import as_told
from thermodata.draft.signals.told_units import bracket_at_end
from thermodata.draft.signals.told_units.doubted_units import doubted, implausible
from thermodata.draft.signals.told_units.implied_unit import with_unit
from thermodata.draft.signals.told_units.letter_of_unit import placed_but_for_unit
from thermodata.draft.signals.told_units.name_factor import with_factor_asked
from thermodata.draft.signals.told_units.standard_units import with_standard_unit
from thermodata.draft.signals.told_units.unit_at_end import inch_asked, strange, unit_of_quantity
from thermodata.draft.signals.values import Values
from thermodata.draft.words.amplifier import without_amplifier
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import parts_of, words
from thermodata.draft.words.vocabulary import foreign_in, quantities_in
from thermodata.plugin import Signal
from thermodata.reader.signals.header_words import VALUE_WORDS
from thermodata.reader.text import split_unit
from thermodata.reader.text.names.header import looks_like_unit
from thermodata.reader.text.names.unit_in_name import unit_at_end
from thermodata.schema.units.letters import encoding_hint, mended
from thermodata.schema.units.quantity import STATES
from thermodata.schema.units.unit import is_unit

# 'CH1', 'U1-1', 'Kanal 3', '101': where a wire goes into a logger
_ADDRESS = re.compile(r"[^\W\d]{0,8}[ _-]?\d+(?:[-_.:]\d+)*(?:#\d+)?")
_OF_ROWS = re.compile(r"__index_level_\d+__|Unnamed: 0")  # what pandas calls its numbers of rows
_OF_ITSELF = re.compile(r"\$RT_[A-Z]+\$")  # what WinCC puts between the rows of its tags: $RT_OFF$, $RT_DIS$
SENSOR = "sensor"  # the property of a signal whose file is that of one sensor, by which it is called
NUMBERED = re.compile(r"column \d+(?:#\d+)?")
_STATUS = re.compile(
    r"(?i)(data ?|sensor ?|mess)?(status|quality|qualität|zustand|stav|état|estado|stato|validity|gültig)"
)
_ASK_STATUS = (
    "the status of the readings? its words are kept, and rows that it calls bad count like all others: leave those "
    "out of the tests by window, or by measuring with a channel of numbers"
)
_SMALL_MM = 5.0  # an axis travels further than a tool is displaced
_RATES = ("feed", "flow", "rotational_speed")


def says_nothing(name: str) -> bool:
    """Whether a signal is called 'value', or as its column is."""
    bare = split_unit(name)[0].strip()
    return bare.casefold() in VALUE_WORDS or NUMBERED.fullmatch(bare) is not None


def called(signal: Signal) -> str:
    """A signal's name with the head of the group that it stands under, "Displacements/X", and what the file says of it:
    behind the address of a channel, which says nothing, "CH1/Spindle front", but before a name. Where files of
    several sensors have the same signals, their own names tell what these are."""
    group, name = signal.properties.get("group"), signal.name
    said = re.sub(r"\s*[/\\]\s*", " ", signal.properties.get("description", ""))
    if sensor := signal.properties.get(SENSOR):
        name = sensor if says_nothing(name) else f"{sensor} {name}"
    if said and _ADDRESS.fullmatch(split_unit(name)[0]):
        return "/".join(filter(None, (group, split_unit(name)[0], said)))
    return "/".join(filter(None, (group, said, name)))


def told_of(signal: Signal) -> str:
    """What its file says of a signal beside its name."""
    return signal.properties.get("description", "")


def guess_of(signal: Signal, values: Values | None = None) -> Guess:
    """The same of a signal, as all that its file says of it has it."""
    name = called(signal)
    found = with_standard_unit(guess(name, signal.unit, signal.dtype, values, told_of(signal)), signal)
    return as_told(with_speed_asked(found, signal, name), signal)


@lru_cache(maxsize=50_000)
def guess(
    name: str, unit: str | None, dtype: str = "float64", values: Values | None = None, described: str = ""
) -> Guess:
    """Quantity, unit, place and axis of a signal. unit: as the file writes it; values: of a sample, if there is one;
    described: what the file says of it, which counts more than its own name, and stands in `name` too."""
    if _OF_ITSELF.fullmatch(name):
        return Guess(None, unit, why_not=f"{NO_READING}: WinCC's mark of where its own logging stopped or lost rows")
    if _OF_ROWS.fullmatch(name):
        return Guess(None, unit, why_not=f"the numbers that pandas gives to rows: {OF_NONE}")
    if (right := _mended(name, unit, dtype, values, described)) is not None:
        return right
    said = _Name.of(name)
    own, text, told = words(said.last), words(said.bare), words(described)
    field = words(said.field)
    # the field of a message says what it is, its topic only where it comes from: '/thermo.speed'
    what = field if quantities_in(units.without_volts(field)) else own
    if field == "temps" and said.field != said.bare and not unit:
        what = own = "temperature"  # the time of a message is no field of it called in French

    def of_quantity(known: str | None) -> Guess:
        return quantity_of(what, text, known, dtype, values)

    written = None if unit else said.unit() or _unit_of_quantity(said, of_quantity(None), values, described)
    known = unit or written
    counts = units.counts_or_range(said.whole_last) if not known else None
    if counts or (known and not is_unit(known)):
        found = of_quantity(None)
        if _digital(dtype, values):
            return placed(found, own, text, told)
        asked = f"{encoding_hint(known or '')}the file says '{known}', which is no unit known here"
        if counts:
            asked = f"the file says '{counts}': is each count one of these, or is that a range? ({range_text(values)})"
        if found.quantity is None or found.basis == ("values",):  # of which nobody knows what they count
            why = found.why_not if found.quantity is None and foreign_in(what) else f"quantity and unit? {asked}"
            return Guess(None, why_not=why)
        return replace(placed(replace(found, unit=None), own, text, told), sure=False, questions=(f"unit: {asked}",))
    found = of_quantity(known)
    if dtype == "str" and found.quantity in STATES and _STATUS.fullmatch(said.last.strip()):
        return replace(found, quantity="label", basis=("text",), sure=False, questions=(_ASK_STATUS,))
    if found.quantity is None and (found.why_not or "").startswith(NOTHING) and not known:
        return _with_unit_named(found, said.whole_last)
    if found.quantity is None or found.quantity == "label":
        return found
    if found.quantity in _RATES:
        own = words(units.without_rate(said.last, known))
    found = with_unit(found, text, unit, written, values)
    found = _small(placed_but_for_unit(found, own, text, told, said.bare, known is not None), own, values)
    found = _asked_by_name(found, said, unit, written, values)
    if values is None:
        return found
    return implausible(found, text, values) if known else doubted(found, said.bare, values)


def _mended(name: str, unit: str | None, dtype: str, values: Values | None, described: str) -> Guess | None:
    """The guess of a signal whose unit was saved in a wrong encoding, asked: 'Âµm'. None of another."""
    written = unit or split_unit(name)[1]
    right = mended(written) if written and not is_unit(written) else None
    if right is None or not is_unit(right):
        return None
    found = guess(mended(name) or name, unit and right, dtype, values, described)
    asked = f"unit: {right}? the file says '{written}', which is '{right}' in UTF-8 that was read as a text of Windows"
    if found.quantity is None:
        return found
    return replace(found, unit=right, sure=False, questions=(*found.questions, asked))


@dataclass(frozen=True, slots=True)
class _Name:
    """A signal's name taken apart. whole: as it was given, '' for the reader's own name of a column without one; bare:
    without its unit and its amplifier; rate: a unit with a stroke at its end; ends: what a unit may stand at the end
    of."""

    whole: str
    bare: str
    rate: str | None
    ends: tuple[str, ...]

    @classmethod
    def of(cls, name: str) -> _Name:
        if NUMBERED.fullmatch(parts_of(name)[-1]):
            # what a reader calls a column that has no name says nothing: 'column 7' is no machine's column
            name = ""
        bare, rate = units.rate_at_end(split_unit(name)[0])  # the 'min' of 'n [1/min]' is no limit
        bare = "/".join(without_amplifier(part) for part in parts_of(bare))
        last = _last(bare)
        ends = (last, _field(bare), _last(units.without_value(bare)), units.without_labels(last))
        return cls(name, bare, rate, tuple(dict.fromkeys(ends)))

    @property
    def last(self) -> str:
        return _last(self.bare)

    @property
    def field(self) -> str:
        return _field(self.bare)

    @property
    def whole_last(self) -> str:
        """The last part with its unit."""
        return _last(self.whole)

    def unit(self) -> str | None:
        """The unit that stands in it, whatever the quantity is."""
        at_end = next(
            filter(None, (find(end) for end in self.ends for find in (unit_at_end, units.volts_at_end))), None
        )
        return _in_brackets(self.whole) or self.rate or at_end or units.inches(self.whole_last)


def _unit_of_quantity(name: _Name, found: Guess, values: Values | None, described: str) -> str | None:
    """The unit that a name, or else what the file says of it, has where its quantity tells that it is one. found: by
    the name without a unit."""
    quantity = found.quantity if "name" in found.basis else None
    at_end = next(filter(None, (unit_of_quantity(end, quantity, values) for end in name.ends)), None)
    in_name = at_end or bracket_at_end.of_quantity(name.whole_last, quantity)
    return in_name or units.described(described, quantity)


def _asked_by_name(found: Guess, name: _Name, unit: str | None, written: str | None, values: Values | None) -> Guess:
    """With the questions that the end of a name leaves open: an inch, a unit of something else, one that is not known,
    a factor."""
    ends = (name.whole_last, *name.ends)
    inch = next(filter(None, (inch_asked(e, found.quantity, values) for e in ends)), None)
    if inch and found.unit == written == "in":
        found = replace(found, sure=False, questions=(*found.questions, inch))
    if not (unit or written):
        if end := next(filter(None, (strange(e, found.quantity) for e in name.ends)), None):
            guessed = f"{found.unit or 'what'}, or another quantity? ({range_text(values)})"
            asked = f"unit: the name ends with '{end}': {guessed}"
            found = replace(found, sure=False, questions=(*found.questions, asked))
        if said := bracket_at_end.unknown(name.whole_last, found.quantity):
            asked = f"unit: the name says '{said}', which is no unit of this known here ({range_text(values)})"
            if bracket_at_end.scaled(said, found.quantity):
                asked = f'unit: "{said}"? the name says it, of each count, or as a range ({range_text(values)})'
                found = replace(found, questions=tuple(q for q in found.questions if not q.startswith("unit:")))
            found = replace(found, unit=None, sure=False, instead_of=None, questions=(*found.questions, asked))
    return with_factor_asked(found, name.whole_last)


def _with_unit_named(found: Guess, name: str) -> Guess:
    """What is asked of a signal that nothing tells of, with what may be the unit in its name: the inch of 'X (in)'."""
    unit = bracket_at_end.any_unit(name)
    if unit is None or found.why_not is None:
        return found
    return replace(found, why_not=found.why_not.replace(NOTHING, f"{NOTHING} the name says '{unit}'", 1))


def _in_brackets(name: str) -> str | None:
    """The unit in the brackets of a name whose reader leaves it there: 'Log/n [1/s]'. What one count is, or how far the
    values may go, is none."""
    unit = split_unit(name)[1]
    known = unit is not None and (looks_like_unit(unit) or is_unit(unit))
    return unit if known and units.counts_or_range(_last(name)) is None else None


def _small(found: Guess, own: str, values: Values | None) -> Guess:
    """With a question where only the unit says that a length is a position, and it moves no further than a tool that
    is displaced: 'X [mm]'."""
    still = values is not None and values.n > 0 and values.high - values.low < _SMALL_MM
    axis = axis_of(own)
    if found.quantity != "position" or found.basis != ("unit",) or not still or axis is None:
        return found
    asked = f"a position, or a displacement? then quantity: displacement, axis: {axis.upper()}, at: tcp"
    return replace(found, sure=False, questions=(*found.questions, asked))


def _last(name: str) -> str:
    """The last part of a path of names: 'Temp/T06' -> 'T06', '/hall/air.top' -> 'air.top'."""
    return parts_of(name)[-1]


def _field(name: str) -> str:
    """The last field of a message, without its index: '/thermo.probes_um[0]' -> 'probes_um'."""
    return re.sub(r"\[\d+\]$", "", _last(name)).rsplit(".", 1)[-1]


def _digital(dtype: str, values: Values | None) -> bool:
    return dtype in ("bool", "str") or (values is not None and values.switch)
