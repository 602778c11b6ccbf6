"""`report` and `workbench`: the same results as a page."""

from __future__ import annotations

import sys
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command
from thermodata.cli.terminal.stored_model import resolve

if TYPE_CHECKING:
    from thermodata.web.desk import Desk


@command("report")
@click.argument("model", required=False, shell_complete=completing.models)
@click.option(
    "--out",
    "-o",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="The page to write (default: report-MODEL.html).",
)
def report_command(session: Session, model: str | None, out: Path | None) -> None:
    """Write one self-contained HTML page about MODEL.

    Fit, residuals, weak spots, diagnosis, history. It needs no network and can be mailed. Of the model fitted
    last where none is named.
    """
    from thermodata.report import build_report
    from thermodata.report.page.write import page_name
    from thermodata.store.catalogue.models.fits import find_model

    store = session.store()
    found = find_model(store, resolve(store, model, session))
    page = build_report(store, found.model, out or Path(page_name(found.name, found.model)))
    session.answer({"model": found.model, "report": str(page), "bytes": page.stat().st_size}, lambda: str(page))


@command("workbench")
@click.argument("folder", required=False, type=click.Path(path_type=Path), metavar="[STORE|FOLDER]")
@click.option("--write", is_flag=True, help="Let the pages change the store: add effects, ingest, draft.")
@click.option("--port", default=0, show_default="any free one", type=click.IntRange(0, 65535), help="Port to open.")
@click.option("--no-browser", is_flag=True, help="Print the address only.")
def workbench_command(session: Session, folder: Path | None, write: bool, port: int, no_browser: bool) -> None:
    """Open the local web page.

    Of a store, or of a folder of raw logs. It listens on 127.0.0.1 only; the printed address lets one browser in, once.
    """
    from thermodata.web.serve import serve, ticket_address

    # what is named in the call is meant; the environment says only which store it is where nothing else does
    named = session.store_path if session.store_named else None
    otherwise = None if session.store_named or session.store_by_default else session.store_path

    def opened(desk: Desk) -> None:
        address = ticket_address(desk)
        payload = {"address": address, "port": desk.port, "store": str(desk.store_path), "write": desk.write}
        session.answer(payload, lambda: address)
        if otherwise is not None and desk.store_path != otherwise.absolute():
            session.say(f"of {desk.store_path}, and not of THERMODATA_STORE ({otherwise})")
        session.say("it runs until Ctrl+C; the address works once")
        sys.stdout.flush()
        if not no_browser:
            webbrowser.open(address)

    serve(folder, named, write=write, port=port, opened=opened, otherwise=otherwise)
