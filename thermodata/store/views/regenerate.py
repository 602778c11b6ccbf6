"""Runs the statements: what the catalogue gives comes, what it no longer gives goes, what is right already stays.

To make all of them takes 60 ms and more, and a commit changes a few: so the view `made_from` keeps a digest of the
statements that made each.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import StoreError
from thermodata.store.base.connection import literal, quoted
from thermodata.store.views.catalogue import Catalogue, read_catalogue
from thermodata.store.views.dispatch import lookup_macros
from thermodata.store.views.grid import grid_macros
from thermodata.store.views.long import long_views, signal_macros
from thermodata.store.views.result import SCORE_COMMENTS, result_views
from thermodata.store.views.version import MACRO
from thermodata.store.views.wide import wide_views

if TYPE_CHECKING:
    import duckdb

_TABLE_COMMENTS = {
    "test": {
        "start_ns": "[ns] UTC since 1970, NULL for relative clocks",
        "start": "UTC",
        "duration_s": "[s]",
        "window_s": "[s] from the start of the recording",
        "zero_s": "[s]",
        "phases": "[s] from the start of the test",
    },
    "source": {
        "start_ns": "[ns] UTC since 1970",
        "step_s": "[s] median period",
        "offset_ns": "[ns] added to its times",
    },
    "channel": {
        "unit": "of the tidy layer",
        "raw_unit": "of the raw layer",
        "sign": "+ where positive is the tool centre point along the machine's + axis relative to the table",
    },
    "quality_event": {"from_s": "[s] from the start of the test", "to_s": "[s] from the start of the test"},
    "calibration": {
        "gain": "in gain_unit",
        "offset_value": "in the unit of the value, which is the first of gain_unit; value = gain * reading + offset",
        "uncertainty_pct": "[%]",
        "noise_um": "[um]",
        "nonlinearity_pct": "[%]",
        "drift_um": "[um]",
        "checks": "rows of name, value, threshold, passed, advice; which way each limit goes is told by 'calibrations'",
    },
    "fit": {
        "value": "in fit.unit",
        "low": "in fit.unit; lower end of the interval of 95 %",
        "high": "in fit.unit; upper end of the interval of 95 %",
    },
    "score_row": SCORE_COMMENTS,
}

_MADE = "made_from"
_HERE = "not internal and database_name = current_database() and schema_name = current_schema()"


def regenerate(con: duckdb.DuckDBPyConnection, folder: Path | None) -> None:
    """Brings all views and macros to what the tables say, inside the caller's transaction: those whose text is another
    are made anew, those that are no more are dropped. StoreError where a listed Parquet file can't be read.

    con: a connection whose `file_search_path` is the store's folder (`connection.settle`), or none of whose tidy files
    exist yet. folder: the store's, to find files that are gone or cut: who reads their views gets an error, the others
    work.
    """
    import duckdb

    try:
        wanted = _by_object(statements(con, read_catalogue(con, folder), folder))
        known = _digests_of_made(con)
        todo = _dropped(con) if known is None else [_drop_statement(name) for name in known if name not in wanted]
        digests = {name: _digest(texts) for name, texts in wanted.items()}
        for name, texts in wanted.items():
            if known is None or known.get(name) != digests[name]:
                todo += [
                    text.replace("create ", "create or replace ", 1) if text.startswith("create ") else text
                    for text in texts
                ]
        if known != digests:
            rows = ", ".join(f"({literal(name)}, {literal(digest)})" for name, digest in digests.items())
            todo.append(f"create or replace view {_MADE} as select * from (values {rows}) v(object, digest)")
            con.execute(";\n".join(todo))
    except duckdb.IOException as error:
        raise StoreError(
            "a Parquet file that the catalogue lists can't be read",
            where=None if folder is None else str(folder),
            got=str(error).strip().splitlines()[0],
            hint="put the file back, or forget its test and ingest it again",
        ) from error


def statements(con: duckdb.DuckDBPyConnection, catalogue: Catalogue, folder: Path | None = None) -> Iterator[str]:
    """Everything to create, in an order in which each finds what it refers to."""
    tests: dict[str, list[str]] = {}
    for campaign, test in con.execute(
        "select campaign, test from test union select campaign, test from file "
        "where part = 'test' and test <> '' order by all"
    ).fetchall():
        tests.setdefault(campaign, []).append(test)
    yield MACRO
    yield from wide_views(catalogue)
    yield from long_views(catalogue)
    yield from lookup_macros(catalogue, tests)
    yield from signal_macros(catalogue)
    yield from grid_macros(catalogue)
    yield from result_views(con, folder)
    for table, columns in _TABLE_COMMENTS.items():
        for column, comment in columns.items():
            yield f"comment on column {table}.{column} is {literal(comment)}"


# what a statement makes or describes
_OBJECT = re.compile(r'(create (?:view|macro)|comment on (?:view|column)) ("[^"]+"|\w+)(\(.*?\) as table )?')


def _by_object(texts: Iterable[str]) -> dict[str, list[str]]:
    """The statements of each object ("view x", "macro x", "macro table x"; "comment on x" for a table's): what
    makes it, and its comments. Objects in the order in which they are made."""
    by_object: dict[str, list[str]] = {}
    views: set[str] = set()
    for text in texts:
        match = _OBJECT.match(text)
        assert match is not None, text[:80]
        what, name = match[1], match[2].strip('"')
        if what == "create view":
            views.add(name)
        kind = (
            ("macro table" if match[3] else "macro")
            if what == "create macro"
            else "view"
            if name in views
            else "comment on"
        )
        by_object.setdefault(f"{kind} {name}", []).append(text)
    return by_object


def _digest(texts: list[str]) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


def _digests_of_made(con: duckdb.DuckDBPyConnection) -> dict[str, str] | None:
    """Object -> digest of the statements that made it, of those that are there; None where nobody has kept them."""
    views = {name for (name,) in con.execute(f"select view_name from duckdb_views() where {_HERE}").fetchall()}
    if _MADE not in views:
        return None
    kept = con.execute(f"select object, digest from {_MADE}").fetchall()
    return {name: digest for name, digest in kept if not name.startswith("view ") or name[5:] in views}


def _drop_statement(name: str) -> str:
    kind, _, bare = name.rpartition(" ")
    return "select 1" if kind == "comment on" else f"drop {kind} if exists {quoted(bare)}"


def _dropped(con: duckdb.DuckDBPyConnection) -> list[str]:
    views = con.execute(f"select view_name from duckdb_views() where {_HERE}").fetchall()
    macros = con.execute(
        "select distinct function_name, function_type from duckdb_functions() "
        f"where {_HERE} and function_type in ('macro', 'table_macro')"
    ).fetchall()
    return [f"drop view if exists {quoted(name)}" for (name,) in views] + [
        f"drop macro{' table' if kind == 'table_macro' else ''} if exists {quoted(name)}" for name, kind in macros
    ]
