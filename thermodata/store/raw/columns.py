"""Reads back columns of the raw layer: only the row groups that are needed, each decoded once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from thermodata.errors import StoreError
from thermodata.plugin import Array
from thermodata.store.base.arrow import to_numpy, use_one_heap

if TYPE_CHECKING:
    import pyarrow as pa

_OPEN = 4  # files held open: their footers stay parsed, which for wide files is most of the work


class RawFile:
    """One open raw file. Not shared between threads; Arrow decodes the columns of a read in its own threads."""

    def __init__(self, path: Path) -> None:
        import pyarrow.parquet as pq

        use_one_heap()
        self.path = path
        with _as_store_error(path):
            self._file = pq.ParquetFile(path, memory_map=False, pre_buffer=False)
        meta = self._file.metadata
        self._starts = np.cumsum([0, *(meta.row_group(i).num_rows for i in range(meta.num_row_groups))])
        self._index = {name: i for i, name in enumerate(self._file.schema_arrow.names)}
        # the row group that a chunk ended in is where the next one begins
        self._last: tuple[int, tuple[int, ...], pa.Table] | None = None

    def read(self, columns: Sequence[str], start: int, stop: int) -> list[Array]:
        """Rows start to stop: numbers in the file's dtype (NULL as NaN), text as object."""
        wanted = tuple(dict.fromkeys(self._index[c] for c in columns))
        first = int(np.searchsorted(self._starts, start, side="right")) - 1
        arrays: list[Array] = []
        at = first
        with _as_store_error(self.path):
            while at < len(self._starts) - 1 and self._starts[at] < stop:
                low, high = int(self._starts[at]), int(self._starts[at + 1])
                table = self._group(at, wanted).slice(max(start - low, 0), min(stop, high) - max(start, low))
                parts = [to_numpy(table.column(i)) for i in range(len(wanted))]
                if high >= stop and not arrays:
                    arrays = parts
                else:
                    arrays = _put_behind(arrays, parts, max(start, low) - start, stop - start)
                at += 1
            if not arrays:
                empty = self._file.schema_arrow.empty_table().select(list(wanted))
                arrays = [to_numpy(empty.column(i)) for i in range(len(wanted))]
        place = {c: arrays[i] for i, c in enumerate(wanted)}
        return [place[self._index[c]] for c in columns]

    def _group(self, group: int, wanted: tuple[int, ...]) -> pa.Table:
        if self._last is not None and self._last[:2] == (group, wanted):
            return self._last[2]
        self._last = None
        table = self._file.reader.read_row_group(group, column_indices=list(wanted), use_threads=len(wanted) > 1)
        self._last = (group, wanted, table)
        return table

    def close(self) -> None:
        self._last = None
        self._file.close()


def _put_behind(arrays: list[Array], parts: list[Array], at: int, rows: int) -> list[Array]:
    """Puts the parts behind what is there: into their place, so that no row group outlives its reading."""
    if not arrays:
        arrays = [np.empty(rows, part.dtype) for part in parts]
    for i, part in enumerate(parts):
        if part.dtype != arrays[i].dtype:
            # whole numbers become float64 in a row group that has NULLs
            arrays[i] = arrays[i].astype(np.result_type(arrays[i], part))
        arrays[i][at : at + len(part)] = part
    return arrays


class RawFiles:
    """The raw files of a timeline, a few of them open."""

    def __init__(self) -> None:
        self._open: dict[Path, RawFile] = {}

    def get(self, path: Path) -> RawFile:
        file = self._open.pop(path, None)
        if file is None:
            if len(self._open) >= _OPEN:
                self._open.pop(next(iter(self._open))).close()
            file = RawFile(path)
        self._open[path] = file
        return file

    def close(self) -> None:
        while self._open:
            self._open.popitem()[1].close()


class _as_store_error:  # noqa: N801 - reads as a statement
    def __init__(self, path: Path) -> None:
        self.path = path

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        import pyarrow as pa

        if isinstance(error, OSError | pa.ArrowException):
            raise StoreError(
                "a file of the store cannot be read",
                where=str(self.path),
                got=str(error).splitlines()[0],
                hint="forget the campaign and ingest it again",
            ) from error


def read_column(path: Path, column: str, start: int, stop: int) -> Array:
    """Rows start to stop of a raw column: numbers in the file's dtype (NULL as NaN), text as object."""
    file = RawFile(path)
    try:
        return file.read([column], start, stop)[0]
    finally:
        file.close()
