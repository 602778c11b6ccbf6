"""The views and macros over the store's tables and Parquet files (docs/architecture.md#tables-and-views).

All of them are made anew from the catalogue's tables in the transaction of a commit. Views name their files
one by one: a glob would show files that were never committed.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import duckdb

__all__ = ["regenerate"]


def regenerate(con: duckdb.DuckDBPyConnection, store_path: Path | str | None = None) -> None:
    """Drops and creates all views and macros, inside the caller's transaction.

    con: a connection whose `file_search_path` is the store's folder (store.connection.settle), or none of whose
    tidy files exist yet. store_path: the folder, to find files that are gone or cut: who reads their
    views gets an error, the others work.
    """
    from thermodata.store.views.make import make

    make(con, None if store_path is None else str(store_path))
