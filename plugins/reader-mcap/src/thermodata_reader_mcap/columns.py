"""Messages of one topic as columns: JSON through Arrow's parser, all else (and what it refuses) one by one."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.schema.flag import Flag
from thermodata_reader_mcap.leaves import MOST_ELEMENTS, Leaf, Path, path_name

if TYPE_CHECKING:
    import pyarrow as pa

_MISSING = np.uint16(Flag.NOT_MEASURING)      # no NaN in integers and booleans: 0, and not valid
_SMALL = 32
Decode = Callable[[bytes], Any]


@dataclass(frozen=True, slots=True)
class Topic:
    """What the sample of a topic found. decode: one payload to Python values. json: Arrow may parse it.
    wrapped: messages are no objects but single values or arrays."""

    name: str
    leaves: tuple[Leaf, ...]
    decode: Decode
    json: bool
    wrapped: bool = False


@dataclass(slots=True)
class Columns:
    """Columns of consecutive messages. kept: which are in, shape (n,); wrong: (message, name, expected, got)."""

    kept: Int1D
    values: dict[str, Array]
    flags: dict[str, Array]
    wrong: list[tuple[int, str, str, str]] = field(default_factory=list)


class _OddError(Exception):
    """Messages that Arrow does not read with the topic's schema."""


def columns(topic: Topic, payloads: Sequence[bytes], at: int = 0) -> Iterator[Columns]:
    """The payloads as columns, in order; `at` is the place of the first one in its batch. What Arrow refuses is
    halved until only a few messages are left to go one by one."""
    if not payloads:
        return
    if topic.json and len(payloads) > 1:
        try:
            yield _by_arrow(topic, payloads, at)
            return
        except _OddError:
            if len(payloads) > _SMALL:
                half = len(payloads) // 2
                yield from columns(topic, payloads[:half], at)
                yield from columns(topic, payloads[half:], at + half)
                return
    yield _one_by_one(topic, payloads, at)


# ---- Arrow ---------------------------------------------------------------------------------------


def _by_arrow(topic: Topic, payloads: Sequence[bytes], at: int) -> Columns:
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.json as pj

    wanted = arrow_schema(topic)
    text = b'}\n{"":'.join(payloads) if topic.wrapped else b"\n".join(payloads)
    if topic.wrapped:
        text = b'{"":' + text + b"}"
    if text.count(b"\n") != len(payloads) - 1:              # a payload with line ends between its tokens
        text = b"\n".join(p.replace(b"\n", b" ").replace(b"\r", b" ") for p in payloads)
        if topic.wrapped:
            raise _OddError
    longest = max(map(len, payloads)) + 8
    try:
        table = pj.read_json(
            pa.BufferReader(text), pj.ReadOptions(block_size=max(1 << 20, 2 * longest)),
            pj.ParseOptions(explicit_schema=wanted, unexpected_field_behavior="infer"))
    except (pa.ArrowInvalid, UnicodeDecodeError) as error:
        raise _OddError from error
    if table.num_rows != len(payloads):
        raise _OddError
    wrong = [(at, path_name(topic.name, path), "nothing, by the first messages", "a field")
             for path in _unexpected(table.schema, wanted)]
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {}
    done: dict[Path, Any] = {}
    for path, count in _arrays(topic).items():
        longest = pc.max(pc.list_value_length(_leaf_column(table, path, done))).as_py() or 0
        if count < min(longest, MOST_ELEMENTS):
            name = path_name(topic.name, (*path[topic.wrapped:], count))
            wrong.append((at, name, "nothing, by the first messages", "a field"))
    for leaf in topic.leaves:
        column = _leaf_column(table, ("", *leaf.path) if topic.wrapped else leaf.path, done)
        values[leaf.name], missing = _numpy(column, leaf.dtype)
        if missing is not None:
            flags[leaf.name] = missing
    return Columns(np.arange(at, at + len(payloads)), values, flags, wrong)


def arrow_schema(topic: Topic) -> pa.Schema:
    """The schema of a topic's messages as its leaves tell it."""
    import pyarrow as pa

    tree: dict[str | int, Any] = {}
    for leaf in topic.leaves:
        node, path = tree, ("", *leaf.path) if topic.wrapped else leaf.path
        path = tuple(0 if isinstance(part, int) else part for part in path)     # all elements of an array are one
        for part in path[:-1]:
            node = node.setdefault(part, {})
            if not isinstance(node, dict):
                raise _OddError                             # a number here and an object there
        if node.setdefault(path[-1], leaf.dtype) != leaf.dtype:
            raise _OddError
    return pa.schema([pa.field(str(k), _arrow_type(v)) for k, v in tree.items()])


def _arrays(topic: Topic) -> dict[Path, int]:
    """The arrays of a topic and how many of their elements are signals."""
    counts: dict[Path, int] = {}
    for leaf in topic.leaves:
        path = ("", *leaf.path) if topic.wrapped else leaf.path
        for depth, part in enumerate(path):
            if isinstance(part, int):
                counts[path[:depth]] = max(counts.get(path[:depth], 0), part + 1)
    return counts


def _arrow_type(node: Any) -> pa.DataType:
    import pyarrow as pa

    if isinstance(node, str):
        return {"str": pa.string(), "bool": pa.bool_()}.get(node) or pa.type_for_alias(node)
    if 0 in node:
        if len(node) > 1:
            raise _OddError                                 # an array here and an object there
        return pa.list_(_arrow_type(node[0]))
    return pa.struct([pa.field(k, _arrow_type(v)) for k, v in node.items()])


