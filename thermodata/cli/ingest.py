"""`ingest`: raw files into the store."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from thermodata.cli.common import Session, command, plain
from thermodata.report.causes import said_at_ingest
from thermodata.report.table import fields, table


@command("ingest")
@click.argument("campaign", type=click.Path(path_type=Path))
def ingest_command(session: Session, campaign: Path) -> int:
    """Bring CAMPAIGN.yaml and its raw files into the store.

    Safe to repeat: files that did not change are not read again, and after an edit of the campaign file only
    what depends on the edit is made anew. Exit code 3 says that a part of a file could not be read.
    """
    from thermodata.cli.progress import progress_line
    from thermodata.draft.writing.baseline import model_text_of
    from thermodata.report.after_ingest import next_step
    from thermodata.schema.load import load_campaign
    from thermodata.store.ingest.run import ingest, store_for

    store = store_for(session.store_path, campaign)
    with progress_line() as line:
        summary = plain(ingest(store, campaign, progress=line).to_json())
    session.answer(summary, lambda: ingest_text(summary))
    step = next_step(store, summary, campaign, lambda: model_text_of(load_campaign(campaign)))
    if step is not None:
        session.say(step)
    return 3 if summary["losses"] else 0


def ingest_text(summary: dict[str, Any]) -> str:
    """The summary of an ingest for a person: counts, calibrations, flags, losses, notes."""
    from thermodata.schema.counted import counted

    flags = {name: n for name, n in summary["flags"].items() if n}
    parts = [
        fields(
            [
                ("campaign", summary["campaign"]),
                ("tests", summary["tests"]),
                ("files", summary["files"]),
                ("samples", f"{_number(summary['samples'])}"),
                ("flagged", flags or "none"),
                (
                    "new",
                    f"{counted(summary['read'], 'file')} read, {counted(summary['made'], 'stream')} made"
                    if summary["changed"]
                    else "nothing",
                ),
                *([("stale models", summary["stale"])] if summary["stale"] else []),
                ("took", f"{summary['seconds']:.1f} s"),
            ]
        )
    ]
    if summary["calibrations"]:
        parts.append(calibrations_text(summary["calibrations"]))
    for title, lines in said_at_ingest(summary).items():
        if lines:
            parts.append(title + "\n" + "\n".join(f"  - {line}" for line in lines))
    return "\n\n".join(parts)


def calibrations_text(rows: list[dict[str, Any]]) -> str:
    """Calibrations as a table; what failed follows with its advice."""
    shown = [
        {
            **row,
            "calibration": row.get("calibration", row.get("name")),
            "ok": _checked(row),
        }
        for row in rows
    ]
    several = len({row.get("campaign") for row in rows}) > 1
    text = table(
        shown,
        [
            *([("campaign", "campaign")] if several else []),
            ("calibration", "calibration"),
            ("kind", "kind"),
            ("axis", "axis"),
            ("gain", "gain"),
            ("gain_unit", "unit"),
            ("sign", "sign"),
            ("uncertainty_pct", "± [%]"),
            ("noise_um", "noise [um]"),
            ("nonlinearity_pct", "nonlin. [%]"),
            ("drift_um", "drift [um]"),
            ("ok", "checks"),
        ],
    )
    failed = [
        f"  ! {row['campaign'] + ', ' if several else ''}{row['calibration']}: {c['name']}: {c.get('advice') or ''}"
        for row in shown
        for c in row.get("checks") or []
        if not c.get("passed", True)
    ]
    return "\n".join([text, *failed])


def _checked(row: dict[str, Any]) -> str:
    """Whether the checks hold; of a gain that was declared, and no jump test measured, only what was declared was held
    against itself."""
    if not all(c.get("passed", True) for c in row.get("checks") or []):
        return "no"
    return "yes" if row["kind"] == "jump" else "not measured"


def _number(value: Any) -> str:
    return f"{value:,}".replace(",", " ") if isinstance(value, int) else str(value)
