"""Where the samples of a test stand in raw files, so that two tests of one recording are known to share them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import duckdb

Key = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Recorded:
    """A channel of a test. zero_ns: t_s == 0 as the file counts time; parts: what was read (one version of a file) ->
    the times between which its samples are the test's [ns]; step_ns: from one to the next. signal: its name there, for
    one logger may serve two machines; None where it has none."""

    zero_ns: int
    step_ns: int
    parts: Mapping[str, tuple[int, int]]
    signal: str | None = None


_STREAMS = """
with raw as (select campaign, test, source, stream, list(key order by key) as keys,
                    list(cast(columns->>'first_ns' as bigint) + if(columns->>'clock' = 'relative',
                         coalesce(cast(columns->>'start_ns' as bigint), 0), 0) order by key) as firsts,
                    list(cast(columns->>'last_ns' as bigint) + if(columns->>'clock' = 'relative',
                         coalesce(cast(columns->>'start_ns' as bigint), 0), 0) order by key) as lasts
             from file where layer = 'raw' and part = 'test' and list_contains($campaigns, campaign) group by all),
tidy as (select campaign, test, source, stream, max(cast(columns->>'to_s' as double)) as to_s
         from file where layer = 'tidy' and part = 'test' and list_contains($campaigns, campaign) group by all)
select raw.*, coalesce(tidy.to_s, t.duration_s), t.window_s is not null as cut, s.clock, s.start_ns, s.step_s
from raw join test t using (campaign, test) join source s using (campaign, test, source, stream)
     left join tidy using (campaign, test, source, stream)"""


class _Stream(NamedTuple):
    """A row of these. keys, firsts, lasts: of its files, in one order; times as the files count them [ns]. to_s: where
    its tidy samples end. cut: whether the test is a window of the recording."""

    campaign: str
    test: str
    source: str
    stream: str
    keys: list[str]
    firsts: list[Any]
    lasts: list[Any]
    to_s: float | None
    cut: bool
    clock: str
    start_ns: int | None
    step_s: float | None


_CHANNELS = "select campaign, test, channel, source, stream, signal from channel where list_contains(?, campaign)"


def recorded_channels(
    con: duckdb.DuckDBPyConnection, campaigns: Sequence[str], zero_ns: Mapping[Key, int]
) -> dict[Key, dict[str, Recorded]]:
    """(campaign, test) -> channel -> where its samples stand. zero_ns: t_s == 0 on each test's time line."""
    streams: dict[tuple[str, ...], Recorded] = {}
    for row in map(_Stream._make, con.execute(_STREAMS, {"campaigns": list(campaigns)}).fetchall()):
        zero = zero_ns.get((row.campaign, row.test))
        if zero is not None and (made := _recorded(row, zero)) is not None:
            streams[row[:4]] = made
    found: dict[Key, dict[str, Recorded]] = {}
    for campaign, test, channel, source, stream, signal in con.execute(_CHANNELS, [list(campaigns)]).fetchall():
        if (made := streams.get((campaign, test, source, stream))) is not None:
            found.setdefault((campaign, test), {})[channel] = replace(made, signal=signal)
    return found


def _recorded(of: _Stream, zero_ns: int) -> Recorded | None:
    keys, firsts, lasts = of.keys, of.firsts, of.lasts
    if of.to_s is None or of.start_ns is None or None in (*firsts, *lasts):
        return None
    zero = zero_ns - (of.start_ns - min(firsts))  # what the clock's correction added is taken off
    end = zero + round(of.to_s * 1e9)
    if of.clock == "relative" and len(keys) > 1:
        # files that count from 0 are joined: where each begins stands in none of them
        keys, firsts, lasts = ["+".join(keys)], [min(firsts)], [end]
    last = end if of.cut else max(lasts)
    parts = {
        f"{key} {of.stream}": (max(low, zero), min(high, last))
        for key, low, high in zip(keys, firsts, lasts, strict=True)
        if min(high, last) >= max(low, zero)
    }
    return Recorded(zero, round((of.step_s or 0.0) * 1e9), parts)
