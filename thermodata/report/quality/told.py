"""Flags in rows for a person: summed by test and channel, or by their cause over all of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from thermodata.report.words.causes import cause_of
from thermodata.report.words.numbers import duration
from thermodata.schema.flag import OVERRULED

Row = dict[str, Any]
_OWN = ("campaign", "test", "source", "channel", "flag", "overruled")


def with_reason(row: Mapping[str, Any]) -> Row:
    """A row of `quality_event`. overruled: why it is, by the campaign file; None where it is not."""
    detail = row["detail"] or ""
    whole = detail.startswith(OVERRULED)
    reason = detail[len(OVERRULED) :].partition(" (was: ")[0] if whole else None
    return {**row, "overruled": reason}


def by_channel(rows: Sequence[Mapping[str, Any]]) -> list[Row]:
    """One row for each test, channel and flag; what is overruled in rows of its own."""
    sums: dict[tuple[Any, ...], Row] = {}
    for row in rows:
        total = sums.setdefault(
            tuple(str(row[k]) for k in _OWN),
            {**{k: row[k] for k in _OWN}, "events": 0, "n": 0, "from_s": row["from_s"], "to_s": row["to_s"]},
        )
        total["events"] += 1
        total["n"] += row["n"] or 0
        total["to_s"] = max((v for v in (total["to_s"], row["to_s"]) if v is not None), default=None)
    return list(sums.values())


def by_cause(rows: Sequence[Mapping[str, Any]]) -> list[Row]:
    """One row for each cause of a flag: over how many tests and channels, where first, and in what words there."""
    names = {str(row[k]) for row in rows for k in ("test", "source", "channel") if row[k]}
    sums: dict[tuple[Any, ...], Row] = {}
    members: dict[tuple[Any, ...], list[Mapping[str, Any]]] = {}
    for row in rows:
        key = (row["campaign"], row["flag"], str(row["overruled"]), cause_of(row["detail"] or "", names))
        sums.setdefault(key, {"campaign": row["campaign"], "flag": row["flag"], "detail": row["detail"]})
        members.setdefault(key, []).append(row)
    for key, total in sums.items():
        some = members[key]
        first = some[0]
        total |= {
            "n": sum(r["n"] or 0 for r in some),
            "events": len(some),
            "tests": len({r["test"] for r in some}),
            "channels": len({r["channel"] for r in some if r["channel"]}) or None,
            "first": f"{first['test']}, {first['channel'] or first['source'] or 'all'}, {duration(first['from_s'])}",
        }
    return list(sums.values())
