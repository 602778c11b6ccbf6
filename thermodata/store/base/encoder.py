"""A Parquet file in the making: encoding runs beside whoever makes the data, in one thread."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from queue import Queue
from typing import TYPE_CHECKING

import numpy as np

from thermodata.store.base.arrow import to_arrow, use_one_heap
from thermodata.store.base.files import write_error

if TYPE_CHECKING:
    import pyarrow as pa

COMPRESSION = "lz4"
_WIDE = 300  # columns


class Encoder:
    """A ParquetWriter that works in its own thread, one or two row groups behind at most."""

    def __init__(self, part: Path, schema: pa.Schema) -> None:
        import pyarrow as pa
        import pyarrow.parquet as pq

        use_one_heap()
        self.part, self.schema = part, schema
        # only text and flags repeat themselves so much that a dictionary pays
        repeats = [f.name for f in schema if pa.types.is_string(f.type) or f.name.endswith("__flag")]
        times = [f.name for f in schema if f.name in ("t_ns", "t", "t_s")]
        try:
            self._writer = pq.ParquetWriter(
                part,
                schema,
                compression=COMPRESSION,
                use_dictionary=repeats or False,
                column_encoding=_encodings(schema, repeats),
                write_statistics=times,
                write_page_checksum=True,
            )
        except OSError as error:
            raise write_error(part, error) from error
        # row groups of wide streams are large, and so is the footer that grows with their columns
        self._queue: Queue[pa.Table | None] = Queue(maxsize=1 if len(schema) > _WIDE else 2)
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._write_queued, name="raw-parquet", daemon=True)
        self._thread.start()

    def put(self, table: pa.Table) -> None:
        self._check()
        self._queue.put(table)

    def _check(self) -> None:
        if isinstance(self._error, OSError):
            raise write_error(self.part, self._error) from self._error
        if self._error is not None:
            raise self._error

    def _write_queued(self) -> None:
        while (table := self._queue.get()) is not None:
            if self._error is None:
                try:
                    self._writer.write_table(table, row_group_size=max(1, table.num_rows))
                except BaseException as error:
                    self._error = error

    def _join(self) -> None:
        if self._thread.is_alive():
            self._queue.put(None)
            self._thread.join()

    def close(self, meta: Mapping[str, str]) -> None:
        self._join()
        if self._error is None:
            self._writer.add_key_value_metadata(dict(meta))
        try:
            self._writer.close()
        except OSError as error:
            self._error = self._error or error
        self._check()

    def abandon(self) -> None:
        self._join()
        with contextlib.suppress(OSError):
            self._writer.close()
        self.part.unlink(missing_ok=True)

    def widened(self, schema: pa.Schema) -> Encoder:
        """A new file with more columns that begins with what this one holds (rare: a flag in mid-file)."""
        import pyarrow.parquet as pq

        self.close({})
        wider = Encoder(self.part.with_name(f".w{self.part.name}"), schema)
        with pq.ParquetFile(self.part) as old:
            for i in range(old.num_row_groups):
                table = old.read_row_group(i)
                for name in schema.names:
                    if name not in table.column_names:
                        table = table.append_column(name, to_arrow(np.zeros(table.num_rows, np.uint16)))
                wider.put(table.select(schema.names).cast(schema))
        self.part.unlink()
        return wider


def _encodings(schema: pa.Schema, dictionaries: Sequence[str]) -> dict[str, str]:
    """The encoding of each column that has no dictionary: a steady clock shrinks to nothing, and of measurements the
    bytes that change slowly stand together; a quarter is saved, and no time lost."""
    import pyarrow as pa

    encodings = {}
    apart = set(dictionaries)
    for f in schema:
        if f.name in apart:
            continue
        if pa.types.is_int64(f.type) or pa.types.is_timestamp(f.type):
            encodings[f.name] = "DELTA_BINARY_PACKED"
        elif pa.types.is_floating(f.type) and not pa.types.is_float16(f.type):
            encodings[f.name] = "BYTE_STREAM_SPLIT"
    return encodings
