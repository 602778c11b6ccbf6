"""`quality`: what was flagged, as a table or as a page with a picture a test."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from thermodata.cli.common import Session, command
from thermodata.cli.look import campaign_option, rows_of
from thermodata.cli.table import table
from thermodata.report.words import duration


@command("quality")
@campaign_option
@click.option("--events", is_flag=True, help="Each event with its time, not the sums.")
@click.option(
    "--report",
    "-o",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write an HTML page with a picture a test.",
)
def quality_command(session: Session, campaign: str | None, events: bool, report: Path | None) -> None:
    """Show what was flagged.

    Gaps, spikes, saturation, held and stuck values, sensors that stepped, suspect clocks; flagged rows are kept.
    --report draws it: one self-contained page, each test with its channels and flags over time.
    """
    if report is not None:
        from thermodata.report.quality.page import build_quality_report

        page = build_quality_report(session.view(), campaign, report)
        session.answer({"report": str(page), "bytes": page.stat().st_size}, lambda: str(page))
        return
    rows = rows_of(session, "select * from quality_event", campaign, "campaign, test, source, channel, from_s")
    if not events:
        sums: dict[tuple[str, ...], dict[str, Any]] = {}
        for row in rows:
            key = tuple(str(row[k]) for k in ("campaign", "test", "source", "channel", "flag"))
            total = sums.setdefault(
                key,
                {
                    **{k: row[k] for k in ("campaign", "test", "source", "channel", "flag")},
                    "events": 0,
                    "n": 0,
                    "from_s": row["from_s"],
                    "to_s": row["to_s"],
                },
            )
            total["events"] += 1
            total["n"] += row["n"] or 0
            total["to_s"] = max((v for v in (total["to_s"], row["to_s"]) if v is not None), default=None)
        rows = list(sums.values())
    shown = [{**row, "first": duration(row["from_s"]), "last": duration(row["to_s"])} for row in rows]
    columns = [
        ("campaign", "campaign"),
        ("test", "test"),
        ("source", "source"),
        ("channel", "channel"),
        ("flag", "flag"),
        ("n", "samples"),
        ("first", "from"),
        ("last", "to"),
    ]
    columns += [("detail", "detail")] if events else [("events", "events")]
    session.answer(rows, lambda: table(shown, columns) if rows else "nothing was flagged")
