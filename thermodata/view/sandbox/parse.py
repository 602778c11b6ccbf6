"""What is asked is one SELECT over the store: found out from DuckDB's own syntax tree, never from the text."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError
from thermodata.view.query.reserved import reserved_hint

if TYPE_CHECKING:
    import duckdb

# beside the store's own macros: what makes rows of nothing, and what describes tables
_MAKE_ROWS = frozenset({"range", "generate_series", "unnest", "duckdb_columns", "duckdb_tables", "duckdb_views"})
_NODES = frozenset({"SELECT_NODE", "SET_OPERATION_NODE", "CTE_NODE", "RECURSIVE_CTE_NODE"})
# scalars that look beyond the tables, or change what a session is
_FOREIGN = (
    "read_",
    "write_",
    "getenv",
    "current_setting",
    "set_config",
    "getvariable",
    "nextval",
    "sniff_",
    "parquet_",
    "sleep",
)
_SETTINGS = frozenset({"pg_settings", "duckdb_settings", "duckdb_secrets"})  # as tables; as functions they are foreign


def check_select(con: duckdb.DuckDBPyConnection, query: str) -> None:
    """UsageError where a query is anything but one SELECT over tables, views and macros of the store, with the part
    of it that is refused. con: of the copy that will be asked; nothing is run on it but the parser."""
    import duckdb

    try:
        statements = con.extract_statements(query)
    except duckdb.Error as error:
        raise UsageError("the query can't be read", got=str(error).strip(), hint=reserved_hint(query)) from error
    if len(statements) != 1 or statements[0].type.name != "SELECT":
        got = ", ".join(s.type.name for s in statements) or "nothing"
        raise _refusal(query, "one SELECT", got)
    row = con.execute("select json_serialize_sql(?)", [statements[0].query]).fetchone()
    tree = json.loads(row[0]) if row else {"error": True}
    if tree.get("error"):
        raise _refusal(query, "one SELECT", str(tree.get("error_message", "something else")))
    own = {
        name for (name,) in con.execute("select function_name from duckdb_functions() where not internal").fetchall()
    }
    for node in _nodes_of(tree["statements"]):
        kind = str(node.get("type", ""))
        if kind.endswith("_NODE") and kind not in _NODES:
            raise _refusal(query, "one SELECT", kind.removesuffix("_NODE"))
        name = str(node.get("function_name", "")).lower()
        if kind == "TABLE_FUNCTION":
            called = str(node["function"].get("function_name", "")).lower()
            if called not in _MAKE_ROWS and called not in own:
                raise _refusal(query, "tables, views and macros of the store", f"{called}(...)")
        elif kind == "BASE_TABLE" and str(node.get("table_name", "")).lower() in _SETTINGS:
            raise _refusal(query, "tables, views and macros of the store", str(node["table_name"]))
        elif name.startswith(_FOREIGN):
            raise _refusal(query, "functions of values", f"{name}(...)")


def _nodes_of(value: Any) -> Iterator[dict[str, Any]]:
    todo = [value]
    while todo:  # a query may be nested deeper than Python's stack
        part = todo.pop()
        if isinstance(part, dict):
            yield part
            todo.extend(part.values())
        elif isinstance(part, list):
            todo.extend(part)


def _refusal(query: str, expected: str, got: str) -> UsageError:
    return UsageError(
        "this query is not run here",
        where=query.strip()[:200],
        expected=expected,
        got=got,
        hint="SELECT ... FROM a table or view of the store; thermodata sql in a terminal can also COPY ... TO a file",
    )
