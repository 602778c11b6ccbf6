"""How this program speaks to DuckDB: the settings that hold on every connection, in 1.5 and 2.0 alike."""

from __future__ import annotations

import contextlib
import errno
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import StoreError
from thermodata.store.base.files import write_error
from thermodata.store.base.no_room import no_room

if TYPE_CHECKING:
    import duckdb

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


def attach(con: duckdb.DuckDBPyConnection, folder: Path) -> None:
    """Opens the catalogue for writing, in a `memory` connection that was made before: only ever inside the turnstile.
    StoreError where it is damaged."""
    import duckdb

    path = folder / "catalog.duckdb"
    try:
        con.execute(f"attach {literal(str(path))} as catalog; use catalog")
    except duckdb.Error as error:
        raise damaged(path, error) from error


def detach(con: duckdb.DuckDBPyConnection) -> None:
    """Closes the catalogue before the turn ends."""
    import duckdb

    try:
        con.execute("use memory; detach catalog")
    except duckdb.Error:  # no room to tidy up the file: what was committed is safe in the log beside it
        con.close()


def finish(con: duckdb.DuckDBPyConnection, name: str) -> None:
    """Writes a new, attached database into its file, whole, and closes it. duckdb.Error where there is no room: closing
    it alone says nothing, and leaves a file without tables beside a log that holds them."""
    con.execute(f"checkpoint {name}; detach {name}")


def drop_database(part: Path) -> None:
    """Deletes a database in the making, and its log."""
    for path in (part, part.with_name(part.name + ".wal")):
        path.unlink(missing_ok=True)


def settle(con: duckdb.DuckDBPyConnection, folder: Path) -> None:
    """Global settings, for a cursor doesn't inherit those of its session."""
    import duckdb

    con.execute(f"set global file_search_path = {literal(str(folder))}")
    con.execute("set enable_progress_bar = false")
    # nothing is ever fetched from elsewhere because a query names a function or a file of some kind
    con.execute("set global autoinstall_known_extensions = false; set global autoload_known_extensions = false")
    # an ASOF join of a few probes falls back to a nested loop that takes 12-20 s instead of 20 ms
    with contextlib.suppress(duckdb.CatalogException):  # a version that has no such loop
        con.execute("set global asof_loop_join_threshold = 0")


def damaged(path: Path, error: Exception) -> StoreError:
    """The refusal of a catalogue that DuckDB can't open."""
    text = str(error).strip().splitlines()[0]
    low = text.lower()
    if any(word in low for word in ("permission denied", "read-only file system")):
        return write_error(path, OSError(errno.EACCES, text))
    if no_room(error) is not None:
        return write_error(path, error)
    busy = any(word in low for word in ("lock on file", "being used", "different configuration", "handle conflict"))
    return StoreError(
        "the catalogue is open in another program" if busy else "the catalogue is damaged",
        where=str(path),
        expected="a DuckDB database of this program",
        got=text,
        hint="close the other program (for example a duckdb shell on catalog.duckdb)"
        if busy
        else "the Parquet files are unharmed: put a backup of catalog.duckdb back, or move the damaged one away and "
        "ingest the campaigns again (from their source files)",
    )


_HEADERS = ("don't know what type", "TProtocolException")  # of Parquet's headers, said without the file
_DAMAGE = ("damaged store:", "No magic bytes", "Parquet", ".parquet")


def damaged_data(folder: Path, error: Exception) -> StoreError | None:
    """The refusal of a query over a Parquet file that is gone, cut or altered; None for any other error."""
    text = str(error).strip().splitlines()[0]
    if text.startswith(_HEADERS):
        text = "a header within a Parquet file can't be read"
    elif not any(word in text for word in _DAMAGE) or ".parquet" not in text:
        return None
    problem, _, todo = text.partition("damaged store: ")[2].partition("; try: ")
    return damaged_file(folder, problem or text, todo)


def damaged_file(where: Path, got: str, todo: str = "") -> StoreError:
    """The refusal of a file of the store that is gone, cut or altered. todo: what to do, by default to make it anew."""
    return StoreError(
        "a file of the store is damaged",
        where=str(where),
        got=got,
        hint=(todo or "ingest the campaign again: what can be made anew is made anew")
        + "; 'thermodata check' lists what is damaged",
    )


def cursor_of(con: duckdb.DuckDBPyConnection) -> duckdb.DuckDBPyConnection:
    """Another session on the same database; the progress bar, which notebooks turn on, is a session's own."""
    cursor = con.cursor()
    cursor.execute("set enable_progress_bar = false")
    return cursor


def insert(con: duckdb.DuckDBPyConnection, table: str, rows: Iterable[Mapping[str, Any]]) -> int:
    """Adds rows (column -> value) to a table in one statement; returns how many. JSON columns take text.

    The rows travel as one JSON text: ten thousand take a tenth of a second, and no Arrow or pandas is loaded.
    """
    listed = list(rows)
    if not listed:
        return 0
    # a tenth of the time that information_schema takes
    table_columns = con.execute(f"pragma table_info({literal(table)})").fetchall()
    types = {name: kind for _, name, kind, *_ in table_columns if name in listed[0]}
    shape = {
        name: "VARCHAR"
        if kind in ("JSON", "TIMESTAMP", "TIMESTAMP_NS")
        else [kind.removesuffix("[]")]
        if kind.endswith("[]")
        else kind
        for name, kind in types.items()
    }
    text = json.dumps([{name: row.get(name) for name in types} for row in listed], default=str)
    columns = ", ".join(quoted(n) for n in types)
    casts = ", ".join(f"cast(r.{quoted(n)} as {kind})" for n, kind in types.items())
    con.execute(
        f"insert into {table} ({columns}) select {casts} from "
        f"(select unnest(from_json(cast(? as json), {literal(json.dumps([shape]))})) as r)",
        [text],
    )
    return len(listed)


def fetch(con: duckdb.DuckDBPyConnection, query: str, params: list[Any] | None = None) -> list[dict[str, Any]]:
    """All rows of a query as dictionaries."""
    cursor = con.execute(query, params) if params is not None else con.execute(query)
    names = [d[0] for d in cursor.description or ()]
    return [dict(zip(names, row, strict=True)) for row in cursor.fetchall()]
