"""A new store: its catalogue made whole under another name, and what a catalogue looks like that was never begun."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.store.base import connection
from thermodata.store.base.files import publish, temporary, write_text
from thermodata.store.base.moment import utc_now
from thermodata.store.catalogue.format.ddl import FORMAT, TABLES
from thermodata.version import __version__

if TYPE_CHECKING:
    import duckdb

CATALOGUE = "catalog.duckdb"
MARK = "generation"  # the file that changes with every commit
LAYERS = ("raw", "tidy", "model")
_EMPTY_BYTES = 3 * 4096  # a DuckDB file's headers; a table, or anything else that has a name, takes a block more


def create_catalogue(folder: Path) -> None:
    """Makes an empty store of a folder, in the exclusive turn. It is made under another name: a half-made catalogue is
    never taken for a store. StoreError where there is no room or no right, and the folder is as it was."""
    import duckdb

    part = temporary(folder / CATALOGUE)
    con = connection.memory(folder)
    try:
        con.execute(
            f"attach {connection.literal(str(part))} as made "
            f"(storage_version {connection.literal(connection.STORAGE_VERSION)}); use made"
        )
        con.execute("begin transaction")  # else each of 200 statements is one, and waits for the disk
        con.execute(TABLES)
        con.execute(
            "insert into store values (?, ?, ?, 0)",
            [FORMAT, f"thermodata {__version__}", utc_now()],
        )
        regenerate_views(con, folder)
        con.execute("commit; use memory")
        connection.finish(con, "made")
        for layer in LAYERS:
            (folder / layer).mkdir(exist_ok=True)
        write_text(folder / MARK, new_mark())
        publish(part, folder / CATALOGUE)
    except duckdb.Error as error:
        raise connection.damaged(folder / CATALOGUE, error) from error
    finally:
        con.close()
        connection.drop_database(part)


def not_begun(folder: Path) -> bool:
    """Whether a store's catalogue is a DuckDB file without tables, and no file of data stands beside it: a creation
    that found no room. Nothing is lost where such a catalogue is made anew."""
    import duckdb

    path = folder / CATALOGUE
    try:
        empty = path.stat().st_size == _EMPTY_BYTES
    except OSError:
        return False
    if not empty or path.with_name(f"{CATALOGUE}.wal").exists() or any(_data(folder)):
        return False
    con = connection.memory(folder)
    try:
        con.execute(f"attach {connection.literal(str(path))} as kept (read_only)")
        named = con.execute("select count(*) from duckdb_tables() where database_name = 'kept'").fetchone()
    except duckdb.Error:  # not of DuckDB, or in use
        return False
    finally:
        con.close()
    return bool(named == (0,))


def _data(folder: Path) -> list[Path]:
    return [path for layer in LAYERS for path in (folder / layer).rglob("*.parquet")]


def new_mark() -> str:
    """The mark of a commit that is to be."""
    return secrets.token_hex(8)


def regenerate_views(con: duckdb.DuckDBPyConnection, folder: Path) -> None:
    """Makes all views and macros anew from the tables."""
    from thermodata.store.views.regenerate import regenerate  # only who writes needs them

    regenerate(con, folder)
