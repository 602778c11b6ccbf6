"""Flags in rows for a person: summed by test and channel, or by their cause over all of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from thermodata.report.words.causes import cause_of, losses_in_words
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
    """One row for each cause of a flag: over how many tests and channels, where first, and in what words there; `rows`
    are its own."""
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
            "rows": some,
            "first": f"{first['test']}, {first['channel'] or first['source'] or 'all'}, {duration(first['from_s'])}",
        }
    return list(sums.values())


def lost_in_words(losses: Sequence[Mapping[str, Any]]) -> list[str]:
    """A line a cause of what could not be read or made (`flag_rows.lost`)."""
    return losses_in_words(losses, {str(n) for x in losses for n in (*x["tests"], *x["sources"])})


def faults_in_words(faults: Sequence[Mapping[str, Any]]) -> list[str]:
    """'step in c/day1 at 2.9 h, dZ by +25 (baseline 1a2b3c)': a line a fault that `diagnose` told (`faults_told`), with
    the models beside which it did."""
    found: dict[tuple[str, ...], list[str]] = {}
    for row in faults:
        place = f"{row['campaign']}/{row['test']}" if row["test"] else f"all tests of {row['campaign']}"
        at = "" if row["at_s"] is None else f" at {duration(row['at_s'])}"
        size = "" if row["at_s"] is None or row["size_um"] is None else f", {row['response']} by {row['size_um']:+.3g}"
        model = f"{row['name']} {row['model'][:6]}{', stale' if row['stale'] else ''}"
        found.setdefault((row["kind"], place, at), [size]).append(model)
    return [f"{kind} in {place}{at}{size} ({'; '.join(of)})" for (kind, place, at), (size, *of) in found.items()]
