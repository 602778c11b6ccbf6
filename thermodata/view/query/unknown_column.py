"""A column that no table of a query has: what these have, which DuckDB's few candidates hide."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import duckdb

_UNKNOWN = re.compile(r'Referenced column "[^"]+" not found|does not have a column named')
_WORD = re.compile(r"\w+")


def unknown_column_hint(con: duckdb.DuckDBPyConnection, query: str, error: duckdb.Error) -> str | None:
    """How the columns of the query's tables and views are listed, and under what name a row's own name stands; None for
    another error."""
    if not _UNKNOWN.search(str(error)):
        return None
    words = dict.fromkeys(word.lower() for word in _WORD.findall(query))
    found = con.execute(
        "select table_name, bool_or(column_name = table_name) from duckdb_columns() "
        "where list_contains(?, table_name) and not internal group by 1",
        [list(words)],
    ).fetchall()
    named = dict(found)
    tables = [word for word in words if word in named]
    if not tables:
        return None
    own = [f"{table}.{table} is its name" for table in tables if named[table]]
    return "; ".join([*own, *(f'thermodata sql "describe {table}" lists its columns' for table in tables)])
