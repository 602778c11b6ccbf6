"""Units that each row of a long table names beside its value, or behind it in one cell ('20.98 °C'): an instrument that
ranges by itself says um, and mm once the value is large. A tag has one unit, the first that its rows name, and values
in others are converted to it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from thermodata.errors import FormatError, UsageError
from thermodata.reader.signals.unit_words import is_surely_unit
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.number import is_empty, of_either_mark, to_float
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.schema.units.conversion import linear_conversion
from thermodata_reader_cnc.opcua.long_layout import Layout

_WITH_UNIT = re.compile(
    r"(?P<number>[+-]?\d[\d.,' \u00a0\u202f]*?(?:[eE][+-]?\d+)?)\s*(?P<unit>[^\d\s.,+-][^\s]{0,11})"
)
_LONGEST = 64  # letters of a number with its unit: the pattern takes the square of them
_NEARLY_ALL = 0.9  # of a tag's values, that name their unit


def units_of(layout: Layout, lines: Sequence[str], where: str) -> tuple[dict[str, str], list[str]]:
    """(the unit of each tag whose rows name one, notes on those that name others too). FormatError where these do not
    convert."""
    units, notes = units_behind(layout, lines)
    others: dict[str, dict[str, None]] = {}
    for tag, unit in _units_of_tags(layout, lines):
        first = units.setdefault(tag, unit)
        if (factor := conversion(unit, first)) is None:
            raise FormatError(
                f"'{tag}' has several units",
                where=where,
                expected="one, or several that convert to each other",
                got=f"{first} and {unit}",
                hint="give the values of each unit a name of their own",
            )
        if factor != (1.0, 0.0):
            others.setdefault(tag, {})[unit] = None
    return units, notes + [
        f"'{tag}' is given in {units[tag]}, also where its rows say {', '.join(some)}" for tag, some in others.items()
    ]


def units_behind(layout: Layout, lines: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """(the unit of each tag nearly all values of which are numbers with a unit behind them, notes on them). Values in
    units that do not convert to it are none."""
    seen: Counter[str] = Counter()
    found: dict[str, list[tuple[str, str]]] = {}
    for each, cells in _rows(layout, lines):
        value = cells[each.value]
        if is_empty(value):
            continue
        tag = _tag(each, cells)
        seen[tag] += 1
        if (parted := number_and_unit(value)) is not None:
            found.setdefault(tag, []).append((parted[1], value))
    units = {
        tag: values[0][0]
        for tag, values in found.items()
        if sum(conversion(unit, values[0][0]) is not None for unit, _ in values) >= _NEARLY_ALL * seen[tag]
    }
    return units, [f"'{tag}' holds numbers with their unit ('{found[tag][0][1]}')" for tag in units]


@lru_cache(maxsize=1 << 16)
def number_and_unit(text: str) -> tuple[float, str] | None:
    """(20.98, '°C') of '20.98 °C'; None of a bare number, and of words. Blanks may part thousands."""
    text = text.strip()
    match = _WITH_UNIT.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None or not is_surely_unit(match["unit"]):
        return None
    number = of_either_mark(match["number"].strip())
    number = to_float(match["number"].strip()) if number is None else number
    return None if number is None else (number, match["unit"])


def _units_of_tags(layout: Layout, lines: Sequence[str]) -> Iterator[tuple[str, str]]:
    """(tag, unit) of each value whose row says one in a cell of its own."""
    if any(each.unit is not None for each in (layout, *layout.more)):
        for each, cells in _rows(layout, lines):
            if each.unit is not None and not is_empty(cells[each.unit]):
                yield _tag(each, cells), cells[each.unit]


def _rows(layout: Layout, lines: Sequence[str]) -> Iterator[tuple[Layout, list[str]]]:
    """The cells of each value that has a tag; those of a row with several come once for each of them."""
    parts = [each for each in (layout, *layout.more) if each.tags]
    for line in lines if parts else ():
        cells = [clean(c) for c in fields(line, layout.delimiter)]
        if len(cells) == layout.width:
            yield from ((each, cells) for each in parts)


def _tag(layout: Layout, cells: Sequence[str]) -> str:
    return layout.named({k: [c] for k, c in enumerate(cells)}, 1)[0]


@lru_cache(maxsize=1024)
def conversion(written: str, unit: str) -> tuple[float, float] | None:
    """(factor, offset) from one unit to another; None where they do not convert."""
    if written == unit:
        return 1.0, 0.0
    try:
        return linear_conversion(written, unit)
    except UsageError:
        return None


def in_unit_of(tag: str, value: str, written: str, units: Mapping[str, str]) -> tuple[str, str | None]:
    """(the value of a row in the unit of its tag, what is wrong with it or None); words stay as they are."""
    if tag in units and (parted := number_and_unit(value)) is not None:
        value, written = f"{parted[0]:.15g}", parted[1]
    number = to_float(value) if written and units.get(tag, written) != written else None
    if number is None or is_empty(written):
        return value, None
    if (found := conversion(written, units[tag])) is None:
        return value, f"in '{written}', which does not convert to {units[tag]}"
    factor, offset = found
    return (value if found == (1.0, 0.0) else f"{number * factor + offset:.12g}"), None
