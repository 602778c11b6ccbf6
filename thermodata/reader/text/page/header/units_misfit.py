"""Rows of units that have other cells than the names above them: refused, for nobody can tell which unit is whose."""

from __future__ import annotations

from thermodata.errors import FormatError
from thermodata.reader.text.clocks.names_of_time import filled
from thermodata.reader.text.names.header import looks_like_unit
from thermodata.reader.text.names.header_rows import place_of_names, texts_of
from thermodata.reader.text.names.time_header import is_time_header, says_time
from thermodata.reader.text.names.units_row import mostly_units
from thermodata.reader.text.page.header.head import Head
from thermodata.reader.times.time_units import known_unit


def refuse_units_misfit(head: Head) -> None:
    """FormatError where a row of units has more cells than the table has columns, or fewer than there are names while a
    unit that is none of time stands below the word for the time: the row has lost a cell in front of that one."""
    width = head.width
    place = place_of_names(head.above, width, head.row_of_units)
    if place is None:
        return
    names = texts_of(head.above[place])[:width]
    times = [i for i, name in enumerate(names) if says_time(name) or is_time_header(name)]
    for at, row in enumerate(head.above):
        units = texts_of(row)
        if at != head.row_of_units and (at <= place or not mostly_units(units)):
            continue
        more = filled(units) > width >= filled(names)
        astray = next((u for i in times if i < len(units) and _is_of_no_time(u := units[i])), None)
        fewer = sum(map(bool, units)) < sum(map(bool, names)) and astray is not None
        if not more and not fewer:
            continue
        few = f", and '{astray}' below '{names[times[0]]}' is no unit of time" if fewer else ""
        raise FormatError(
            f"the row of units has {'more' if more else 'fewer'} cells than the row of names: which unit is whose?",
            where=f"{head.where} line {head.line(at)}, names in line {head.line(place)}",
            expected=f"a cell between {head.between} for each name, an empty one where there is no unit",
            got=f"{filled(units)} cells below {filled(names)} names{few}: '{' '.join(units)[:60]}' below "
            f"'{' '.join(names)[:60]}'",
            hint="put the missing cell into the row of units, or take the odd one out; or declare "
            f"{head.named_anew}, and units in the channels",
        )


def _is_of_no_time(cell: str) -> bool:
    unit = cell.strip("[]() ")
    return looks_like_unit(unit) and known_unit(unit) is None
