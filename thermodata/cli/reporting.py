"""`report` and `workbench`: the same results as a page."""

from __future__ import annotations

from pathlib import Path

import click

from thermodata.cli.common import Session, command
from thermodata.cli.fitting import resolve
from thermodata.errors import UsageError


@command("report")
@click.argument("model")
@click.option(
    "--out",
    "-o",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="The page to write (default: report-MODEL.html).",
)
def report_command(session: Session, model: str, out: Path | None) -> None:
    """Write one self-contained HTML page about MODEL.

    Fit, residuals, weak spots, diagnosis, history. It needs no network and can be mailed.
    """
    from thermodata.report import build_report
    from thermodata.store.catalogue.models import find_model

    store = session.store()
    found = find_model(store, resolve(store, model))
    page = build_report(store, found.model, out or Path(f"report-{found.name}-{found.model[:8]}.html"))
    session.answer({"model": found.model, "report": str(page), "bytes": page.stat().st_size}, lambda: str(page))


@command("workbench")
def workbench_command(session: Session) -> None:
    """Open the local web page."""
    raise UsageError("'workbench' is not supported yet", hint="thermodata report MODEL writes a page to look at")
