"""Samples of which a log itself says that nothing was measured: an empty cell, a comment, a status."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

from thermodata.schema.flag import Flag

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store

SAID_BY_LOG = "the log has no value there, leaps to 0 in all channels, or says in a comment or a status that it is none"
OUTSIDE = "outside of the test's measuring"

_TESTS = """
select distinct f.campaign, f.test from file f join test t on t.campaign = f.campaign and t.test = f.test
where f.layer = 'tidy' and t.measuring is null
  and coalesce(try_cast(f."columns"->>'$.flags.not_measuring' as bigint), 0) > 0
  and ($campaign is null or f.campaign = $campaign) and ($test is null or f.test = $test) order by all"""
_TIMES = """
select source, channel, list_sort(list(t_s)) as t_s from sample
where campaign = $campaign and test = $test and flag & $flag <> 0 group by all order by all"""
_STEPS = "select source, max(step_s) from source where campaign = ? and test = ? group by all"
_APART = 1.5  # steps between two samples of one stretch
_MOST = 50  # stretches of a channel; of more the first and the last sample are told


def not_measured(store: Store, campaign: str | None = None, test: str | None = None) -> list[dict[str, Any]]:
    """Rows as those of `quality_event`, one a stretch of a channel, of the tests that declare no `measuring`: in the
    others such samples can't be told from those outside of it."""
    with store.reader() as con:
        tests = con.execute(_TESTS, {"campaign": campaign, "test": test}).fetchall()
        found = [row for of_campaign, of_test in tests for row in _of_test(con, of_campaign, of_test)]
    return [{**row, "stream": None, "flag": Flag.NOT_MEASURING.word, "detail": SAID_BY_LOG} for row in found]


def _of_test(con: duckdb.DuckDBPyConnection, campaign: str, test: str) -> list[dict[str, Any]]:
    """In order of time."""
    import numpy as np  # a store without flags is shown without it

    steps = dict(con.execute(_STEPS, [campaign, test]).fetchall())
    asked = {"campaign": campaign, "test": test, "flag": int(Flag.NOT_MEASURING)}
    times = con.sql(_TIMES, params=asked).to_arrow_table()
    found: list[dict[str, Any]] = []
    for source, channel, of in zip(*(times.column(name) for name in ("source", "channel", "t_s")), strict=True):
        own = {"campaign": campaign, "test": test, "source": source.as_py(), "channel": channel.as_py()}
        t_s = of.values.to_numpy()
        apart = _APART * (steps.get(own["source"]) or 0.0)
        parts = [0, *(np.flatnonzero(np.diff(t_s) > apart) + 1).tolist(), len(t_s)]
        parts = parts if len(parts) <= _MOST + 1 else [0, len(t_s)]
        found += [{**own, "from_s": float(t_s[i]), "to_s": float(t_s[j - 1]), "n": j - i} for i, j in pairwise(parts)]
    return sorted(found, key=lambda row: (row["from_s"], row["source"], row["channel"]))
