"""JSON as it stands in messages: by the standard library, and a key that comes twice is an error, not a loss."""

from __future__ import annotations

import json
from typing import Any


def _with_distinct_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        twice = next(key for k, (key, _) in enumerate(pairs) if key in {other for other, _ in pairs[:k]})
        raise ValueError(f"the key {twice!r} comes twice")
    return found


_DECODER = json.JSONDecoder(object_pairs_hook=_with_distinct_keys)


def loads(payload: bytes) -> Any:
    """A payload as Python values. ValueError where it is no JSON or a key comes twice; RecursionError."""
    return _DECODER.decode(payload.decode("utf-8-sig"))
