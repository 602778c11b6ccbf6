"""What a field of a protobuf message is, by its descriptor."""

from __future__ import annotations

from typing import Any


def is_map(f: Any) -> bool:
    """Whether a field is a map: stored as repeated pairs."""
    return f.message_type is not None and bool(f.message_type.GetOptions().map_entry)


def is_repeated(f: Any) -> bool:
    """Whether a field is an array (or a map)."""
    repeated = getattr(f, "is_repeated", None)
    return bool(repeated) if repeated is not None else f.label == f.LABEL_REPEATED
