"""A long table in Parquet: each row names what it measures. It is refused as one of text is: read as it stands, degrees
and revolutions would be in one channel whose times go back."""

from __future__ import annotations

from itertools import islice

import pyarrow as pa
import pyarrow.compute as pc

from thermodata.errors import FormatError
from thermodata.plugin import Block
from thermodata.reader.series import Declaration, Found, find_series
from thermodata.reader.text.long_rows import name_column, refuse_long
from thermodata.reader.zone import NAT
from thermodata_reader_table.parquet.columns import values_of
from thermodata_reader_table.parquet.table import Table

_HEAD = 1000
_HINT = (
    "pivot it: a column a name, e.g. table.pivot(index=time, columns=name, values=value) in pandas; "
    f"{Declaration().declined()}"
)


def refuse(table: Table) -> tuple[str, ...]:
    """Notes on columns that may name series. FormatError for a long table: as declared, by its header and its column of
    names, or by its first rows."""
    declared = Declaration.of((table.source.table or {}).get("series"))
    words = [i for i in range(len(table.names)) if i != table.time and table.dtype(i) == "str"]
    if table.time is None or declared.columns == ():
        return ()
    named = name_column(table.names)
    if named in words:
        blank = [""] * len(table.names)
        rows = [[*blank[:named], word, *blank[named + 1 :]] for word in _words(table, named)]
        refuse_long(table.names, rows, table.path.name, hint=_HINT)
    found = _series(table, declared)
    if found.series is None:
        return found.notes
    raise FormatError(
        "a long table: each row names what it measures",
        where=table.path.name,
        expected="a column a signal",
        got=" and ".join(f"'{tag}'" for tag in found.series.tags) + " holds " + ", ".join(list(found.series.held)[:4]),
        hint=_HINT,
    )


def _series(table: Table, declared: Declaration) -> Found:
    """The series in the first rows."""
    head = next(islice(table.batches(_HEAD), 1), None)
    if head is None:
        return Found()
    times = table.stamps(_HEAD)
    n = min(times.t_ns.size, head.num_rows)  # a batch may end with a row group, of all columns sooner than of one
    t_ns = times.t_ns[:n]
    good = t_ns != NAT
    kept = [(i, name) for i, name in enumerate(table.names) if i != table.time]
    values = {name: values_of(head.column(i), table.dtype(i))[:n][good] for i, name in kept}
    # nothing is taken apart here: relative times that begin anew with each name are refused as dates are
    return find_series(Block("", t_ns[good], values), absolute=True, declared=declared)


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