def _leaf_column(table: pa.Table, path: Path, done: dict[Path, Any]) -> pa.Array:
    """The array of a path; nulls where a parent is null or an array is shorter."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if path in done:
        return done[path]
    if len(path) == 1:
        column = table.column(path[0]).combine_chunks()
        if isinstance(column, pa.ChunkedArray):
            column = column.chunk(0) if column.num_chunks else pa.array([], column.type)
    else:
        parent, part = _leaf_column(table, path[:-1], done), path[-1]
        if isinstance(part, int):
            fixed = pc.list_slice(parent, part, part + 1, return_fixed_size_list=True)
            column = pc.list_element(fixed, 0)
        else:
            column = pc.struct_field(parent, part)
    done[path] = column
    return column


def _numpy(column: pa.Array, dtype: str) -> tuple[Array, Array | None]:
    if dtype == "str":
        return column.to_numpy(zero_copy_only=False), None
    if dtype == "float64" or not column.null_count:
        return column.to_numpy(zero_copy_only=False).astype(dtype, copy=False), None
    flags = column.is_null().to_numpy(zero_copy_only=False).astype(np.uint16) * _MISSING
    filled = column.fill_null(False if dtype == "bool" else 0)
    return filled.to_numpy(zero_copy_only=False).astype(dtype, copy=False), flags


def _unexpected(got: Any, wanted: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of fields in a parsed schema that the explicit one does not have."""
    import pyarrow as pa

    known = {f.name: f.type for f in wanted}
    for f in got:
        here = (*path, f.name) if f.name else path
        if f.name not in known:
            yield here
            continue
        a, b, inner = f.type, known[f.name], here
        while pa.types.is_list(a) and pa.types.is_list(b):
            a, b, inner = a.value_type, b.value_type, (*inner, 0)
        if pa.types.is_struct(a) and pa.types.is_struct(b):
            yield from _unexpected(a, b, inner)


# ---- one by one ----------------------------------------------------------------------------------


def _one_by_one(topic: Topic, payloads: Sequence[bytes], at: int) -> Columns:
    known = {leaf.path for leaf in topic.leaves}
    cells: list[list[Any]] = [[] for _ in topic.leaves]
    kept: list[int] = []
    result = Columns(np.empty(0, np.int64), {}, {})
    for k, payload in enumerate(payloads, at):
        try:
            message = topic.decode(payload)
        except Exception as error:                          # a decoder may stumble over anything
            got = payload[:60].decode("utf-8", "replace")
            result.wrong.append((k, "", "a message", f"{type(error).__name__}: {str(error)[:80]}; {got!r}"))
            continue
        if not topic.wrapped and not isinstance(message, Mapping):
            result.wrong.append((k, "", "an object", repr(message)[:60]))
            continue
        kept.append(k)
        for leaf, column in zip(topic.leaves, cells, strict=True):
            value = at_path(message, leaf.path)
            good = as_dtype(value, leaf.dtype)
            if good is None and value is not None:
                result.wrong.append((k, leaf.name, leaf.dtype, repr(value)[:60]))
            column.append(good)
        result.wrong += [(k, path_name(topic.name, path), "nothing, by the first messages", "a field")
                         for path in paths(message) if path not in known]
    result.kept = np.array(kept, np.int64)
    for leaf, column in zip(topic.leaves, cells, strict=True):
        result.values[leaf.name], missing = as_array(column, leaf.dtype)
        if missing is not None:
            result.flags[leaf.name] = missing
    return result


def at_path(message: Any, path: Path) -> Any:
    """The value at a path; None where it ends before."""
    for part in path:
        if isinstance(part, int):
            if not isinstance(message, list) or part >= len(message):
                return None
            message = message[part]
        elif isinstance(message, Mapping):
            message = message.get(part)
        else:
            return None
    return message


def paths(message: Any, path: Path = ()) -> Iterator[Path]:
    """The paths of all values that are not null."""
    if isinstance(message, Mapping):
        for key, inner in message.items():
            yield from paths(inner, (*path, str(key)))
    elif isinstance(message, list):
        for place, inner in enumerate(message[:MOST_ELEMENTS]):
            yield from paths(inner, (*path, place))
    elif message is not None:
        yield path


def as_dtype(value: Any, dtype: str) -> Any:
    """A value of the signal's dtype; None where it is none (numbers among texts are written out)."""
    if value is None or isinstance(value, Mapping | list):
        return None
    if dtype == "str":
        return value if isinstance(value, str) else repr(value) if not isinstance(value, bool) else str(value).lower()
    if dtype == "bool":
        return value if isinstance(value, bool) else None
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if dtype == "float64":
        try:
            return float(value)
        except OverflowError:
            return math.inf if value > 0 else -math.inf
    low, high = (0, 2**64) if dtype == "uint64" else (-(2**63), 2**63)
    return int(value) if isinstance(value, int) and low <= value < high else None


def as_array(cells: list[Any], dtype: str) -> tuple[Array, Array | None]:
    """Cells (None: missing) as an array; flags of the missing where the dtype has no NaN."""
    if dtype == "str":
        result = np.empty(len(cells), object)
        result[:] = cells
        return result, None
    if dtype == "float64":
        return np.array([math.nan if c is None else c for c in cells], np.float64), None
    missing = np.array([c is None for c in cells], bool)
    values = np.array([0 if c is None else c for c in cells], np.dtype(dtype))
    return values, missing * _MISSING if missing.any() else None
