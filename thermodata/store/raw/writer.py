"""One raw Parquet file in the making: blocks of one stream in, row groups of bounded size out."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import PluginError
from thermodata.plugin import Array, Block, Int1D, Signal
from thermodata.reader.times.clock_leaps import LEAP_NS
from thermodata.reader.times.newest_first import Steps
from thermodata.store.base.arrow import to_arrow
from thermodata.store.base.encoder import Encoder
from thermodata.store.base.files import publish, temporary
from thermodata.store.raw.columns import RawFile
from thermodata.store.raw.order import by_time, find_order
from thermodata.store.raw.repeats import Hashes, batches, find_repeats, keys_of

if TYPE_CHECKING:
    import pyarrow as pa

GROUP_VALUES = 2_000_000  # values in a row group: 16 MB of float64 ...
GROUP_ROWS = 250_000
LEAST_ROWS = 10_000  # ... but not fewer rows than this: each column of a group costs 2 kB of the footer ...
MOST_VALUES = 6_000_000  # ... unless there are so many columns that a group would be too large
_MANY = 8


class StreamWriter:
    """Writes the blocks of one stream; encoding runs beside the reader in one thread.

    A column `<signal>__flag` appears with the first block that flags the signal.
    """

    def __init__(self, target: Path, signals: list[Signal], *, unordered: bool = False) -> None:
        self.target, self.signals, self.unordered = target, signals, unordered
        self.columns = _column_names(signals)
        self.flagged: set[str] = set()
        self.rows, self.first_ns, self.last_ns, self.step_ns = 0, 0, 0, 0
        self.ordered = True
        self._clock = Steps()
        self._group_rows = group_rows(len(signals) + 1)
        self._waiting: list[Block] = []
        self._waiting_rows = 0
        self._encoder: Encoder | None = None
        self._widened = False
        self._made_schema: pa.Schema | None = None
        self._steps: list[int] = []

    def add(self, block: Block) -> None:
        """Takes a block; the reader may not change its arrays afterwards."""
        n = len(block.t_ns)
        if n == 0:
            return
        if self.ordered:
            self.ordered = self._goes_on(block.t_ns)
            self.first_ns = self.first_ns if self.rows else int(block.t_ns[0])
            self.last_ns = int(block.t_ns[-1])
        self._clock.add(block.t_ns)
        if n > 1 and len(self._steps) < 64:
            self._steps.append(int(np.median(np.diff(block.t_ns[:4096]))))
        self.rows += n
        for start in range(0, n, self._group_rows):
            part = block if n <= self._group_rows else _slice(block, start, start + self._group_rows)
            self._waiting.append(part)
            self._waiting_rows += len(part.t_ns)
            if self._waiting_rows >= self._group_rows:
                self._flush()

    @property
    def newest_first(self) -> bool:
        """Whether the rows stand in the file from the last to the first."""
        return not self.ordered and not self.unordered and self._clock.newest_first

    def _goes_on(self, t_ns: Int1D) -> bool:
        """Whether a block's times rise, from where the last one ended, and not by a year at once."""
        before = self.last_ns if self.rows else int(t_ns[0])
        return (
            0 <= int(t_ns[0]) - before <= LEAP_NS
            and int(t_ns[-1]) - int(t_ns[0]) <= LEAP_NS
            and bool((t_ns[1:] >= t_ns[:-1]).all())
        )

    def finish(self, meta: Mapping[str, Any]) -> None:
        """Writes what waits and makes the file appear."""
        self._flush()
        self.step_ns = abs(int(np.median(self._steps))) if self._steps else 0
        assert self._encoder is not None
        self._encoder.close({"thermodata": json.dumps(dict(meta))})
        if not self.ordered:
            self.first_ns, self.last_ns = self._extent(self._encoder.part)
        publish(self._encoder.part, self.target)
        self._encoder = None

    def _extent(self, path: Path) -> tuple[int, int]:
        """Where a recording begins and ends whose clock has faults: up to a reset, for what follows may mean
        anything."""
        file, n = RawFile(path), self.rows

        def times(a: int, b: int) -> Int1D:
            first, last = (n - b, n - a) if self.newest_first else (a, b)
            t_ns: Int1D = file.read(["t_ns"], first, last)[0]
            return t_ns[::-1] if self.newest_first else t_ns

        def keys(a: int, b: int) -> Hashes:
            first, last = (n - b, n - a) if self.newest_first else (a, b)
            some = batches([self.columns[s.name] for s in self.signals], last - first)
            found = keys_of((c for names in some for c in file.read(names, first, last)), last - first)
            return found[::-1] if self.newest_first else found

        try:
            if self.unordered:
                return by_time(times, n).extent
            twice = find_repeats(times, keys, n, held=all(s.held for s in self.signals))
            return find_order(times, n, resets_allowed=False, sound=twice.sound).extent
        finally:
            file.close()

    def discard(self) -> None:
        """Drops an unfinished file; nothing where it is finished."""
        if self._encoder is not None:
            self._encoder.abandon()
            self._encoder = None

    def _flush(self) -> None:
        if not self._waiting:
            return
        blocks, self._waiting, self._waiting_rows = self._waiting, [], 0
        new = {name for b in blocks for name in (b.flags or {}) if name in self.columns} - self.flagged
        if new:
            # a second flag in mid-file brings the columns of all signals: each widening writes the file again
            self.flagged |= set(self.columns) if self._widened else new
            self._made_schema = None
            if self._encoder is not None:
                self._encoder, self._widened = self._encoder.widened(self._schema()), True
        if self._encoder is None:
            self.target.parent.mkdir(exist_ok=True)
            self._encoder = Encoder(temporary(self.target), self._schema())
        self._encoder.put(self._table(blocks))

    def _schema(self) -> pa.Schema:
        import pyarrow as pa

        if self._made_schema is None:
            fields = [pa.field("t_ns", pa.int64(), nullable=False)]
            for signal in self.signals:
                fields.append(pa.field(self.columns[signal.name], arrow_type(signal)))
                if signal.name in self.flagged:
                    fields.append(pa.field(f"{self.columns[signal.name]}__flag", pa.uint16()))
            self._made_schema = pa.schema(fields)
        return self._made_schema

    def _table(self, blocks: list[Block]) -> pa.Table:
        import pyarrow as pa

        schema = self._schema()
        arrays = [_chunked([b.t_ns for b in blocks], blocks, pa.int64())]
        for signal in self.signals:
            kind = schema.field(len(arrays)).type
            arrays.append(_chunked([b.values.get(signal.name) for b in blocks], blocks, kind))
            if signal.name in self.flagged:
                arrays.append(_chunked([_flags(b, signal.name) for b in blocks], blocks, pa.uint16()))
        return pa.Table.from_arrays(arrays, schema=schema)


