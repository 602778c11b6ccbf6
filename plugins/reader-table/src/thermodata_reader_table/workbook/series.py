"""Sheets whose rows are of several sensors or hosts: each is a stream."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from thermodata.plugin import Block, Loss
from thermodata.reader.signals.series import SERIES, Called, Declaration, find_series
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.workbook.sheet import Stream
from thermodata_reader_table.workbook.units import in_one_unit


def taken_apart(
    stream: Stream, where: str, sheet: str | None, declared: Declaration
) -> tuple[list[Stream], list[str], list[Loss]]:
    """(a stream a series, or the stream as it is; notes; losses). sheet: by which its signals are called; None where
    they are called by themselves."""
    t_ns = stream.times.t_ns
    good = t_ns != NAT
    first = Block(stream.name, t_ns[good], {k: v[good] for k, v in stream.values.items()})
    named = partial(_signal_of_series, "" if sheet is None else f"{sheet}/")
    found = find_series(
        first,
        absolute=stream.times.absolute,
        declared=declared if sheet is None else declared.within(stream.values, f"{sheet}/"),
        called=Called(str if sheet is None else partial(_signal_of_series, "", stream.name), named),
    )
    series = found.series
    if series is None:
        stream, said, lost = in_one_unit(stream, where)
        return [stream], [*found.notes, *said], lost
    parts: list[Stream] = []
    losses: list[Loss] = []
    whole = Block(stream.name, t_ns, stream.values)
    for one, rows in series.rows(whole).items():
        if one not in series.held:
            losses.append(
                Loss(
                    where,
                    reason=f"{counted(rows.size, 'row', 'that names', 'that name')} no series by "
                    f"{' and '.join(series.tags)}",
                )
            )
            continue
        read, rows, foreign = series.in_its_unit(one, whole, rows)
        losses += [Loss(where, reason=series.not_in_its_unit(one, word, count)) for word, count in foreign.items()]
        called = {k: named(one, k) for k in stream.values if k in series.held[one]}
        parts.append(
            Stream(
                series.streams[one],
                replace(stream.times, t_ns=t_ns[rows]),
                {new: read.values[k][rows] for k, new in called.items()},
                {
                    new: stream.units[k] or (None if stream.values[k].dtype == object else series.unit(one))
                    for k, new in called.items()
                },
                stream.at[rows],
                {new: stream.flags[k][rows] for k, new in called.items() if k in stream.flags},
                {new: stream.empty[k][rows] for k, new in called.items() if k in stream.empty},
                stream.sheet,
                frozenset(new for k, new in called.items() if k in stream.percent),
                {new: {**stream.said[k], SERIES: one, **series.unit_of(one, k)} for k, new in called.items()},
            )
        )
    return parts, list(found.notes), losses


def _signal_of_series(before: str, series: str, name: str) -> str:
    """'T' of the series 'bed' is 'bed/T', and 'Sheet1/T' is 'Sheet1/bed/T'."""
    return f"{before}{series}/{name.removeprefix(before)}"
