"""`quality`: what was flagged, as a table or as a page with a picture a test."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from thermodata.cli.look.look import campaign_option, rows_of
from thermodata.cli.terminal.common import Session, command
from thermodata.report.text.table import table
from thermodata.report.words.numbers import duration


@command("quality")
@campaign_option
@click.option("--events", is_flag=True, help="Each event with its time, not the sums.")
@click.option("--channels", is_flag=True, help="A row for each test and channel, not for each cause.")
@click.option(
    "--report",
    "-o",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write an HTML page with a picture a test.",
)
def quality_command(session: Session, campaign: str | None, events: bool, channels: bool, report: Path | None) -> None:
    """Show what was flagged, and what was lost.

    Gaps, spikes, saturation, held and stuck values, sensors that stepped, suspect clocks; flagged rows are kept. One
    cause is one row, with its first place. --json always gives a row for each test and channel. --report draws it: one
    self-contained page, each test with its channels and flags over time. What diagnose told of the logs beside a model,
    such as a probe that slipped, is no flag, and stands below.
    """
    if report is not None:
        from thermodata.report.quality.page import build_quality_report

        page = build_quality_report(session.view(), campaign, report)
        session.answer({"report": str(page), "bytes": page.stat().st_size}, lambda: str(page))
        return
    from thermodata.report.quality.told import by_cause, by_channel, with_reason
    from thermodata.store.views.result import OF_ITS_TEST
    from thermodata.view.lists.not_measured import not_measured

    query = f"select * from quality_event e where {OF_ITS_TEST}"
    found = rows_of(session, f"select * from ({query})", campaign, "campaign, test, source, channel, from_s")
    files = _files(session, campaign)
    said_by_log = not_measured(session.store(), campaign)
    outside = _events_outside(files, {(row["campaign"], row["test"]) for row in said_by_log})
    rows = [with_reason(row) for row in [*found, *outside, *said_by_log]]
    losses = _losses(files, _signals(session, campaign))

    def text() -> str:
        parts = []
        if events or channels:
            shown = rows if events else by_channel(rows)
            parts.append(_table(shown, "detail" if events else "events"))
        elif rows:
            parts.append(_causes(by_cause(rows)))
        told = _told_by_diagnosis(session, campaign)
        return "\n\n".join([*(parts if rows else ["nothing was flagged"]), *losses, *told])

    session.answer(rows if events else by_channel(rows), text)


def _table(rows: list[dict[str, Any]], last: str) -> str:
    shown = [{**row, "first": duration(row["from_s"]), "last": duration(row["to_s"])} for row in rows]
    columns = [
        *((k, k) for k in ("campaign", "test", "source", "channel", "flag")),
        *(("n", "samples"), ("first", "from"), ("last", "to"), (last, last)),
    ]
    columns += [("overruled", "overruled")] if last == "events" and any(r["overruled"] for r in rows) else []
    return table(shown, columns, widest=100)


def _causes(rows: list[dict[str, Any]]) -> str:
    campaigns = len({row["campaign"] for row in rows}) > 1
    columns = [
        *([("campaign", "campaign")] if campaigns else []),
        *(("flag", "flag"), ("n", "samples"), ("events", "events"), ("tests", "tests"), ("channels", "channels")),
        *(("first", "first"), ("detail", "there")),
    ]
    return table(rows, columns, widest=100)


def _files(session: Session, campaign: str | None) -> list[dict[str, Any]]:
    """Rows of `file`, with what is kept of each beside its columns."""
    query = "select campaign, test, source, source_path, losses, columns from file"
    files = rows_of(session, f"select * from ({query} where layer <> 'superseded')", campaign, "test, source")
    for row in files:
        meta = json.loads(row["columns"] or "{}")
        row["meta"] = meta if isinstance(meta, dict) else {}
    return files


def _events_outside(files: list[dict[str, Any]], said_by_log: set[tuple[str, str]]) -> list[dict[str, Any]]:
    """As events: what lies outside of its test's `measuring` is no event of a sensor, and counts as little.
    said_by_log: tests without `measuring`, in which a log said that nothing was measured."""
    from thermodata.view.lists.not_measured import OUTSIDE

    return [
        {
            **{key: row[key] for key in ("campaign", "test", "source")},
            **dict.fromkeys(("stream", "channel", "from_s", "to_s")),
            "flag": "not_measuring",
            "n": n,
            "detail": OUTSIDE,
        }
        for row in files
        if (n := row["meta"].get("flags", {}).get("not_measuring", 0))
        and (row["campaign"], row["test"]) not in said_by_log
    ]


def _signals(session: Session, campaign: str | None) -> set[tuple[str, str, str, str]]:
    """(campaign, test, source, signal without its unit) of every channel."""
    query = "select distinct campaign, test, source, signal from channel where signal is not null"
    return {
        (row["campaign"], row["test"], row["source"], _name_without_unit(row["signal"]))
        for row in rows_of(session, f"select * from ({query})", campaign, "test, source")
    }


def _name_without_unit(signal: str) -> str:
    from thermodata.reader.text import split_unit

    return split_unit(signal)[0].casefold()


def _losses(files: list[dict[str, Any]], signals: set[tuple[str, str, str, str]]) -> list[str]:
    """What could not be read or made, a line a cause. What is lost of a file is one loss, of the tests and sources that
    miss it."""
    from thermodata.report.words.causes import losses_in_words

    once: dict[str, dict[str, Any]] = {}
    for row in files:
        place = {"campaign": row["campaign"], "test": row["test"] or None, "file": row["source_path"]}
        found = [{**place, **loss} for loss in json.loads(row["losses"] or "[]")]
        found += [{**place, "reason": p} for p in row["meta"].get("problems", [])]
        for loss in found:
            key = json.dumps([loss.get(k) for k in ("campaign", "file", "where", "reason")])
            one = once.setdefault(key, {**loss, "tests": [], "sources": []})
            if row["test"] and row["test"] not in one["tests"]:
                one["tests"].append(row["test"])
            signal = loss.get("signal")
            read = (
                signal is None or (row["campaign"], row["test"], row["source"], _name_without_unit(signal)) in signals
            )
            if row["source"] and row["source"] not in one["sources"] and (read or not row["test"]):
                one["sources"].append(row["source"])
    for one in once.values():
        if one.get("signal") and one["test"] and not one["sources"]:
            one["reason"] += "; no channel reads that column"
    names = {str(n) for x in once.values() for n in (*x["tests"], *x["sources"])}
    lines = losses_in_words(list(once.values()), names)
    return ["losses\n" + "\n".join(f"  - {line}" for line in lines)] if lines else []


def _told_by_diagnosis(session: Session, campaign: str | None) -> list[str]:
    """Faults of the logs that no flag tells, a line each, with the models beside which they were told."""
    query = (
        "select a.campaign, a.test, a.kind, a.at_s, a.size_um, a.response, m.name, m.model, m.stale from artefact a "
        "join model m using (model) where not list_contains(['sensor', 'parameters'], a.kind)"
    )  # the one is what flags say, the other no fault of a log
    found: dict[tuple[str, ...], list[str]] = {}
    for row in rows_of(session, f"select * from ({query})", campaign, "campaign, test, at_s, name, model"):
        place = f"{row['campaign']}/{row['test']}" if row["test"] else f"all tests of {row['campaign']}"
        at = "" if row["at_s"] is None else f" at {duration(row['at_s'])}"
        size = "" if row["at_s"] is None or row["size_um"] is None else f", {row['response']} by {row['size_um']:+.3g}"
        model = f"{row['name']} {row['model'][:6]}{', stale' if row['stale'] else ''}"
        found.setdefault((row["kind"], place, at), [size]).append(model)
    lines = [f"  - {kind} in {place}{at}{size} ({'; '.join(of)})" for (kind, place, at), (size, *of) in found.items()]
    return ["told by diagnose beside these models, and flagged nowhere\n" + "\n".join(lines)] if lines else []
