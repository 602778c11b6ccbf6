"""A long table in Parquet: each row names what it measures. It is refused as one of text is: read as it stands, degrees
and revolutions would be in one channel whose times go back."""

from __future__ import annotations

from itertools import islice

import pyarrow as pa
import pyarrow.compute as pc

from thermodata.reader.text.long_rows import name_column, refuse_long
from thermodata_reader_table.parquet.table import Table

_HEAD = 1000
_HINT = "pivot it: a column a name, e.g. table.pivot(index=time, columns=name, values=value) in pandas"


def refuse(table: Table) -> None:
    """FormatError for a long table: by its header and its column of names, else by its first rows."""
    words = [i for i in range(len(table.names)) if i != table.time and table.dtype(i) == "str"]
    if not words or table.time is None:
        return
    named = name_column(table.names)
    if named in words:
        blank = [""] * len(table.names)
        rows = [[*blank[:named], word, *blank[named + 1 :]] for word in _words(table, named)]
        refuse_long(table.names, rows, table.path.name, hint=_HINT)
    head = next(islice(table.batches(_HEAD), 1), None)
    if head is not None:
        columns = [[str(v) for v in c.to_pylist()] for c in head.columns]
        rows = [list(row) for row in zip(*columns, strict=True)]
        refuse_long(table.names, rows, table.path.name, (table.time,), _HINT)


def _words(table: Table, column: int) -> list[str]:
    """Some of what a column of words holds, each once: read on until there are two, since the names of a table that was
    melted stand one after the other."""
    top = table.places[column].split(".")[0]
    found: dict[str, None] = {}
    for batch in table.batches(1_000_000, [top]):
        part = batch.column(str(column)).cast(pa.string())
        found |= dict.fromkeys(str(v) for v in pc.unique(part).to_pylist() if v is not None)
        if len(found) > 1:
            break
    return list(found)
