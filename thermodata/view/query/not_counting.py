"""Whether a query takes values of samples that do not count, and asks neither for their flags nor whether they do."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TYPE_CHECKING

from thermodata.schema.flag import INVALID, OVERRULED, Flag
from thermodata.schema.units.quantity import MEASURED
from thermodata.store.views.result import OF_ITS_TEST
from thermodata.view.query.what_is_read import Read, what_is_read

if TYPE_CHECKING:
    import duckdb

_LONG = frozenset({"sample", "signal", "displacement", "temperature", "driver"})
_RESIDUAL = "residual"
_OF_VIEW = {
    "displacement": "c.quantity = 'displacement'",
    "temperature": "c.quantity = 'temperature'",
    "driver": f"c.quantity not in {MEASURED}",
}
_WORDS = re.compile(r"'(?:[^']|'')*'|\w+")
_NOT_COUNTING = tuple(f.word for f in Flag if f & INVALID)


def values_that_do_not_count(con: duckdb.DuckDBPyConnection, query: str, columns: Collection[str]) -> str | None:
    """A sentence where a query takes samples that do not count as if they did; None elsewhere. It does where it takes
    `value` from a long view and names no flag, or what is left from `residual` and not `valid`, neither in the query
    nor in its answer's columns, and what it names (channels, tests, campaigns) has such samples."""
    return _of_samples(con, query, columns) or _of_residuals(con, query, columns)


def _of_residuals(con: duckdb.DuckDBPyConnection, query: str, columns: Collection[str]) -> str | None:
    import duckdb

    words = [w.lower() for w in _WORDS.findall(query)]
    if _RESIDUAL not in words or "valid" in words or "valid" in columns:
        return None
    reads = what_is_read(con, query, frozenset({_RESIDUAL}))
    if reads is None:
        reads = [Read(_RESIDUAL)]
    if "measured" not in words and words.count(_RESIDUAL) <= len(reads):
        return None  # no more than the view's own name
    held = [" and ".join(f"list_contains(${key}, {key})" for key in sorted(read.only)) or "true" for read in reads]
    for where, read in zip(held, reads, strict=True):
        only = {key: sorted(values) for key, values in read.only.items()}
        try:
            found = con.execute(f"select 1 from {_RESIDUAL} where not valid and {where} limit 1", only).fetchone()
        except duckdb.Error:  # a file that is gone: the query itself says so
            return None
        if found:
            return (
                "the residuals are of samples too that do not count, some of them NaN, which every mean is then: "
                "'where valid' leaves them out"
            )
    return None


def _of_samples(con: duckdb.DuckDBPyConnection, query: str, columns: Collection[str]) -> str | None:
    words = {w.lower() for w in _WORDS.findall(query)}
    if not words & _LONG or "value" not in words or "flag" in words or "flag" in columns:
        return None
    reads = what_is_read(con, query, _LONG)
    if reads is None:
        reads = [Read(view) for view in sorted(words & _LONG)]
    found: dict[str, set[tuple[str, str]]] = {}
    for read in reads:
        for flag, campaign, test in _flagged(con, read):
            found.setdefault(flag, set()).add((campaign, test))
    rows = sorted(found, key=lambda flag: (-len(found[flag]), flag))
    if not rows:
        return None
    kinds = ", ".join(flag.replace("_", " ") for flag in rows)
    return f"the values are of flagged samples too ({kinds}): 'where valid(flag)' leaves out what does not count"


def _flagged(con: duckdb.DuckDBPyConnection, read: Read) -> list[tuple[str, str, str]]:
    """(flag, campaign, test) of what does not count of the samples that are read."""
    if not all(read.only.values()):
        return []
    held = "".join(f" and list_contains(${key}, e.{key})" for key in read.only if key != "channel")
    # an event without a channel is of every channel of its stream
    if "channel" in read.only:
        held += " and list_contains($channel, c.channel)"
    rows: list[tuple[str, str, str]] = con.execute(
        "select distinct lower(e.flag), e.campaign, e.test from quality_event e join channel c "
        "on c.campaign = e.campaign and c.test = e.test and c.source = e.source and c.stream = e.stream "
        "and (e.channel is null or c.channel = e.channel) "
        "where list_contains($flags, lower(e.flag)) and not starts_with(coalesce(e.detail, ''), $overruled) "
        f"and {OF_ITS_TEST} and {_OF_VIEW.get(read.view, 'true')}{held}",
        {
            "flags": list(_NOT_COUNTING),
            "overruled": OVERRULED,
            **{key: sorted(values) for key, values in read.only.items()},
        },
    ).fetchall()
    return rows
