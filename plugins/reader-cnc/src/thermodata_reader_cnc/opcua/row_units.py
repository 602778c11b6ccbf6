"""Units that each row of a long table names beside its value: an instrument that ranges by itself says um, and mm once
the value is large. A tag has one unit, the first that its rows name, and values in others are converted to it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from thermodata.errors import FormatError, UsageError
from thermodata.reader.text.cells.delimiter import fields
from thermodata.reader.text.cells.number import is_empty, to_float
from thermodata.reader.text.cells.quotes import clean
from thermodata.schema.units.quantity import linear_conversion
from thermodata_reader_cnc.opcua.long_layout import Layout


def units_of(layout: Layout, lines: Sequence[str], where: str) -> tuple[dict[str, str], list[str]]:
    """(the unit of each tag whose rows name one, notes on those that name others too). FormatError where these do not
    convert."""
    units: dict[str, str] = {}
    others: dict[str, dict[str, None]] = {}
    for tag, unit in _said(layout, lines):
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
    return units, [
        f"'{tag}' is given in {units[tag]}, also where its rows say {', '.join(some)}" for tag, some in others.items()
    ]


def _said(layout: Layout, lines: Sequence[str]) -> Iterator[tuple[str, str]]:
    """(tag, unit) of each value whose row says one."""
    parts = [(each, each.unit) for each in (layout, *layout.more) if each.tags]
    for line in lines if any(unit is not None for _, unit in parts) else ():
        cells = [clean(c) for c in fields(line, layout.delimiter)]
        if len(cells) != layout.width:
            continue
        for each, unit in parts:
            if unit is not None and not is_empty(cells[unit]):
                yield each.named({k: [c] for k, c in enumerate(cells)}, 1)[0], cells[unit]


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
    number = to_float(value) if written and units.get(tag, written) != written else None
    if number is None or is_empty(written):
        return value, None
    if (found := conversion(written, units[tag])) is None:
        return value, f"in '{written}', which does not convert to {units[tag]}"
    factor, offset = found
    return (value if found == (1.0, 0.0) else f"{number * factor + offset:.12g}"), None
