"""The store's format: newer ones are refused, older ones are brought up after a backup."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import StoreError
from thermodata.store.base import connection
from thermodata.store.base.files import publish, temporary
from thermodata.store.catalogue.format.ddl import FORMAT

if TYPE_CHECKING:
    import duckdb

# format -> the SQL that makes the next one of it
STEPS: dict[int, str] = {
    1: "-- model.result and finding.payload have more keys from here on: what stands there is read as it is",
    2: "-- the same, and a campaign may leave out a quantity that its unit says; answers hold errors of whole models",
    3: "-- the same: an answer says how probable it is that nothing logged reads what is missing",
    4: "-- the same: what the model as it is fitted leaves on locked tests; why claims stand; tests lost or not asked",
    5: "-- the same: how many tests are locked; how sure the heat of two parts is",
    6: "-- the same: effects whose gain the tests do not determine, how many open tests took part",
}


def check_format(con: duckdb.DuckDBPyConnection, path: Path, prefix: str = "") -> int:
    """The store's format; StoreError where it is newer than this program, or where it is no store at all."""
    import duckdb

    try:
        row = con.execute(f"select format, created_by from {prefix}store").fetchone()
    except duckdb.CatalogException:
        row = None
    if row is None:
        raise StoreError(
            "this database is not a store",
            where=str(path),
            expected="a table 'store' with one row",
            got="none",
            hint="name the folder of a store with --store, or a new folder",
        )
    version, made_by = int(row[0]), str(row[1])
    if version > FORMAT:
        raise StoreError(
            "the store was written by a newer version",
            where=str(path),
            expected=f"store format {FORMAT} or older",
            got=f"format {version}, made by {made_by}",
            hint=f"install a thermodata that knows store format {version}",
        )
    return version


def migrate(con: duckdb.DuckDBPyConnection, folder: Path) -> None:
    """Brings an older catalogue, attached to `con`, to this format, keeping the old file beside it."""
    version = check_format(con, folder)
    if version == FORMAT:
        return
    missing = [v for v in range(version, FORMAT) if v not in STEPS]
    if missing:
        raise StoreError(
            "the store's format is too old",
            where=str(folder),
            got=f"format {version}",
            expected=f"format {FORMAT}",
            hint="ingest the campaigns into a new store",
        )
    # detached first: a copy through another descriptor would drop DuckDB's lock on the open file
    connection.detach(con)
    _backup(folder / "catalog.duckdb", folder / f"catalog.format{version}.duckdb.backup")
    connection.attach(con, folder)
    con.execute("begin transaction")
    for step in range(version, FORMAT):
        con.execute(STEPS[step])
    con.execute(f"update store set format = {FORMAT}")
    con.execute("commit")


def _backup(catalogue: Path, target: Path) -> None:
    """A copy that is whole or isn't there; one that an interrupted migration has left is made anew."""
    part = temporary(target)
    try:
        shutil.copyfile(catalogue, part)
        publish(part, target)
    except OSError as error:
        raise StoreError(
            "the backup before the migration cannot be written",
            where=str(target),
            got=str(error),
            expected=f"{catalogue.stat().st_size} bytes free",
            hint="free space; the store is as it was",
        ) from error
    finally:
        part.unlink(missing_ok=True)
