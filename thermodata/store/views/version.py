"""Which views a store has: those of this program, or those that another version made."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import duckdb

# to be raised with every change of what a view or macro shows: whoever opens a store of another number gets ours
VIEWS = 13
MACRO = f"create macro views_version() as {VIEWS}"


def of_this_version(con: duckdb.DuckDBPyConnection) -> bool:
    """Whether the views of the current database are those that this program makes."""
    import duckdb

    try:
        row = con.execute("select views_version()").fetchone()
    except duckdb.CatalogException:  # made before they were counted
        return False
    return row is not None and row[0] == VIEWS
