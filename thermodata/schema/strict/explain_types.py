"""What pydantic says of a value of the wrong type, in the words of a person who writes the file."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

_WANTED = {
    "list_type": "a list: [..., ...]",
    "tuple_type": "a list: [..., ...]",
    "string_type": "a text",
    "float_type": "a number",
    "float_parsing": "a number",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "finite_number": "a finite number",
}
_MAPPINGS = frozenset({"dict_type", "model_type", "model_attributes_type", "dataclass_type"})
_BOUNDS = {
    "greater_than": ("gt", "above"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "below"),
    "less_than_equal": ("le", "at most"),
}


_COUNTED = {"too_long": "too many values", "too_short": "too few values"}


def missed(kind: str, expected: str) -> str | None:
    """What is wrong of such a value, in a few words; None where pydantic's message says it."""
    if expected.startswith("{"):
        return "no mapping"
    if expected.startswith("a "):
        return f"no {expected.partition(':')[0].removeprefix('a ')}"
    return _COUNTED.get(kind)


def right_value(kind: str, context: dict[str, Any], keys: Collection[str]) -> str | None:
    """What would be right in place of a value that pydantic refuses with an error of this kind; None where only its
    message tells. keys: those of the model that is meant, empty where any will do."""
    if kind in _MAPPINGS:
        return f"{{{', '.join(f'{k}: ...' for k in sorted(keys)) or 'key: value'}}}"
    if kind in ("too_long", "too_short"):
        most = context.get("max_length")
        return f"{most} values" if most is not None else f"{context.get('min_length')} values or more"
    if kind in _BOUNDS:
        bound, word = _BOUNDS[kind]
        return f"{word} {context.get(bound)}"
    return _WANTED.get(kind)
