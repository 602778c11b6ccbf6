"""`quality`: what was flagged, as a table or as a page with a picture a test."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from thermodata.cli.look.look import campaign_option
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
    from thermodata.report.quality.told import by_cause, by_channel, faults_in_words, lost_in_words, with_reason
    from thermodata.view.lists.flag_rows import faults_told, flag_rows, lost

    store = session.store()
    rows = [with_reason(row) for row in flag_rows(store, campaign)]

    def text() -> str:
        parts = []
        if events or channels:
            shown = rows if events else by_channel(rows)
            parts.append(_table(shown, "detail" if events else "events"))
        elif rows:
            parts.append(_causes(by_cause(rows)))
        losses = _listed("losses", lost_in_words(lost(store, campaign)))
        told = "told by diagnose beside these models, and flagged nowhere"
        faults = _listed(told, faults_in_words(faults_told(store, campaign)))
        return "\n\n".join([*(parts if rows else ["nothing was flagged"]), *losses, *faults])

    session.answer(rows if events else by_channel(rows), text)


def _listed(title: str, lines: list[str]) -> list[str]:
    return ["\n".join([title, *(f"  - {line}" for line in lines)])] if lines else []


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
