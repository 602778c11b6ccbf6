"""Parquet whose footer says one thing of a column in two places."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Source
from thermodata.testing.reader import load


def _mixed(path: Path) -> None:
    """A file in whose footer one bit is turned, so that a column chunk and the schema are of two types."""
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "n": np.arange(5)}), path)
    data = path.read_bytes()
    begin = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    for at in range(begin, len(data) - 8):
        for bit in range(1, 4):
            path.write_bytes(data[:at] + bytes((data[at] ^ 1 << bit,)) + data[at + 1 :])
            try:
                file = pq.ParquetFile(path)
                chunk = file.metadata.row_group(0).column(1)
                if file.schema.names == ["t [s]", "n"] and chunk.physical_type != file.schema.column(1).physical_type:
                    return
            except (pa.ArrowException, OSError, ValueError, IndexError):
                continue
    raise AssertionError("no bit does it")


def test_a_chunk_of_another_type_than_its_column_is_refused(tmp_path: Path) -> None:
    _mixed(tmp_path / "x.parquet")
    with pytest.raises(FormatError, match="not a readable Parquet file"):
        Reader().describe(tmp_path / "x.parquet", Source())


def test_several_declared_times_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.parquet"
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "n": np.arange(5)}), path)
    with pytest.raises(UsageError, match="several times"):
        Reader().describe(path, Source(table={"time": [{"column": 1}, {"column": 2}]}))
    assert load(Reader(), path, Source(table={"time": [{"column": 1}]})).t_ns["table"].size == 5
