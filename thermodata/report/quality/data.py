"""What the quality page shows: each test in a few hundred bins of time, with the flags of every channel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import UsageError, unknown_name
from thermodata.plugin import Array, Float1D
from thermodata.report.collected.records import records
from thermodata.schema.flag import INVALID, Flag
from thermodata.view.lists.not_measured import not_measured

if TYPE_CHECKING:
    from thermodata.view import StoreView

MOST_BINS = 480
_MANY_TESTS = 40


_BINS = """
with binned as (
    select channel, least(cast(floor((t_s - $start) / $width) as integer), $last) as bin, value, flag,
           flag & $idle <> 0 as idle, flag & $invalid = 0 as counts
    from sample where campaign = $campaign and test = $test)
select channel, bin, count(*) as n, avg(value) filter (counts and isfinite(value)) as good,
       min(value) filter (not counts and not idle and isfinite(value)) as low,
       max(value) filter (not counts and not idle and isfinite(value)) as high,
       coalesce(bit_or(flag) filter (not idle), $idle) as flags,
       count(*) filter (not counts and not idle) as flagged, count(*) filter (idle) as idle
from binned group by all order by channel, bin"""


@dataclass(frozen=True, slots=True)
class Trace:
    """A channel in a test, in bins of time, arrays of shape (bins,). good: mean of the samples that count, NaN where
    there are none. low, high: extremes of those that a defect rules out, NaN elsewhere. flags: of the samples taken
    while the test measures; NOT_MEASURING where there are no others. flagged: samples that a defect rules out, or of
    which the log says that nothing was measured; a sample outside the measuring phases is none."""

    name: str
    quantity: str
    unit: str
    good: Float1D
    low: Float1D
    high: Float1D
    flags: Array
    samples: int
    flagged: int
    idle: int


@dataclass(frozen=True, slots=True)
class TestQuality:
    """One test. bin_s: width of a bin [s], from start_s on. events: rows of the view `quality`, in order of time."""

    __test__ = False
    campaign: str
    test: str
    kind: str
    duration_s: float
    start_s: float
    bin_s: float
    traces: tuple[Trace, ...]
    events: tuple[dict[str, Any], ...]
    losses: tuple[str, ...]


def collect(view: StoreView, campaign: str | None) -> list[TestQuality]:
    """Every test of a campaign (of the store's only one where none is named), in the order of their names."""
    names = [row["campaign"] for row in records(view, "select campaign from campaign order by 1")]
    if campaign is None and len(names) > 1:
        raise UsageError("the store holds several campaigns", expected="--campaign NAME", got=", ".join(names))
    if campaign is not None and campaign not in names:
        raise unknown_name("campaign", campaign, names)
    tests = (
        records(
            view, "select * from test where campaign = ? order by start_ns nulls last, test", [campaign or names[0]]
        )
        if names
        else []
    )
    bins = MOST_BINS if len(tests) <= _MANY_TESTS else MOST_BINS // 2
    return [_test(view, row, bins) for row in tests]


def _test(view: StoreView, test: dict[str, Any], bins: int) -> TestQuality:
    own = [test["campaign"], test["test"]]
    channels = {
        row["channel"]: row
        for row in records(
            view,
            "select distinct on (channel) channel, quantity, unit from channel "
            "where campaign = ? and test = ? order by channel",
            own,
        )
    }
    first, last = records(view, "select min(t_s) as a, max(t_s) as b from sample where campaign = ? and test = ?", own)[
        0
    ].values()
    start, stop = float(first or 0.0), float(last or 0.0)
    width = max((stop - start) / bins, 1e-9)
    found = records(
        view,
        _BINS,
        {
            "start": start,
            "width": width,
            "last": bins - 1,
            "invalid": int(INVALID),
            # where nothing is declared, a log itself says that it has no value: that does not count either
            "idle": 0 if test["measuring"] is None else int(Flag.NOT_MEASURING),
            "campaign": own[0],
            "test": own[1],
        },
    )
    rows: dict[str, list[dict[str, Any]]] = {}
    for row in found:
        rows.setdefault(row["channel"], []).append(row)
    events = records(view, "select * from quality where campaign = ? and test = ? order by from_s, channel", own)
    lost = records(
        view,
        "select distinct source_path, losses from file where campaign = ? and test = ? and "
        "losses is not null and layer <> 'superseded' order by 1",
        own,
    )
    return TestQuality(
        own[0],
        own[1],
        test["kind"],
        float(test["duration_s"] or stop - start),
        start,
        width,
        tuple(_trace(channels[name], rows[name], bins) for name in channels if name in rows),
        tuple(
            sorted([*events, *not_measured(view.store, *own)], key=lambda e: (e["from_s"] or 0.0, e["channel"] or ""))
        ),
        tuple(_losses(lost)),
    )


def _trace(channel: dict[str, Any], rows: Sequence[dict[str, Any]], bins: int) -> Trace:
    at = np.array([r["bin"] for r in rows])

    def spread(key: str) -> Float1D:
        made = np.full(bins, np.nan)
        made[at] = [np.nan if r[key] is None else r[key] for r in rows]
        return made

    flags = np.zeros(bins, np.uint16)
    flags[at] = [r["flags"] or 0 for r in rows]
    return Trace(
        channel["channel"],
        channel["quantity"],
        channel["unit"],
        spread("good"),
        spread("low"),
        spread("high"),
        flags,
        sum(r["n"] for r in rows),
        sum(r["flagged"] for r in rows),
        sum(r["idle"] for r in rows),
    )


def _losses(rows: Sequence[dict[str, Any]]) -> list[str]:
    import json

    said = []
    for row in rows:
        for loss in json.loads(row["losses"] or "[]"):
            share = f" ({100 * loss['fraction']:.2g} % of the file)" if loss.get("fraction") else ""
            said.append(f"{row['source_path'] or 'tidy layer'}, {loss['where']}: {loss['reason']}{share}")
    return list(dict.fromkeys(said))


def flag_names(flags: int) -> list[str]:
    """The names of the flags in a mask, lower case."""
    return [f.word for f in Flag if f and flags & f]
