"""Whether a query takes values of samples that do not count, and does not ask for their flags."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TYPE_CHECKING

from thermodata.schema.flag import INVALID, OVERRULED, Flag

if TYPE_CHECKING:
    import duckdb

_LONG = frozenset({"sample", "signal", "displacement", "temperature", "driver"})
_WORDS = re.compile(r"'(?:[^']|'')*'|\w+")
_NOT_COUNTING = tuple(str(f.name).lower() for f in Flag if f & INVALID)


def values_that_do_not_count(con: duckdb.DuckDBPyConnection, query: str, columns: Collection[str]) -> str | None:
    """A sentence where a query takes `value` from a long view, neither it nor its answer's columns say anything of the
    flag, and the store has samples that do not count."""
    words = {w.lower() for w in _WORDS.findall(query)}
    if not words & _LONG or "value" not in words or "flag" in words or "flag" in columns:
        return None
    rows = con.execute(
        "select lower(flag), count(distinct (campaign, test)) from quality_event "
        "where list_contains(?, lower(flag)) and not starts_with(coalesce(detail, ''), ?) "
        "group by 1 order by 2 desc, 1",
        [list(_NOT_COUNTING), OVERRULED],
    ).fetchall()
    if not rows:
        return None
    kinds = ", ".join(str(flag).replace("_", " ") for flag, _ in rows)
    return f"the values are of flagged samples too ({kinds}): 'where valid(flag)' leaves out what does not count"
