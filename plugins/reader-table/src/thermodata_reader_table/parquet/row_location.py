"""Where a row stands in a Parquet file: its row group, and the row of it."""

from __future__ import annotations

from pathlib import Path

from thermodata.plugin import Source
from thermodata.reader.text.file.locate import row_at
from thermodata_reader_table.parquet.recording import blocks
from thermodata_reader_table.parquet.table import open_table


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`row group 3, row 812` (of the file: row 100812)."""
    with open_table(path, source) as table:
        found = row_at(blocks(path, source), stream, row)
        if found is None:
            return None
        at = found[0]
        first = 0
        for number in range(table.file.metadata.num_row_groups):
            rows = table.file.metadata.row_group(number).num_rows
            if at < first + rows:
                return f"row group {number + 1}, row {at - first + 1} of it (row {at + 1} of the file)"
            first += rows
        return None
