"""What the sampled messages of a topic hold at each path: how often which kind of value, and how large."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata_reader_mcap.encodings.field_paths import MOST_DEPTH, MOST_ELEMENTS, Path

if TYPE_CHECKING:
    import pyarrow as pa

_EXACT = 2**53


class UnsureError(Exception):
    """A table that does not tell all that its messages hold."""


@dataclass(slots=True)
class FieldCounts:
    """How often one path was there, with which kinds of value; low, high: of its integers, and of 0."""

    count: int = 0
    nulls: int = 0
    bools: int = 0
    integers: int = 0
    floats: int = 0
    texts: int = 0
    low: int = 0
    high: int = 0

    @property
    def scalars(self) -> int:
        """Values that are numbers, truths or texts."""
        return self.bools + self.integers + self.floats + self.texts

    def __iadd__(self, other: FieldCounts) -> FieldCounts:
        for name in ("count", "nulls", "bools", "integers", "floats", "texts"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.low, self.high = min(self.low, other.low), max(self.high, other.high)
        return self


@dataclass(slots=True)
class Survey:
    """total: messages. long: arrays of too many elements, and how many; binary: the same of bytes; deep: paths that
    are nested too deep."""

    total: int = 0
    seen: dict[Path, FieldCounts] = field(default_factory=dict)
    long: dict[Path, int] = field(default_factory=dict)
    binary: dict[Path, int] = field(default_factory=dict)
    deep: set[Path] = field(default_factory=set)

    def add(self, message: Any) -> None:
        """One message as Python values."""
        self.total += 1
        self._visit(message, ())

    def _visit(self, value: Any, path: Path) -> None:
        kind = type(value)
        if kind is dict or kind is list:
            if len(path) >= MOST_DEPTH:
                self.deep.add(path[:4])
                return
            if kind is dict:
                for key, inner in value.items():
                    self._visit(inner, (*path, str(key)))
                return
            if len(value) > MOST_ELEMENTS:
                self.long[path] = max(self.long.get(path, 0), len(value))
            for place, inner in enumerate(value[:MOST_ELEMENTS]):
                self._visit(inner, (*path, place))
            return
        if kind is bytes:
            self.binary[path] = max(self.binary.get(path, 0), len(value))
            return
        each = self.seen.get(path)
        if each is None:
            each = self.seen.setdefault(path, FieldCounts())
        each.count += 1
        if value is None:
            each.nulls += 1
        elif kind is bool:
            each.bools += 1
        elif kind is int:
            each.integers += 1
            each.low, each.high = min(each.low, value), max(each.high, value)
        elif kind is float:
            each.floats += 1
        else:
            each.texts += 1

    def add_table(self, table: pa.Table) -> None:
        """Messages as Arrow inferred them. UnsureError, with nothing added: integers that it may have rounded."""
        part = Survey()
        for name, column in zip(table.column_names, table.columns, strict=True):
            part._column((name,), column.combine_chunks())
        self.total += table.num_rows
        for path, each in part.seen.items():
            if path in self.seen:
                self.seen[path] += each
            else:
                self.seen[path] = each
        for path, n in part.long.items():
            self.long[path] = max(self.long.get(path, 0), n)
        self.deep |= part.deep

    def _column(self, path: Path, column: Any) -> None:
        import pyarrow as pa
        import pyarrow.compute as pc

        kind = column.type
        if isinstance(column, pa.ChunkedArray):
            column = pa.concat_arrays(column.chunks) if column.num_chunks else pa.array([], kind)
        if pa.types.is_struct(kind) or pa.types.is_list(kind):
            if len(path) >= MOST_DEPTH:
                self.deep.add(path[:4])
                return
            if pa.types.is_struct(kind):
                for place, inner in enumerate(kind):
                    self._column((*path, inner.name), pc.struct_field(column, place))
                if column.null_count:
                    self.seen[path] = FieldCounts(count=column.null_count, nulls=column.null_count)
                return
            lengths = pc.list_value_length(column).fill_null(0).to_numpy(zero_copy_only=False)
            longest = int(lengths.max()) if lengths.size else 0
            if longest > MOST_ELEMENTS:
                self.long[path] = longest
            values = column.flatten()
            order = np.arange(len(values)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
            for place in range(min(longest, MOST_ELEMENTS)):
                self._column((*path, place), values.filter(pa.array(order == place)))
            return
        present = len(column) - column.null_count
        each = FieldCounts(count=present)
        if pa.types.is_boolean(kind):
            each.bools = present
        elif pa.types.is_integer(kind):
            each.integers = present
            bounds = pc.min_max(column).as_py()
            each.low, each.high = min(0, bounds["min"] or 0), max(0, bounds["max"] or 0)
        elif pa.types.is_floating(kind):
            each.floats = present
            largest = pc.max(pc.abs(column)).as_py() or 0.0
            if largest >= _EXACT:
                raise UnsureError
        elif pa.types.is_null(kind):
            each = FieldCounts(count=len(column), nulls=len(column))
        else:
            each.texts = present
        self.seen[path] = each
