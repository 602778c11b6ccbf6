"""The signals of a topic: the leaves of its messages, each with a path, a name and one dtype."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

MOST_ELEMENTS = 256      # of an array; a longer one is an image or a point cloud, no set of signals
_EXACT = 2**53
Path = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Leaf:
    """One signal. path: keys and places of arrays. dtype: float64, int64, uint64, bool or str."""

    path: Path
    name: str
    dtype: str


@dataclass(slots=True)
class _Seen:
    count: int = 0
    nulls: int = 0
    bools: int = 0
    integers: int = 0
    floats: int = 0
    texts: int = 0
    low: int = 0
    high: int = 0


def path_name(topic: str, path: Path) -> str:
    """'/axis' and ('pos', 0, 'z') give '/axis.pos[0].z'."""
    return topic + "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in path)


def find_leaves(topic: str, messages: Iterable[Any], schema: Any, exact: bool) -> tuple[tuple[Leaf, ...], list[str]]:
    """The leaves of sampled messages (Python values), and notes. schema: a JSON Schema, or None.

    exact: the messages are all of the topic. Whole numbers of a sampled topic become int64 only where the schema
    says so or a float64 would change them; else float64, for a fraction may follow.
    """
    seen: dict[Path, _Seen] = {}
    long: dict[Path, int] = {}
    total = 0
    for message in messages:
        total += 1
        _visit(message, (), seen, long)
    notes = [f"{path_name(topic, path)} holds arrays of up to {n} elements; the first {MOST_ELEMENTS} are read"
             for path, n in long.items()]
    leaves, names = [], set()
    for path, each in seen.items():
        if any(other[:len(path)] == path and len(other) > len(path) for other in seen) and not _scalars(each):
            continue                                   # null or empty here, an object elsewhere
        name = path_name(topic, path)
        while name in names:
            name += "#2"
        names.add(name)
        leaves.append(Leaf(path, name, _dtype(each, total, _declared(schema, path), exact)))
    return _one_type_an_array(leaves), notes


def _one_type_an_array(leaves: list[Leaf]) -> tuple[Leaf, ...]:
    """Numbers at one place of an array's elements share a dtype: [1, 2.5] is float64."""
    kinds: dict[Path, set[str]] = {}
    for leaf in leaves:
        kinds.setdefault(_anywhere(leaf.path), set()).add(leaf.dtype)
    return tuple(
        replace(leaf, dtype="float64") if len(k := kinds[_anywhere(leaf.path)]) > 1
        and k <= {"int64", "uint64", "float64"} else leaf for leaf in leaves)


def _anywhere(path: Path) -> Path:
    return tuple(0 if isinstance(part, int) else part for part in path)


def _scalars(each: _Seen) -> int:
    return each.bools + each.integers + each.floats + each.texts


def _visit(value: Any, path: Path, seen: dict[Path, _Seen], long: dict[Path, int]) -> None:
    kind = type(value)
    if kind is dict:
        for key, inner in value.items():
            _visit(inner, (*path, str(key)), seen, long)
        return
    if kind is list:
        if len(value) > MOST_ELEMENTS:
            long[path] = max(long.get(path, 0), len(value))
        for place, inner in enumerate(value[:MOST_ELEMENTS]):
            _visit(inner, (*path, place), seen, long)
        return
    each = seen.get(path)
    if each is None:
        each = seen.setdefault(path, _Seen())
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


def _dtype(each: _Seen, total: int, declared: str | None, exact: bool) -> str:
    numbers = each.integers + each.floats
    kinds = (each.bools > 0) + (numbers > 0) + (each.texts > 0)
    if kinds == 0:
        return {"string": "str", "boolean": "bool", "integer": "int64"}.get(declared or "", "float64")
    if kinds > 1:
        # a few words among numbers ("ERROR") are defects; a real mixture is text
        return "float64" if numbers >= 0.9 * (each.count - each.nulls) else "str"
    if each.texts:
        return "str"
    if each.bools:
        return "bool"
    if each.floats or each.high >= 2**64 or each.low < -(2**63) or (each.high >= 2**63 and each.low < 0):
        return "float64"
    whole = "uint64" if each.high >= 2**63 else "int64"
    if max(each.high, -each.low) > _EXACT or declared == "integer":
        return whole
    always = each.count == total and not each.nulls
    return whole if exact and always and declared != "number" else "float64"


def _declared(schema: Any, path: Path) -> str | None:
    """The type that a JSON Schema gives a path; None where it says nothing."""
    for part in path:
        if not isinstance(schema, Mapping):
            return None
        if isinstance(part, int):
            schema = schema.get("items")
            continue
        properties = schema.get("properties")
        schema = properties.get(part) if isinstance(properties, Mapping) else None
    kind = schema.get("type") if isinstance(schema, Mapping) else None
    if isinstance(kind, list):
        kind = next((k for k in kind if k != "null"), None)
    return kind if isinstance(kind, str) else None


def json_schema(data: bytes) -> Any:
    """A channel's JSON Schema; None where it has none that reads."""
    try:
        return json.loads(data) if data.strip() else None
    except (ValueError, RecursionError):
        return None
