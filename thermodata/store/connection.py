"""How this program speaks to DuckDB: the settings that hold on every connection, in 1.5 and 2.0 alike."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import StoreError

if TYPE_CHECKING:
    import duckdb
    import pyarrow as pa

STORAGE_VERSION = "v1.5.0"


def literal(text: str) -> str:
    """A SQL string literal."""
    return "'" + text.replace("'", "''") + "'"


def quoted(name: str) -> str:
    """A SQL identifier."""
    return '"' + name.replace('"', '""') + '"'


def memory(folder: Path) -> duckdb.DuckDBPyConnection:
    """An in-memory database that finds the store's Parquet files by their relative paths."""
    import duckdb

    con = duckdb.connect(":memory:")
    settle(con, folder)
    return con


def catalogue(folder: Path) -> duckdb.DuckDBPyConnection:
    """The catalogue opened for writing: only ever inside the turnstile. StoreError where it is damaged."""
    import duckdb

    path = folder / "catalog.duckdb"
    try:
        con = duckdb.connect(str(path))
    except duckdb.Error as error:
        raise damaged(path, error) from error
    settle(con, folder)
    return con


def create_catalogue(path: Path) -> None:
    """An empty catalogue file that DuckDB 1.5 and later open."""
    import duckdb

    con = duckdb.connect(":memory:")
    try:
        con.execute(f"attach {literal(str(path))} as made (storage_version {literal(STORAGE_VERSION)})")
        con.execute("detach made")
    finally:
        con.close()


def settle(con: duckdb.DuckDBPyConnection, folder: Path) -> None:
    """Global settings, for a cursor doesn't inherit those of its session."""
    if "," in str(folder):
        raise StoreError("a store's path holds no comma", where=str(folder),
                         hint="DuckDB separates search paths by commas: move or rename the folder")
    con.execute(f"set global file_search_path = {literal(str(folder))}")
    con.execute("set enable_progress_bar = false")
    # an ASOF join of a few probes falls back to a nested loop that takes 12-20 s instead of 20 ms
    known = con.execute("select 1 from duckdb_settings() where name = 'asof_loop_join_threshold'").fetchone()
    if known:
        con.execute("set global asof_loop_join_threshold = 0")


def damaged(path: Path, error: Exception) -> StoreError:
    """The refusal of a catalogue that DuckDB can't open."""
    text = str(error).strip().splitlines()[0]
    busy = "lock" in text.lower() or "being used" in text.lower()
    return StoreError(
        "the catalogue is open in another program" if busy else "the catalogue is damaged",
        where=str(path), expected="a DuckDB database of this program", got=text,
        hint="close the other program (for example a duckdb shell on catalog.duckdb)" if busy else
        "the Parquet files are unharmed: put a backup of catalog.duckdb back, or ingest into a new store")


def cursor_of(con: duckdb.DuckDBPyConnection) -> duckdb.DuckDBPyConnection:
    """Another session on the same database; the progress bar, which notebooks turn on, is a session's own."""
    cursor = con.cursor()
    cursor.execute("set enable_progress_bar = false")
    return cursor


def insert(con: duckdb.DuckDBPyConnection, table: str, rows: Iterable[Mapping[str, Any]], *,
           replace: bool = False) -> int:
    """Adds rows (column -> value) to a table in one statement; returns how many."""
    listed = list(rows)
    if not listed:
        return 0
    found = con.execute(f"select column_name, data_type from information_schema.columns where table_name = "
                        f"{literal(table)} and table_schema = 'main' order by ordinal_position").fetchall()
    types = dict(found)
    names = [name for name in types if name in listed[0]]
    data = _arrow(listed, names, types)
    con.register("incoming_rows", data)
    columns = ", ".join(quoted(n) for n in names)
    casts = ", ".join(f"cast({quoted(n)} as {types[n]})" for n in names)
    con.execute(f"insert {'or replace ' if replace else ''}into {table} ({columns}) select {casts} from incoming_rows")
    con.unregister("incoming_rows")
    return len(listed)


def _arrow(rows: list[Mapping[str, Any]], names: list[str], types: Mapping[str, str]) -> pa.Table:
    import pyarrow as pa

    plain = {"VARCHAR": pa.string(), "JSON": pa.string(), "BIGINT": pa.int64(), "INTEGER": pa.int32(),
             "DOUBLE": pa.float64(), "BOOLEAN": pa.bool_(), "TIMESTAMP": pa.timestamp("us"),
             "TIMESTAMP_NS": pa.timestamp("ns"), "DOUBLE[]": pa.list_(pa.float64()),
             "VARCHAR[]": pa.list_(pa.string())}
    return pa.table({n: pa.array([r.get(n) for r in rows], type=plain[types[n]]) for n in names})


def fetch(con: duckdb.DuckDBPyConnection, query: str, params: list[Any] | None = None) -> list[dict[str, Any]]:
    """All rows of a query as dictionaries."""
    cursor = con.execute(query, params) if params is not None else con.execute(query)
    names = [d[0] for d in cursor.description or ()]
    return [dict(zip(names, row, strict=True)) for row in cursor.fetchall()]
