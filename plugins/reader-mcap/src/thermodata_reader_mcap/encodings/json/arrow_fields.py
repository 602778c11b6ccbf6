"""The columns inside of an Arrow table of nested messages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.topic import Topic


@dataclass(frozen=True, slots=True)
class Selection:
    """Every `step`-th value of an Arrow array from `first` on: elements of arrays that all have one length stand so
    behind each other, and need no copy."""

    array: Any
    first: int = 0
    step: int = 1

    def alone(self) -> Any:
        """The selected values as an array of their own."""
        import pyarrow as pa

        if self.step == 1:
            return self.array
        return self.array.take(pa.array(np.arange(self.first, len(self.array), self.step)))


def arrays(topic: Topic) -> dict[Path, int]:
    """The arrays of a topic and how many of their elements are signals."""
    counts: dict[Path, int] = {}
    for leaf in topic.leaves:
        path = ("", *leaf.path) if topic.wrapped else leaf.path
        for depth, part in enumerate(path):
            if isinstance(part, int):
                counts[path[:depth]] = max(counts.get(path[:depth], 0), part + 1)
    return counts


def at_leaf(table: Any, path: Path, done: dict[Any, Selection]) -> Selection:
    """The values of a path; nulls where a parent is null or an array is shorter. done: what was looked up before."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if path in done:
        return done[path]
    if len(path) == 1:
        column = table.column(path[0])
        found = Selection(
            column.chunk(0)
            if column.num_chunks == 1
            else pa.concat_arrays(column.chunks)
            if column.num_chunks
            else pa.array([], column.type)
        )
    else:
        parent, part = at_leaf(table, path[:-1], done), path[-1]
        if isinstance(part, str):
            found = Selection(pc.struct_field(parent.array, part), parent.first, parent.step)
        else:
            values, length = _uniform(parent, path[:-1], done)
            if values is not None:
                found = (
                    Selection(values, parent.first * length + part, parent.step * length)
                    if part < length
                    else Selection(pa.nulls(len(parent.alone()), values.type))
                )
            else:
                lists = parent.alone()
                fixed = pc.list_slice(lists, part, part + 1, return_fixed_size_list=True)
                found = Selection(pc.list_element(fixed, 0))
    done[path] = found
    return found


def _uniform(parent: Selection, path: Path, done: dict[Any, Selection]) -> tuple[Any, int]:
    """All elements of an array's lists, where all lists are there and have one length; else None."""
    import pyarrow.compute as pc

    key = ("elements", path)
    if key not in done:
        lists = parent.array
        bounds = {"min": None, "max": None} if lists.null_count else pc.min_max(pc.list_value_length(lists)).as_py()
        same = bounds["min"] is not None and bounds["min"] == bounds["max"]
        done[key] = Selection(lists.flatten() if same else None, int(bounds["min"] or 0) if same else 0)
    return done[key].array, done[key].first


def unexpected(got: Any, wanted: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of fields in a parsed schema that the explicit one does not have."""
    import pyarrow as pa

    known = {f.name: f.type for f in wanted}
    for f in got:
        here = (*path, f.name) if f.name else path
        if f.name not in known:
            yield from _paths_inside(f.type, here)
            continue
        a, b, inner = f.type, known[f.name], here
        while pa.types.is_list(a) and pa.types.is_list(b):
            a, b, inner = a.value_type, b.value_type, (*inner, 0)
        if pa.types.is_struct(a) and pa.types.is_struct(b):
            yield from unexpected(a, b, inner)


def _paths_inside(kind: Any, path: Path) -> Iterator[Path]:
    """The paths of all values that a type holds; the first element stands for those of an array."""
    import pyarrow as pa

    if pa.types.is_struct(kind):
        for f in kind:
            yield from _paths_inside(f.type, (*path, f.name))
    elif pa.types.is_list(kind):
        yield from _paths_inside(kind.value_type, (*path, 0))
    elif not pa.types.is_null(kind):
        yield path
