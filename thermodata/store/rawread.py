"""Reads back columns of the raw layer: only the row groups that are needed."""

from __future__ import annotations

from pathlib import Path

from thermodata.errors import StoreError
from thermodata.plugin import Array
from thermodata.store.arrow import to_numpy


def read_column(path: Path, column: str, start: int, stop: int) -> Array:
    """Rows start to stop of a raw column: numbers in the file's dtype (NULL as NaN), text as object."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with pq.ParquetFile(path, memory_map=False) as file:
            groups: list[int] = []
            first, at = 0, 0
            for i in range(file.num_row_groups):
                n = file.metadata.row_group(i).num_rows
                if at + n > start and at < stop:
                    first = at if not groups else first
                    groups.append(i)
                at += n
            index = file.schema_arrow.get_field_index(column)
            chunked = file.read_row_groups(groups, columns=[column], use_threads=False).column(column) if groups else \
                pa.chunked_array([], type=file.schema_arrow.field(index).type)
    except (OSError, pa.ArrowException) as error:
        raise StoreError("a file of the store cannot be read", where=str(path), got=str(error).splitlines()[0],
                         hint="forget the campaign and ingest it again") from error
    part = chunked.slice(start - first, stop - start)
    return to_numpy(part)
