"""Finds the layout of a long table by its header and the rows below it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from thermodata.reader.signals.unit_words import holds_units
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.cells.values.status import are_faults, zero_is_good
from thermodata.reader.text.times.one_cell import timestamp
from thermodata_reader_cnc.opcua.long_header import Header, find_header, qualities, time_cell
from thermodata_reader_cnc.opcua.long_layout import Layout, clean_line
from thermodata_reader_cnc.opcua.long_series import Series, series_of, series_of_influx
from thermodata_reader_cnc.opcua.long_times import time_form

_TYPE = "datatype"
_ROWS = 2000  # below the header, by which the times are known


def find_layout(
    lines: Sequence[str], where: str, declared: str | None = None, later: Sequence[str] = ()
) -> Layout | None:
    """The layout by a header row among the first ten lines, or None. declared: the format of the times; later: further
    lines, by which columns that differ are known. FormatError: no order of day and month."""
    for row in range(len(lines[:10])):
        for delimiter in (",", ";", "\t", "|"):
            found = _headed_by(row, delimiter, lines, where, declared, later)
            if found is not None:
                return found
    return None


def _headed_by(
    row: int, delimiter: str, lines: Sequence[str], where: str, declared: str | None, later: Sequence[str]
) -> Layout | None:
    """The layout where this row is its header; None where it is none."""
    below = lines[row + 1 : row + _ROWS]
    header = find_header([clean(c) for c in fields(lines[row], delimiter)], [fields(text, delimiter) for text in below])
    if header is None:
        return None
    body = header.whole(fields(text, delimiter) for text in below if not text.startswith("#"))
    form = time_form([text for cells in body if (text := time_cell(cells, header.times))], where, declared)
    if form is None:
        return None
    zero: bool | None = True
    if (status := header.status) is not None:
        codes = (cells[status] for cells in (*body, *header.whole(fields(text, delimiter) for text in later)))
        zero = zero_is_good(codes, header.names[status])
    taken = {
        *header.times,
        header.value,
        *header.typed,
        status,
        header.tag,
        *(k for pair in header.pairs for k in pair),
    }
    units = [
        k for k, c in enumerate(header.raw) if k not in taken and holds_units(c, (clean(cells[k]) for cells in body))
    ]
    statuses = list(qualities(header.names, body))
    every = (fields(text, delimiter) for text in (*lines[row + 1 :], *later))
    faults = [k for k, n in enumerate(header.names) if k not in taken and are_faults((clean(c[k]) for c in body), n)]
    series = _series(header, every, form, {*units, *statuses, *faults})
    if _is_wide(header, series):
        return None
    found = Layout(
        delimiter=delimiter,
        row=row,
        header=clean_line(lines[row]),
        width=len(header.names),
        times=header.times,
        tags=series.tags,
        known=series.known,
        value=header.value,
        typed=header.typed,
        status=status,
        form=form,
        zero_good=zero,
        unit=next(iter(units), None),
        annotated=header.influx,
        said=header.said,
        unread=tuple(header.raw[k] for k in series.unread),
        faults=tuple(faults),
    )
    return replace(found, more=_further_values(found, header.pairs, units, statuses))


def _is_wide(header: Header, series: Series) -> bool:
    """Whether the columns beside the value are measured as well, and the tag is a mere word on each row, as an
    operator's name is: its rows are of no several series."""
    beside = [header.raw[k] for k in series.measured]
    return not series.parted and bool(beside) and (not header.said.sure or any(split_unit(c)[1] for c in beside))


def _series(header: Header, rows: Iterable[Sequence[str]], form: TimeFormat, others: Collection[int]) -> Series:
    """What names the series of a value. rows: the cells of all sampled lines; others: columns that say something else
    of a value."""
    if header.influx:
        return series_of_influx(header.raw, list(rows))
    if header.tag is None:
        return Series((), {})
    whole = header.whole(rows)
    of_type = [k for k, n in enumerate(header.names) if n == _TYPE]
    used = {
        *header.times,
        header.value,
        *header.typed,
        *(k for pair in header.pairs[1:] for k in pair),
        *others,
        *of_type,
    }
    t_ns = timestamp.parse([time_cell(cells, header.times) for cells in whole], form)
    return series_of(header.names, whole, t_ns, header.tag, used)


def _further_values(
    first: Layout, pairs: Sequence[tuple[int, int]], units: Sequence[int], statuses: Sequence[int]
) -> tuple[Layout, ...]:
    """The further values of a row: each with the unit and the status that stand in its own columns, or the row's."""
    return tuple(
        replace(
            first,
            tags=tuple(tag if k == pairs[0][0] else k for k in first.tags),
            value=value,
            unit=units[n] if len(units) == len(pairs) else first.unit,
            status=statuses[n] if len(statuses) == len(pairs) else first.status,
        )
        for n, (tag, value) in enumerate(pairs)
        if n
    )