def _chunked(parts: list[Array | None], blocks: list[Block], kind: pa.DataType) -> pa.ChunkedArray:
    import pyarrow as pa

    whole = [p for p in parts if p is not None]
    if len(parts) > _MANY and len(whole) == len(parts):
        # a reader of many small blocks: joining them costs less than an Arrow array for each
        return pa.chunked_array([to_arrow(np.concatenate(whole))], type=kind)
    return pa.chunked_array(
        [pa.nulls(len(b.t_ns), kind) if p is None else to_arrow(p) for b, p in zip(blocks, parts, strict=True)],
        type=kind,
    )


def group_rows(columns: int) -> int:
    """How many rows a row group of so many columns has."""
    return max(1, min(GROUP_ROWS, max(GROUP_VALUES // columns, min(LEAST_ROWS, MOST_VALUES // columns))))


def arrow_type(signal: Signal) -> pa.DataType:
    """The column type of a signal: the file's own."""
    import pyarrow as pa

    if signal.dtype == "str":
        return pa.string()
    try:
        return pa.from_numpy_dtype(np.dtype(signal.dtype).newbyteorder("="))
    except (TypeError, NotImplementedError, pa.ArrowNotImplementedError) as error:
        raise PluginError(
            f"signal '{signal.name}' has a dtype that cannot be stored", expected="a number or 'str'", got=signal.dtype
        ) from error


def _flags(block: Block, name: str) -> Array:
    given = (block.flags or {}).get(name)
    return np.zeros(len(block.t_ns), np.uint16) if given is None else np.asarray(given).astype(np.uint16)


def _slice(block: Block, start: int, stop: int) -> Block:
    return Block(
        block.stream,
        block.t_ns[start:stop],
        {k: v[start:stop] for k, v in block.values.items()},
        None if block.flags is None else {k: v[start:stop] for k, v in block.flags.items()},
    )


def _column_names(signals: list[Signal]) -> dict[str, str]:
    taken, names = {"t_ns"}, {}
    for signal in signals:
        name = signal.name or "unnamed"
        while name.lower() in taken or f"{name}__flag".lower() in taken:
            name += "_"
        names[signal.name] = name
        taken |= {name.lower(), f"{name}__flag".lower()}
    return names
