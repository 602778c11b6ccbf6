"""Runs the statements: what stood there goes, what the catalogue gives comes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import StoreError
from thermodata.store.connection import literal, quoted
from thermodata.store.views.catalogue import Catalogue, read_catalogue
from thermodata.store.views.dispatch import lookup_macros
from thermodata.store.views.grid import grid_macros
from thermodata.store.views.long import long_views, signal_macros
from thermodata.store.views.result import result_views
from thermodata.store.views.wide import wide_views

if TYPE_CHECKING:
    import duckdb

_TABLE_COMMENTS = {
    "test": {"start_ns": "[ns] UTC since 1970, NULL for relative clocks", "duration_s": "[s]",
             "window_s": "[s] from the start of the recording", "zero_s": "[s]",
             "phases": "[s] from the start of the test"},
    "source": {"start_ns": "[ns] UTC since 1970", "step_s": "[s] median period",
               "offset_ns": "[ns] added to its times"},
    "channel": {"unit": "of the tidy layer", "raw_unit": "of the raw layer",
                "sign": "+ where positive is the tool centre point along the machine's + axis relative to the table"},
    "quality_event": {"from_s": "[s] from the start of the test", "to_s": "[s] from the start of the test"},
    "calibration": {"gain": "in gain_unit", "uncertainty_pct": "[%]", "noise_um": "[um]", "nonlinearity_pct": "[%]",
                    "drift_um": "[um]"},
}


def make(con: duckdb.DuckDBPyConnection, store: str | None) -> None:
    """Drops and creates all views and macros. StoreError where a listed Parquet file is gone."""
    import duckdb

    try:
        for statement in _dropped(con):
            con.execute(statement)
        folder = None if store is None else Path(store)
        catalogue = read_catalogue(con, folder)
        for statement in statements(con, catalogue, folder):
            con.execute(statement)
    except duckdb.IOException as error:
        raise StoreError(
            "a Parquet file that the catalogue lists can't be read", where=store,
            got=str(error).strip().splitlines()[0],
            hint="put the file back, or forget its test and ingest it again") from error


def statements(con: duckdb.DuckDBPyConnection, catalogue: Catalogue, folder: Path | None = None) -> Iterator[str]:
    """Everything to create, in an order in which each finds what it refers to."""
    tests: dict[str, list[str]] = {}
    for campaign, test in con.execute("select campaign, test from test union select campaign, test from file "
                                      "where part = 'test' and test <> '' order by all").fetchall():
        tests.setdefault(campaign, []).append(test)
    yield from wide_views(catalogue)
    yield from long_views(catalogue)
    yield from lookup_macros(catalogue, tests)
    yield from signal_macros(catalogue)
    yield from grid_macros(catalogue)
    yield from result_views(con, folder)
    for table, columns in _TABLE_COMMENTS.items():
        for column, comment in columns.items():
            yield f"comment on column {table}.{column} is {literal(comment)}"


def _dropped(con: duckdb.DuckDBPyConnection) -> list[str]:
    here = "not internal and database_name = current_database() and schema_name = current_schema()"
    views = con.execute(f"select view_name from duckdb_views() where {here}").fetchall()
    macros = con.execute("select distinct function_name, function_type from duckdb_functions() "
                         f"where {here} and function_type in ('macro', 'table_macro')").fetchall()
    return ([f"drop view if exists {quoted(name)}" for (name,) in views]
            + [f"drop macro{' table' if kind == 'table_macro' else ''} if exists {quoted(name)}"
               for name, kind in macros])
