"""Messages decoded one after the other, and each value held against its signal's dtype."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Array
from thermodata_reader_mcap.encodings.columns import MISSING, Columns, Wrong
from thermodata_reader_mcap.encodings.field_paths import MOST_DEPTH, MOST_ELEMENTS, Path, path_name
from thermodata_reader_mcap.encodings.topic import Topic

_EXACT = 2**53
_MANY = 100  # signals from which on a message is taken apart once
_NEW = 50  # new fields of one message that are named


def columns(topic: Topic, decode: Callable[[bytes], Any], payloads: Sequence[bytes], at: int) -> Columns:
    """The payloads as columns; `at` is the place of the first one."""
    known = {leaf.path for leaf in topic.leaves} | topic.skipped
    cells: list[list[Any]] = [[] for _ in topic.leaves]
    kept: list[int] = []
    result = Columns(np.empty(0, np.int64), {}, {})
    for k, payload in enumerate(payloads, at):
        try:
            message = decode(payload)
        except Exception as error:  # a decoder may stumble over anything
            got = payload[:60].decode("utf-8", "replace")
            result.wrong.append(Wrong(k, "", "a message", f"{type(error).__name__}: {str(error)[:80]}; {got!r}"))
            continue
        if not topic.wrapped and not isinstance(message, Mapping):
            result.wrong.append(Wrong(k, "", "an object", repr(message)[:60]))
            continue
        kept.append(k)
        flat = dict(_flat(message)) if len(topic.leaves) > _MANY else None
        for leaf, column in zip(topic.leaves, cells, strict=True):
            value = at_path(message, leaf.path) if flat is None else flat.get(leaf.path)
            if value is None:
                column.append(None)
                continue
            good = as_dtype(value, leaf.dtype)
            if good is None and not _has_inner(value):
                result.wrong.append(Wrong(k, leaf.name, leaf.dtype, repr(value)[:60]))
            elif leaf.dtype == "float64" and isinstance(value, int) and abs(value) > _EXACT and value != good:
                result.wrong.append(
                    Wrong(k, leaf.name, "a number that a float64 holds; it is rounded", str(value)[:60])
                )
            column.append(good)
        for count, path in enumerate(_unknown_paths(message, known, topic.long)):
            if count == _NEW:
                break
            result.wrong.append(Wrong(k, path_name(topic.name, path), None, ""))
    result.kept = np.array(kept, np.int64)
    for leaf, column in zip(topic.leaves, cells, strict=True):
        result.values[leaf.name], missing = as_array(column, leaf.dtype)
        if missing is not None:
            result.flags[leaf.name] = missing
    return result


def _flat(message: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """All values of a message that hold no others, with their paths."""
    if not _has_inner(message):
        yield path, message
    elif len(path) < MOST_DEPTH:
        inner = (
            ((str(k), v) for k, v in message.items())
            if isinstance(message, Mapping)
            else enumerate(message[:MOST_ELEMENTS])
        )
        for part, value in inner:
            yield from _flat(value, (*path, part))


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


def _has_inner(value: Any) -> bool:
    """Whether fields inside of a value are named by themselves."""
    return isinstance(value, Mapping | list) and len(value) > 0


def _unknown_paths(
    message: Any, known: set[Path] | frozenset[Path], long: frozenset[Path], path: Path = ()
) -> Iterator[Path]:
    """The paths of values that are none of the signals."""
    if len(path) >= MOST_DEPTH and isinstance(message, Mapping | list):
        return
    if isinstance(message, Mapping):
        for key, inner in message.items():
            yield from _unknown_paths(inner, known, long, (*path, str(key)))
    elif isinstance(message, list):
        for place, inner in enumerate(message[:MOST_ELEMENTS]):
            yield from _unknown_paths(inner, known, long, (*path, place))
        if len(message) > MOST_ELEMENTS and path not in long:
            yield (*path, MOST_ELEMENTS)
    elif message is not None and path not in known:
        yield path


def as_dtype(value: Any, dtype: str) -> Any:
    """A value of the signal's dtype; None where it is none (numbers among texts are written out)."""
    if value is None or isinstance(value, Mapping | list | bytes):
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
    if None not in cells:
        return np.array(cells, np.dtype(dtype)), None
    if dtype == "float64":
        return np.array([math.nan if c is None else c for c in cells], np.float64), None
    missing = np.array([c is None for c in cells], bool)
    values = np.array([0 if c is None else c for c in cells], np.dtype(dtype))
    return values, missing * MISSING if missing.any() else None
