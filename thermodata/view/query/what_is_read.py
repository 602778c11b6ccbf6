"""Which samples a query takes from the long views, as far as its text says: which view, and which campaigns, tests and
channels a condition of it holds each to."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import duckdb

KEYS = ("campaign", "test", "channel")


@dataclass(frozen=True, slots=True)
class Read:
    """only: of these keys these values alone; nothing is said of the others."""

    view: str
    only: Mapping[str, frozenset[str]] = field(default_factory=dict)


def what_is_read(con: duckdb.DuckDBPyConnection, query: str, views: frozenset[str]) -> list[Read] | None:
    """Each place where a query takes one of the views; None where its text can't be taken apart."""
    import duckdb

    try:
        row = con.execute("select json_serialize_sql(?::varchar)", [query]).fetchone()
    except duckdb.Error:
        return None
    tree = json.loads(row[0]) if row else {"error": True}
    return None if tree.get("error") else list(_reads(tree, {}, views))


def _reads(tree: Any, only: Mapping[str, frozenset[str]], views: frozenset[str]) -> Iterator[Read]:
    """only: what a condition holds the table to that the tree is."""
    if isinstance(tree, list):
        for part in tree:
            yield from _reads(part, {}, views)
    if not isinstance(tree, dict):
        return
    name = tree.get("function_name" if tree.get("type") == "FUNCTION" else "table_name")
    if name in views and tree.get("type") == "BASE_TABLE":
        yield Read(str(name), only)
    elif name in views:  # a macro is asked with the keys in their order
        asked = zip(KEYS, map(_text, _arguments(tree)), strict=False)
        yield Read(str(name), {key: frozenset([text]) for key, text in asked if text is not None})
    for key, part in tree.items():
        # of several tables a condition may be of any
        own = _keys_held(tree.get("where_clause")) if key == "from_table" and _is_table(part) else {}
        yield from _reads(part, own, views)


def _is_table(tree: Any) -> bool:
    return isinstance(tree, dict) and tree.get("type") == "BASE_TABLE"


def _keys_held(condition: Any) -> dict[str, frozenset[str]]:
    """What must hold of the keys, by equality or by a list."""
    if not isinstance(condition, dict):
        return {}
    if condition.get("type") == "CONJUNCTION_AND":
        found: dict[str, frozenset[str]] = {}
        for part in condition.get("children", ()):
            for key, values in _keys_held(part).items():
                found[key] = found.get(key, values) & values
        return found
    if condition.get("type") == "COMPARE_EQUAL":
        sides = [condition.get("left"), condition.get("right")]
    elif condition.get("type") == "COMPARE_IN":
        sides = [*condition.get("children", ())]
    else:
        return {}
    columns, texts = [c for s in sides if (c := _column(s))], [v for s in sides if (v := _text(s)) is not None]
    known = len(columns) == 1 and columns[0] in KEYS and len(texts) == len(sides) - 1
    return {columns[0]: frozenset(texts)} if known else {}


def _column(tree: Any) -> str | None:
    names = tree.get("column_names") if isinstance(tree, dict) else None
    return str(names[-1]).lower() if names else None


def _text(tree: Any) -> str | None:
    """A text that stands in the query. Versions of DuckDB differ in what they call it."""
    if not isinstance(tree, dict) or tree.get("class") != "CONSTANT":
        return None
    value = tree.get("literal", tree.get("value"))
    text = value.get("text", value.get("value")) if isinstance(value, dict) else None
    return text if isinstance(text, str) else None


def _arguments(tree: Mapping[str, Any]) -> list[Any]:
    given = tree.get("arguments", tree.get("children", ()))
    return [one.get("expression", one) for one in given if isinstance(one, dict)]
