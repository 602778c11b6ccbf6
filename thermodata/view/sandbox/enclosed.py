"""A copy of a store's catalogue that reads the store's own Parquet files, and can do nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.store.base.connection import literal
from thermodata.store.catalogue.format.create import regenerate_views
from thermodata.store.views.wide import file_list

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store


def enclosed(store: Store, memory_mb: int) -> duckdb.DuckDBPyConnection:
    """The caller closes it. memory_mb: that DuckDB may hold; nothing is spilled to a disk.

    Views name their files absolutely, for a relative path is looked for along search paths, which a connection
    without access to files can't do; what may be opened is exactly the files that the catalogue lists.
    """
    con = store.private_copy()
    root = f"{store.path}/"
    con.execute("begin transaction")
    for table in ("file", "prediction"):
        con.execute(f"update {table} set path = ? || path", [root])
    regenerate_views(con, store.path)
    con.execute("commit")
    listed = con.execute(
        "select distinct path from file where layer = 'tidy' union select distinct path from prediction"
    ).fetchall()
    con.execute(f"set allowed_paths = {file_list(path for (path,) in listed)}")
    for setting in (
        "temp_directory = ''",
        f"memory_limit = {literal(f'{memory_mb}MB')}",
        "threads = 1",
        "allow_community_extensions = false",
        "allow_persistent_secrets = false",
        "enable_external_access = false",
        "lock_configuration = true",
    ):
        con.execute(f"set {setting}")
    return con
