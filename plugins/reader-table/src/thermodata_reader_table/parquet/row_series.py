"""A long table in Parquet: each row names the sensor or host that it is of. Read as it stands, degrees and revolutions
would be in one channel whose times go back; so each name is a stream."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D
from thermodata.reader.signals.series import Declaration, FoundSeries, find_series
from thermodata.reader.text.tables.long_rows import name_column
from thermodata.reader.times.zone import NAT
from thermodata_reader_table.parquet.columns import values_of
from thermodata_reader_table.parquet.table import Table

STREAM = "table"
_HEAD = 2000  # rows that are looked at,
_PIECE, _PIECES, _FURTHEST = 100, 100, 2_000_000  # and more of them at places up to this row
_HINT = (
    "pivot it: a column a name, e.g. table.pivot(index=time, columns=name, values=value) in pandas; "
    f"{Declaration().declined()}"
)


def series_of(table: Table) -> FoundSeries:
    """How the rows are taken apart, as declared or as the rows at many places of the file say. FormatError for a long
    table that cannot be: relative times that begin anew for each name may be of one series or of tests that follow each
    other."""
    declared = Declaration.of((table.source.table or {}).get("series"))
    if table.time is None or declared.columns == ():
        return FoundSeries()
    first = _series(table, declared, [(0, _HEAD)])
    tag = name_column(table.names) if first.series is None else table.names.index(first.series.tags[0])
    if tag is None or tag == table.time or (first.series is None and table.dtype(tag) != "str"):
        return first
    found = _series(table, declared, _places(min(table.file.metadata.num_rows, _FURTHEST)))
    if found.series is None:
        _refuse_several_names(table, tag)
    return found


def _refuse_several_names(table: Table, tag: int) -> None:
    """FormatError where a column holds several names."""
    words = _words(table, tag)
    if len(words) > 1:
        raise FormatError(
            "a long table: each row names what it measures",
            where=table.path.name,
            expected="a column a signal",
            got=f"'{table.names[tag]}' holds {', '.join(words[:4])}",
            hint=_HINT,
        )


def _series(table: Table, declared: Declaration, places: Sequence[tuple[int, int]]) -> FoundSeries:
    """The series of the rows at some places, each (first, past-the-last)."""
    some = [(i, name) for i, name in enumerate(table.names) if i not in (table.time, *table.beside)]
    times = table.stamps(_HEAD) if len(places) == 1 else table.stamps()
    parts: list[dict[str, Array]] = []
    rows: list[Int1D] = []
    pieces: list[Int1D] = []
    at = 0
    for batch in table.batches(_HEAD):
        for number, (first, stop) in enumerate(places):
            a, b = max(first - at, 0), min(stop - at, batch.num_rows, times.t_ns.size - at)
            if a < b:
                parts.append({n: values_of(batch.column(i).slice(a, b - a), table.dtype(i)) for i, n in some})
                rows.append(np.arange(at + a, at + b))
                pieces.append(np.full(b - a, number, np.int64))
        at += batch.num_rows
        if at >= places[-1][1]:
            break
    if not parts:
        return FoundSeries()
    t_ns = times.t_ns[np.concatenate(rows)]
    good = t_ns != NAT
    values = {name: np.concatenate([part[name] for part in parts])[good] for _, name in some}
    block = Block(STREAM, t_ns[good], values)
    return find_series(block, absolute=times.absolute, declared=declared, pieces=np.concatenate(pieces)[good])


def _places(rows: int) -> list[tuple[int, int]]:
    """(first, past-the-last) of the rows of each place that is looked at: the first ones, and evenly spread ones."""
    starts = np.unique(np.linspace(_HEAD, max(_HEAD, rows - _PIECE), _PIECES).astype(int)).tolist()
    found = [(0, min(_HEAD, rows))]
    for start in starts:
        first = max(start, found[-1][1])
        if first < min(start + _PIECE, rows):
            found.append((first, min(start + _PIECE, rows)))
    return found


def _words(table: Table, column: int) -> list[str]:
    """Some of what a column of words holds, each once: read on until there are two, since the names of a table that was
    melted stand one after the other."""
    top = table.places[column][0]
    found: dict[str, None] = {}
    for batch in table.batches(1_000_000, [top]):
        part = batch.column(str(column)).cast(pa.string())
        found |= dict.fromkeys(str(v) for v in pc.unique(part).to_pylist() if v is not None)
        if len(found) > 1:
            break
    return list(found)
