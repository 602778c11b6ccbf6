"""`ingest`: raw files into the store."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal.common import Session, as_shown, command, plain
from thermodata.report.text.table import fields, table
from thermodata.report.words.causes import said_at_ingest
from thermodata.schema.words.sentences import with_count

if TYPE_CHECKING:
    from thermodata.store import Store

_NAMED = 4
_MOSTLY = 0.5  # of the square of an uncertainty


@command("ingest")
@click.argument("campaign", type=click.Path(path_type=Path))
@click.option(
    "--replace", is_flag=True, help="Take the tests and logs of another campaign with the same id out of the store."
)
def ingest_command(session: Session, campaign: Path, replace: bool) -> int:
    """Bring CAMPAIGN.yaml and its raw files into the store.

    Safe to repeat: files that did not change are not read again, and after an edit of the campaign file only
    what depends on the edit is made anew. A campaign of which the store holds another one by that id is refused.
    Exit code 3 says that a part of a file could not be read.
    """
    from thermodata.cli.terminal.progress import progress_line
    from thermodata.draft.writing.baseline import model_text_of
    from thermodata.draft.writing.seal import is_as_sealed
    from thermodata.report.text.after_ingest import next_step
    from thermodata.schema.files.load import load_campaign
    from thermodata.store.ingest.run import ingest, store_for

    store = store_for(session.store_path, campaign)
    with progress_line() as line:
        summary = plain(ingest(store, campaign, progress=line, in_its_place=replace).to_json())
    session.answer(summary, lambda: as_shown(ingest_text(summary, _labels(store, summary["stale"]))))
    step = next_step(store, summary, campaign, lambda: model_text_of(load_campaign(campaign)), is_as_sealed)
    if step is not None:
        session.say(step)
    return 3 if summary["losses"] else 0


def _labels(store: Store, models: list[str]) -> list[str]:
    """Each by its name and version, with its id; without a look where there are none."""
    from thermodata.view.lists.models import model_rows

    rows = {m.model: m for m in model_rows(store)} if models else {}
    return [f"{rows[m].name} {rows[m].version} {m}" if m in rows else m for m in models]


def ingest_text(summary: dict[str, Any], stale: Sequence[str]) -> str:
    """The summary of an ingest for a person: counts, calibrations, flags, losses, notes. stale: models, in words."""
    from thermodata.schema.words.sentences import counted

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
                *([("stale models", list(stale))] if stale else []),
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
            "ok": _checks_hold(row),
            "offset": _offset(row),
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
            *([("offset", "offset")] if any(row["offset"] for row in shown) else []),
            ("sign", "sign"),
            ("uncertainty_pct", "± (k=1) [%]"),
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
    return "\n".join([text, *failed, *_of_the_moves(shown, several)])


def _offset(row: dict[str, Any]) -> str | None:
    """What is added after the gain; None where nothing is, and of a jump test, which finds no zero."""
    offset, detail = row.get("offset_value"), row.get("detail") or {}
    if not offset or row["kind"] not in ("scale", "linear"):
        return None
    return f"{offset:g} {detail.get('offset_unit') or detail.get('unit_out') or ''}".rstrip()


def _of_the_moves(rows: list[dict[str, Any]], several: bool) -> list[str]:
    """Which uncertainties are mostly that of the commanded moves, which the campaign file says or leaves at 1 um."""
    from itertools import accumulate

    from thermodata.calibration.jump.limits import MOVES

    named: dict[float, list[str]] = {}
    for row in rows:
        of_one, moves = row.get(MOVES), (row.get("detail") or {}).get("moves_um")
        if of_one and moves and row.get("uncertainty_pct"):
            levels = [0.0, *accumulate(moves)]
            share = 100.0 * of_one / (max(levels) - min(levels)) / row["uncertainty_pct"]
            if share**2 > _MOSTLY:
                campaign = f"{row['campaign']}/" if several else ""
                named.setdefault(of_one, []).append(f"{campaign}{row['calibration']}")
    return [
        f"  ± of {with_count(names, _NAMED)}: mostly move_uncertainty, {of_one:g} um a move (1 um where the campaign "
        "file says nothing): write there what the axis positions to"
        for of_one, names in named.items()
    ]


def _checks_hold(row: dict[str, Any]) -> str:
    """Whether the checks hold; of a gain that was declared, and no jump test measured, only what was declared was held
    against itself."""
    if not all(c.get("passed", True) for c in row.get("checks") or []):
        return "failed"
    return "passed" if row["kind"] == "jump" else "not measured"


def _number(value: Any) -> str:
    return f"{value:,}".replace(",", " ") if isinstance(value, int) else str(value)
