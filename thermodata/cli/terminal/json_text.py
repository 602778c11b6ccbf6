"""An answer as indented JSON, written piece by piece: a file may have 100,000 channels."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterator, Mapping
from decimal import Decimal
from functools import cache
from itertools import islice
from typing import Any

_INDENT = 2
_PIECES = 4096  # joined to one that is written at once


def plain(value: Any) -> Any:
    """Any result as JSON can hold it: models and dataclasses as mappings, NaN and infinity as null."""
    opened = _as_json_value(value)
    if isinstance(opened, dict):
        return {k: plain(v) for k, v in opened.items()}
    if isinstance(opened, list):
        return [plain(v) for v in opened]
    return opened


def json_text(value: Any) -> Iterator[str]:
    """`plain(value)` as `json.dumps` writes it with an indent of two, in pieces of bounded size."""
    pieces = _pieces_of(value, 0)
    while piece := "".join(islice(pieces, _PIECES)):
        yield piece


def _as_json_value(value: Any) -> Any:
    """A value without what JSON does not know on its outermost level: a scalar, or a dict or list of any values."""
    if isinstance(value, float | Decimal):
        return float(value) if math.isfinite(value) else None
    if value is None or isinstance(value, str | int | bool):
        return value
    if hasattr(value, "model_dump"):
        return _as_json_value(value.model_dump(mode="json", by_alias=True))
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(k): v for k, v in value.items()}
    if hasattr(value, "tolist"):  # numpy scalars and arrays
        return _as_json_value(value.tolist())
    if isinstance(value, list | tuple | set | frozenset):
        return list(value)
    if hasattr(value, "isoformat"):  # times; what is no time (NaT) differs from itself
        return value.isoformat() if value == value else None
    return str(value)


def _pieces_of(value: Any, depth: int) -> Iterator[str]:
    opened = value if type(value) in (dict, list) else _as_json_value(value)
    if type(opened) not in (dict, list) or not opened:
        yield _encoder(depth).encode(opened)
        return
    inner, outer = "\n" + " " * (_INDENT * (depth + 1)), "\n" + " " * (_INDENT * depth)
    named = isinstance(opened, dict)
    before, end = "{}" if named else "[]"
    if _is_flat(opened):
        # in one go: the encoder in C knows no indent, but writes what is asked between items
        text = _encoder(depth + 1).encode(opened)
        yield f"{before}{inner}{text[1:-1]}{outer}{end}"
        return
    for k, v in opened.items() if named else enumerate(opened):
        yield f"{before}{inner}{_encoder(0).encode(str(k))}: " if named else before + inner
        yield from _pieces_of(v, depth + 1)
        before = ","
    yield outer + end


def _is_flat(opened: dict[Any, Any] | list[Any]) -> bool:
    """Whether the encoder can write it alone: nothing is nested, and all is what JSON knows."""
    named = isinstance(opened, dict)
    if named and any(type(k) is not str for k in opened):
        return False
    for v in opened.values() if isinstance(opened, dict) else opened:
        kind = type(v)
        if kind is float:
            if not math.isfinite(v):
                return False
        elif kind not in _SCALARS and not (kind in (dict, list) and not v):
            return False
    return True


_SCALARS = frozenset((str, int, bool, type(None)))


@cache
def _encoder(depth: int) -> json.JSONEncoder:
    """Writes a line an item, as far in as the items of this depth stand."""
    return json.JSONEncoder(
        ensure_ascii=False,
        allow_nan=False,
        check_circular=False,
        separators=(",\n" + " " * (_INDENT * depth), ": "),
    )
