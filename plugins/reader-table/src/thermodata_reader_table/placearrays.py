"""Where a row stands in a file of arrays: row group and row, variable and index, channel group and record."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.plugin import Source
from thermodata_reader_table.place import nth_good

_NAMED = 12  # variables that are told one by one
_ROWS = 1_000_000


def parquet_row(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`row group 3, row 812` (of the file: row 100812)."""
    import pyarrow as pa

    from thermodata_reader_table.parquet import Table

    table = Table(path, source)
    top = table.places[table.time].split(".")[0]
    kept = [b.column(str(table.time)) for b in table.batches(_ROWS, [top])]
    column = pa.chunked_array([c for k in kept for c in k.chunks], table.schema.field(table.time).type)
    at = nth_good([table.times(column).t_ns], row)
    if at is None:
        return None
    first = 0
    for number in range(table.file.metadata.num_row_groups):
        rows = table.file.metadata.row_group(number).num_rows
        if at < first + rows:
            return f"row group {number + 1}, row {at - first + 1} of it (row {at + 1} of the file)"
        first += rows
    return None


def mat_row(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`index 812 of Z, T1` as MATLAB counts; a column of a matrix is `M(3)`."""
    from thermodata_reader_table.mat import Clocked, opened

    with opened(path) as tree:
        found = next((s for s in Clocked(tree, source, path.name).streams if s.name == stream), None)
        if found is None:
            return None
        at = nth_good((found.times(a, a + _ROWS) for a in range(0, found.axis.length, _ROWS)), row)
        if at is None:
            return None
        names = [c.name for c in found.columns]
        more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
        return f"index {at + 1} of {', '.join(names[:_NAMED])}{more}"


def mdf_row(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`group 2 ('daq'), record 812 of 86400`."""
    from thermodata_reader_table import clocks
    from thermodata_reader_table.mdf import File, opened

    with opened(path) as mdf:
        file = File(mdf, source, path.name)
        group = next((g for g in file.groups if g.stream == stream), None)
        if group is None:
            return None
        times = (
            clocks.to_ns(np.asarray(file.inner.get_master(group.index, data=piece)), 1.0)
            for piece in file._fragments(group.index)
        )
        at = nth_good(times, row)
        return None if at is None else f"group {group.index + 1} ('{stream}'), record {at + 1} of {group.rows}"
