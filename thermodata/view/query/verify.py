"""The checksums of the pages that a query may have read: DuckDB does not look at them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import StoreError
from thermodata.schema.words.sentences import counted
from thermodata.store.base.files import is_whole
from thermodata.store.keep.check import altered

if TYPE_CHECKING:
    import duckdb

MOST_BYTES = 32 << 20  # beyond it a query would take seconds longer: 'check' looks at all
_seen: set[tuple[str, int, int]] = set()


def verify_pages(con: duckdb.DuckDBPyConnection, folder: Path, query: str, most_bytes: int = MOST_BYTES) -> str | None:
    """Looks at the pages of the files that a query reads, once a process. StoreError where one was altered; a sentence
    where there are too many to look at; else None.

    The query's plan tells that files are read, not which: those of the tests and campaigns that it names, else all.
    """
    import duckdb

    try:
        plan = str(con.execute(f"explain (format json) {query}").fetchall())
    except duckdb.Error:  # a statement that has no plan reads no files, or fails by itself
        return None
    if "PARQUET" not in plan:
        return None
    files = con.execute(
        "select path, campaign, test from file where layer = 'tidy' "
        "union all select path, campaign, test from prediction"
    ).fetchall()
    words = set(re.findall(r"'((?:[^']|'')*)'", query))
    for column in (1, 2):
        named = [f for f in files if f[column] in words]
        files = named or files
    paths = [folder / p for p in dict.fromkeys(str(f[0]) for f in files)]
    states = {p: p.stat() for p in paths if p.exists()}  # what is gone, the query itself says
    keys = {p: (str(p), s.st_mtime_ns, s.st_size) for p, s in states.items()}
    left = [p for p in states if keys[p] not in _seen]
    size = sum(states[p].st_size for p in left)
    if size > most_bytes:
        return (
            f"the pages of {counted(len(left), 'file')} ({size >> 20} MiB) were not verified: thermodata "
            "check looks at all"
        )
    for path in left:
        if not is_whole(path):
            continue  # the query itself says it, with what to do
        problem = altered(path)
        if problem is not None:
            raise StoreError(
                "a file of the store is damaged",
                where=str(path),
                got=problem,
                hint="thermodata check --repair puts it out of the way, and ingest makes it anew",
            )
        _seen.add(keys[path])
    return None
