"""What a signal is: its quantity, unit, place and axis, by name, unit and values, and how sure that is.

The unit decides where the name does not, the name where there is no unit, the values where there is neither; what they
disagree on, and what none of them says, becomes a question. A quantity is never made up.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import lru_cache

from thermodata.draft.signals import bracket_at_end, units
from thermodata.draft.signals.doubted_units import MOST_OF_ONE, SHARED, doubted, hottest_c, implausible, is_fired
from thermodata.draft.signals.name_factor import with_factor_asked
from thermodata.draft.signals.placed import placed
from thermodata.draft.signals.quantity import NO_READING, Guess, quantity_of, range_text
from thermodata.draft.signals.unit_at_end import beside, inch_asked, strange
from thermodata.draft.signals.values import Values
from thermodata.draft.words.amplifier import without_amplifier
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import parts_of, words
from thermodata.draft.words.vocabulary import foreign_in, quantities_in
from thermodata.plugin import Signal
from thermodata.reader.signals.header_words import VALUE_WORDS
from thermodata.reader.text import split_unit
from thermodata.reader.text.names.header import looks_like_unit
from thermodata.schema.units.letters import encoding_hint
from thermodata.schema.units.quantity import is_unit, normal_unit

# 'CH1', 'U1-1', 'Kanal 3', '101': where a wire goes into a logger
_ADDRESS = re.compile(r"[^\W\d]{0,8}[ _-]?\d+(?:[-_.:]\d+)*(?:#\d+)?")
_OF_ROWS = re.compile(r"__index_level_\d+__|Unnamed: 0")  # what pandas calls its numbers of rows
_OF_ITSELF = re.compile(r"\$RT_[A-Z]+\$")  # what WinCC puts between the rows of its tags: $RT_OFF$, $RT_DIS$
SENSOR = "sensor"  # the property of a signal whose file is that of one sensor, by which it is called
NUMBERED = re.compile(r"column \d+(?:#\d+)?")
_IMPLIED = {
    "temperature": "degC",
    "rotational_speed": "rpm",
    "position": "mm",
    "load": "%",
    "humidity": "%",
    "current": "A",
    "torque": "N m",
    "voltage": "V",
}
_COLDEST_K = 250.0  # of a machine and its hall; 235 is 23.5 degC in tenths
_STATUS = re.compile(
    r"(?i)(data ?|sensor ?|mess)?(status|quality|qualität|zustand|stav|état|estado|stato|validity|gültig)"
)
_ASK_STATUS = (
    "the status of the readings? its words are kept, and rows that it calls bad count like all others: leave those "
    "out of the tests by window, or by measuring with a channel of numbers"
)
_SMALL_MM = 5.0  # an axis travels further than a tool is displaced
_RATES = ("feed", "flow", "rotational_speed")
_PLAUSIBLE = {
    "temperature": (-40.0, 200.0),
    "rotational_speed": (-60_000.0, 60_000.0),
    "position": (-30_000.0, 30_000.0),
    "load": (-400.0, 400.0),
    "humidity": (0.0, 100.0),
    "current": (-1000.0, 1000.0),
    "torque": (-5000.0, 5000.0),
    "voltage": (-1000.0, 1000.0),
}


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
    return guess(called(signal), signal.unit, signal.dtype, values, told_of(signal))


@lru_cache(maxsize=50_000)
def guess(
    name: str, unit: str | None, dtype: str = "float64", values: Values | None = None, described: str = ""
) -> Guess:
    """Quantity, unit, place and axis of a signal. unit: as the file writes it; values: of a sample, if there is one;
    described: what the file says of it, which counts more than its own name, and stands in `name` too."""
    if _OF_ITSELF.fullmatch(name):
        return Guess(None, unit, why_not=f"{NO_READING}: WinCC's mark of where its own logging stopped or lost rows")
    if _OF_ROWS.fullmatch(name):
        return Guess(None, unit, why_not="the numbers that pandas gives to rows: none of the quantities")
    if NUMBERED.fullmatch(parts_of(name)[-1]):
        name = ""  # the reader's own name for a column that has none says nothing: 'column 7' is no machine's column
    bare, rate = units.rate_at_end(split_unit(name)[0])  # the 'min' of 'n [1/min]' is no limit
    bare = "/".join(without_amplifier(part) for part in parts_of(bare))
    own, text, told = words(_last(bare)), words(bare), words(described)
    ends = dict.fromkeys(
        (_last(bare), _field(bare), _last(units.without_value(bare)), units.without_labels(_last(bare)))
    )
    written = (
        (
            _in_brackets(name)
            or rate
            or next(filter(None, map(units.from_name, ends)), None)
            or units.inches(_last(name))
        )
        if not unit
        else None
    )
    field = words(_field(bare))
    # the field of a message says what it is, its topic only where it comes from: '/thermo.speed'
    what = field if quantities_in(field) else own
    if field == "temps" and _field(bare) != bare and not unit:
        what = own = "temperature"  # the time of a message is no field of it called in French
    if not unit and not written:
        by_name = quantity_of(what, text, None, dtype, values)
        quantity = by_name.quantity if "name" in by_name.basis else None
        written = next(filter(None, (beside(end, quantity, values) for end in ends)), None)
        written = written or bracket_at_end.of_quantity(_last(name), quantity)
    known = unit or written
    counts = units.counts_or_range(_last(name)) if not known else None
    if counts or (known and not is_unit(known)):
        found = quantity_of(what, text, None, dtype, values)
        if _digital(dtype, values):
            return placed(found, own, text, told)
        asked = f"{encoding_hint(known or '')}the file says '{known}', which is no unit known here"
        if counts:
            asked = f"the file says '{counts}': is each count one of these, or is that a range? ({range_text(values)})"
        if found.quantity is None or found.basis == ("values",):  # of which nobody knows what they count
            why = found.why_not if found.quantity is None and foreign_in(what) else f"quantity and unit? {asked}"
            return Guess(None, why_not=why)
        return replace(placed(replace(found, unit=None), own, text, told), sure=False, questions=(f"unit: {asked}",))
    found = quantity_of(what, text, known, dtype, values)
    if dtype == "str" and found.quantity in ("label", "state") and _STATUS.fullmatch(_last(bare).strip()):
        return replace(found, quantity="label", basis=("text",), sure=False, questions=(_ASK_STATUS,))
    if found.quantity is None or found.quantity == "label":
        return found
    if found.quantity in _RATES:
        own = words(units.without_rate(_last(bare), known))
    found = _small(placed(_unit(found, text, unit, written, values), own, text, told), own, values)
    inch = next(filter(None, (inch_asked(e, found.quantity, values) for e in (_last(name), *ends))), None)
    if inch and found.unit == written == "in":
        found = replace(found, sure=False, questions=(*found.questions, inch))
    if not known and (end := next(filter(None, (strange(e, found.quantity) for e in ends)), None)):
        asked = f"unit: the name ends with '{end}': {found.unit or 'what'}, or another quantity? ({range_text(values)})"
        found = replace(found, sure=False, questions=(*found.questions, asked))
    if not known and (said := bracket_at_end.unknown(_last(name), found.quantity)):
        asked = f"unit: the name says '{said}', which is no unit of this known here ({range_text(values)})"
        found = replace(found, unit=None, sure=False, instead_of=None, questions=(*found.questions, asked))
    found = with_factor_asked(found, _last(name))
    if values is None:
        return found
    return implausible(found, text, values) if known else doubted(found, bare, values)


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


def _unit(found: Guess, text: str, unit: str | None, written: str | None, values: Values | None) -> Guess:
    """The unit as it would be written; a question where nothing says it."""
    quantity = found.quantity or ""
    if quantity in ("state", "label"):
        return replace(found, unit=None)
    if unit is not None and normal_unit(unit) != "dimensionless":
        return _in_range(replace(found, unit=unit), text, values)
    if written is not None:
        basis = ("name",) if found.basis == ("name", "unit") else found.basis
        return _in_range(replace(found, unit=written, basis=basis), text, values)
    if unit is not None and quantity in SHARED:
        return _share(found, unit, values)
    if quantity in SHARED and values is not None and _may_be_of_one(values):
        asked = f'unit: "%", or is 1 100 %? then unit: pu ({range_text(values)})'
        return replace(found, unit=None, sure=False, questions=(*found.questions, asked))
    implied = _IMPLIED.get(quantity)
    if implied and values is not None and _plausible(quantity, values):
        basis = found.basis if "values" in found.basis else (*found.basis, "values")
        # the file says '-' or '1', which an ingest would hold against the unit
        return replace(found, unit=implied, sure=False, basis=basis, instead_of=unit)
    in_kelvins = quantity == "temperature" and values is not None and values.low > _COLDEST_K and values.high < 450
    if in_kelvins and values is not None and not is_fired(text):
        if values.whole:
            asked = f"unit: K, or tenths of a degree (0.1 degC)? ({range_text(values)})"
            return replace(found, unit=None, sure=False, questions=(*found.questions, asked))
        return replace(found, unit="K", sure=False, basis=(*found.basis, "values"), instead_of=unit)
    if implied and values is None and quantity in ("temperature", "rotational_speed"):
        asked = f"unit: {implied}?"
        return replace(found, unit=implied, sure=False, questions=(*found.questions, asked), instead_of=unit)
    hint = {
        "displacement": "um, mm, m or V?",
        "feed": "m/min or mm/min?",
        "power": "kW, W or hp?",
        "pressure": "bar or MPa?",
        "flow": "l/min?",
        "irradiance": "W/m2?",
    }.get(quantity, "")
    asked = f"unit: {hint} ({range_text(values)})" if hint else f"unit? ({range_text(values)})"
    return replace(found, unit=None, sure=False, questions=(*found.questions, asked))


def _share(found: Guess, unit: str, values: Values | None) -> Guess:
    """A load or a humidity whose file says '-' or '1': of 1, where it stays below, or else of 100."""
    if values is not None and values.high > MOST_OF_ONE:
        basis = (*found.basis, "values")
        return replace(found, unit="%", instead_of=unit, sure=False, basis=basis)
    asked = f'unit: the file says \'{unit}\', so 1 is read as 100 %; if 1 is 1 %: unit: "%", instead_of: "{unit}"'
    return replace(found, unit=unit, sure=False, questions=(*found.questions, f"{asked} ({range_text(values)})"))


def _may_be_of_one(values: Values) -> bool:
    """Whether a share without a unit stays so low that it may count from 0 to 1; whole numbers are per cent."""
    return not values.constant and not values.whole and max(-values.low, values.high) <= MOST_OF_ONE


def _plausible(quantity: str, values: Values) -> bool:
    low, high = _PLAUSIBLE[quantity]
    return values.low >= low and values.high <= high and not (quantity == "temperature" and values.switch)


def _in_range(found: Guess, text: str, values: Values | None) -> Guess:
    """A question where the values cannot be that: a temperature of 4000 degC is counts of a converter, or a broken
    sensor."""
    if values is None or found.quantity != "temperature" or normal_unit(found.unit or "") != "degC":
        return found
    if values.median > hottest_c(text) or values.median < -100:
        return replace(found, sure=False, questions=(*found.questions, f"values {values.span()}: raw counts, or K?"))
    return found
