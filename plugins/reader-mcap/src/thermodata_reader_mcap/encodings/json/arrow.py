"""JSON messages of one topic as columns through Arrow's parser. What it refuses, or reads otherwise than JSON means
it, is halved until few messages are left to go one by one."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.plugin import Array
from thermodata_reader_mcap.encodings import decoded_messages
from thermodata_reader_mcap.encodings.columns import MISSING, Columns, Wrong
from thermodata_reader_mcap.encodings.field_paths import MOST_ELEMENTS, path_name
from thermodata_reader_mcap.encodings.json.arrow_fields import Selection, arrays, at_leaf, unexpected
from thermodata_reader_mcap.encodings.json.text import loads
from thermodata_reader_mcap.encodings.topic import Topic

if TYPE_CHECKING:
    import pyarrow as pa

MOST_SIGNALS = 2000  # of a topic whose messages Arrow parses
_FEW = 256  # messages that are parsed at a time where fields come that the schema does not have,
_SHORT = 64 << 10  # and bytes: each of them may bring fields of its own, and Arrow makes a column of each
_SMALL = 32
_EXACT = 2.0**53
_OPENING, _CLOSING = b"{}"
_first, _last = itemgetter(0), itemgetter(-1)
_LONG_INTEGER = re.compile(rb"[:\[,\s]-?\d{16,}(?![\d.eE])")


class _OddError(Exception):
    """Messages that Arrow does not read with the topic's schema."""


class _UnexpectedError(_OddError):
    """Messages with fields that the topic's schema does not have."""


def columns(topic: Topic, payloads: Sequence[bytes], at: int, infer: bool = False) -> Iterator[Columns]:
    """The payloads as columns, in order; `at` is the place of the first one."""
    if not payloads:
        return
    if len(payloads) > _SMALL and len(topic.leaves) <= MOST_SIGNALS:
        try:
            yield _by_arrow(topic, payloads, at, infer)
            return
        except _UnexpectedError:
            yield from _in_slices(topic, payloads, at)
            return
        except _OddError:
            if len(payloads) > 2 * _SMALL:
                half = len(payloads) // 2
                yield from columns(topic, payloads[:half], at, infer)
                yield from columns(topic, payloads[half:], at + half, infer)
                return
    yield decoded_messages.columns(topic, loads, payloads, at)


def _in_slices(topic: Topic, payloads: Sequence[bytes], at: int) -> Iterator[Columns]:
    begin = 0
    while begin < len(payloads):
        stop, size = begin, 0
        while stop < len(payloads) and stop - begin < _FEW and (size == 0 or size + len(payloads[stop]) < _SHORT):
            size += len(payloads[stop])
            stop += 1
        yield from columns(topic, payloads[begin:stop], at + begin, True)
        begin = stop


def _by_arrow(topic: Topic, payloads: Sequence[bytes], at: int, infer: bool) -> Columns:
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.json as pj

    wanted = arrow_schema(topic)
    text = joined(topic.wrapped, payloads)
    if text is None:
        raise _OddError
    try:
        table = pj.read_json(
            pa.BufferReader(text),
            pj.ReadOptions(use_threads=False, block_size=len(text) + 16),
            pj.ParseOptions(explicit_schema=wanted, unexpected_field_behavior="infer" if infer else "error"),
        )
        if table.num_rows != len(payloads):
            raise _OddError
        wrong = [Wrong(at, path_name(topic.name, path), None, "") for path in unexpected(table.schema, wanted)]
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        done: dict[Any, Selection] = {}
        for path, count in arrays(topic).items():
            longest = pc.max(pc.list_value_length(at_leaf(table, path, done).array)).as_py() or 0
            real = path[topic.wrapped :]
            if count < min(longest, MOST_ELEMENTS) or (longest > MOST_ELEMENTS and real not in topic.long):
                wrong.append(Wrong(at, path_name(topic.name, (*real, count)), None, ""))
        for leaf in topic.leaves:
            column = at_leaf(table, ("", *leaf.path) if topic.wrapped else leaf.path, done)
            values[leaf.name], missing = _numpy(column, leaf.dtype)
            if missing is not None:
                flags[leaf.name] = missing
    except (pa.ArrowException, UnicodeDecodeError) as error:
        raise (_UnexpectedError if not infer and "unexpected field" in str(error) else _OddError) from error
    if any(v.dtype == np.float64 and _large(v) for v in values.values()) and _LONG_INTEGER.search(text):
        raise _OddError  # integers that a float64 may have rounded
    return Columns(np.arange(at, at + len(payloads)), values, flags, wrong)


def joined(wrapped: bool, payloads: Sequence[bytes]) -> bytes | None:
    """Payloads as lines, each one object; None where they are not. The borders are looked at: two objects in one
    payload and none in another would count right and stand wrong."""
    if wrapped:
        text = b'{"":' + b'}\n{"":'.join(payloads) + b"}"
        return text if text.count(b"\n") == len(payloads) - 1 else None
    for form in (None, _one_line):
        lines = payloads if form is None else [form(p) for p in payloads]
        if not all(lines) or set(map(_first, lines)) != {_OPENING} or set(map(_last, lines)) != {_CLOSING}:
            continue
        text = b"\n".join(lines)
        if text.count(b"\n") == len(payloads) - 1:
            return text
    return None


def _one_line(payload: bytes) -> bytes:
    """The same JSON without line ends; within a text there are none."""
    return payload.replace(b"\n", b" ").replace(b"\r", b" ").strip(b" \t")


def arrow_schema(topic: Topic) -> pa.Schema:
    """The schema of a topic's messages as its leaves tell it."""
    import pyarrow as pa

    tree: dict[str | int, Any] = {}
    for leaf in topic.leaves:
        node, path = tree, ("", *leaf.path) if topic.wrapped else leaf.path
        path = tuple(0 if isinstance(part, int) else part for part in path)  # all elements of an array are one
        for part in path[:-1]:
            node = node.setdefault(part, {})
            if not isinstance(node, dict):
                raise _OddError  # a number here and an object there
        if node.setdefault(path[-1], leaf.dtype) != leaf.dtype:
            raise _OddError
    return pa.schema([pa.field(str(k), _arrow_type(v)) for k, v in tree.items()])


def _arrow_type(node: Any) -> pa.DataType:
    import pyarrow as pa

    if isinstance(node, str):
        return {"str": pa.string(), "bool": pa.bool_()}.get(node) or pa.type_for_alias(node)
    if 0 in node:
        if len(node) > 1:
            raise _OddError  # an array here and an object there
        return pa.list_(_arrow_type(node[0]))
    return pa.struct([pa.field(k, _arrow_type(v)) for k, v in node.items()])


def _large(values: Array) -> bool:
    with np.errstate(invalid="ignore"):
        return bool((np.abs(values) >= _EXACT).any())


def _numpy(column: Selection, dtype: str) -> tuple[Array, Array | None]:
    array, part = column.array, slice(column.first, None, column.step)
    if dtype == "str":
        return array.to_numpy(zero_copy_only=False)[part], None
    if dtype == "float64" or not array.null_count:
        return np.ascontiguousarray(array.to_numpy(zero_copy_only=False)[part]).astype(dtype, copy=False), None
    missing = array.is_null().to_numpy(zero_copy_only=False)[part]
    filled = array.fill_null(False if dtype == "bool" else 0).to_numpy(zero_copy_only=False)[part].astype(dtype)
    return filled, missing.astype(np.uint16) * MISSING if missing.any() else None
