"""The whole store as one DuckDB file that needs nothing beside it."""

from __future__ import annotations

import contextlib
import re
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import StoreError, UsageError
from thermodata.store.base import connection
from thermodata.store.base.files import TEMPORARY, publish, temporary, write_error
from thermodata.store.catalogue.format.ddl import TABLES
from thermodata.store.catalogue.store import Store

if TYPE_CHECKING:
    import duckdb

    from thermodata.store.views.catalogue import Catalogue

_GRACE_S = 3600.0
_TABLE = re.compile(r"create table (\w+)")


def snapshot(store: Store, out: Path | str) -> Path:
    """Writes tables, samples and predictions into the new file `out`; the same names answer the same queries.

    The wide views and `residual` become tables; all other views and macros stand on these. Raises UsageError
    where `out` exists. Memory stays bounded: DuckDB streams the Parquet files.
    """
    import duckdb

    from thermodata.store.views.catalogue import read_catalogue
    from thermodata.store.views.regenerate import statements
    from thermodata.store.views.wide import wide_name

    target = Path(out).absolute()
    if target.exists():
        raise UsageError("the file exists", where=str(target), hint="name another file or delete it first")
    target.parent.mkdir(parents=True, exist_ok=True)
    _sweep(target)
    part = temporary(target)
    con = store.private_copy()
    try:
        catalogue = read_catalogue(con)
        con.execute(
            f"attach {connection.literal(str(part))} as snap "
            f"(storage_version {connection.literal(connection.STORAGE_VERSION)})"
        )
        _copy_tables(con)
        as_tables = [*(connection.quoted(wide_name(group)) for group in catalogue.groups), "residual"]
        for name in as_tables:
            con.execute(f"create table snap.{name} as select * from memory.{name}")
        listed = list(statements(con, catalogue))
        con.execute("use snap")
        _make_views(con, catalogue, [s for s in listed if not _is_of(s, as_tables)])
        con.execute("use memory")
        connection.finish(con, "snap")
        publish(part, target)
    except duckdb.Error as error:
        raise _error_of_export(target, error, store) from error
    finally:
        con.close()
        connection.drop_database(part)
    return target


def _copy_tables(con: duckdb.DuckDBPyConnection) -> None:
    """The rows of all tables of the catalogue, into `snap`."""
    for statement in TABLES.split(";"):
        name = _TABLE.search(statement)
        if name is not None:
            con.execute(statement.replace(f"create table {name[1]}", f"create table snap.{name[1]}", 1))
            con.execute(f"insert into snap.{name[1]} by name select * from {name[1]}")


def _is_of(statement: str, views: Sequence[str]) -> bool:
    """Whether a statement makes one of these views, or tells what it is."""
    begun = statement.lstrip().lower()
    heads = ("create view", "comment on view")
    return any(begun.startswith(f"{head} {name.lower()}") for name in views for head in heads)


def _make_views(con: duckdb.DuckDBPyConnection, catalogue: Catalogue, made: Sequence[str]) -> None:
    """The other views and macros, on the tables of `snap`. made: the statements that make them in a store."""
    groups = {g.name: f"wide_{g.name}" for g in catalogue.groups}
    campaigns = {
        suffix: [g.name for g in catalogue.of(campaign) if g.columns]
        for campaign, suffix in catalogue.campaigns.items()
    }
    for statement in made:
        con.execute(_from_tables(statement, groups, campaigns))


def _sweep(target: Path) -> None:
    """Removes what snapshots under this name that were killed have left; one that still works writes to its file."""
    limit = time.time() - _GRACE_S
    for path in target.parent.iterdir():
        ours = path.name.startswith(f".{target.name}.") and TEMPORARY.match(path.name)
        with contextlib.suppress(OSError):  # another snapshot may sweep too
            if ours and path.is_file() and not path.is_symlink() and path.stat().st_mtime < limit:
                path.unlink()


def _error_of_export(target: Path, error: Exception, store: Store) -> StoreError:
    known = connection.damaged_data(store.path, error)
    if known is not None:
        return known
    with store.reader() as con:
        row = con.execute("select sum(bytes) from file where layer = 'tidy'").fetchone()
    # DuckDB's own format takes about twice as much as Parquet
    return write_error(target, error, f"about {2 * int((row and row[0]) or 0) / 1e6:,.0f} MB")


_READ = re.compile(r"read_parquet\((p__files(?:_(\d+))?), hive_partitioning = false\)")
_MACRO = re.compile(r'create macro "(signal|binned_grid|aligned_grid)_([^"]+)"')


def _from_tables(statement: str, groups: dict[str, str], campaigns: dict[str, list[str]]) -> str:
    """A macro that reads listed files, as one that reads the rows of those files from a wide table."""
    macro = _MACRO.match(statement)
    if macro is None:
        return statement

    def table(match: re.Match[str]) -> str:
        group = macro[2] if match[2] is None else campaigns[macro[2]][int(match[2])]
        # tests with equal content share a file; the rows of either serve
        return (
            f"(select * from {connection.quoted(groups[group])} where test = (select min(f.test) from file f "
            f"where f.layer = 'tidy' and list_contains({match[1]}, f.path)))"
        )

    return _READ.sub(table, statement)
