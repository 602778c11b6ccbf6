"""Before the store: draft a campaign file, ask who reads a file, look at what would be ingested."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from thermodata.cli.common import Session, command, plain
from thermodata.cli.table import table
from thermodata.errors import UsageError

_FILE = click.Path(path_type=Path, exists=True, dir_okay=False)


@command("init")
@click.argument("folder", type=click.Path(path_type=Path, exists=True, file_okay=False))
def init_command(session: Session, folder: Path) -> None:
    """Draft FOLDER/campaign.yaml from the raw files found there.

    It groups files into sources and tests, reads signals and units, guesses quantities and places, finds jump tests,
    and says how sure it is; what only you know is marked '# ?'. An existing campaign.yaml is never touched.
    """
    from thermodata.draft.answer import as_json
    from thermodata.draft.plan import plan
    from thermodata.draft.scan import scan
    from thermodata.draft.write import questions_in, text_of
    from thermodata.schema.load import load_campaign

    out = folder / "campaign.yaml"
    if out.exists():
        raise UsageError("the campaign file exists, and is never overwritten", where=str(out),
                         hint="rename it, then draft again and compare the two")
    found = scan(folder, _progress(session))
    if not found.logs:
        raise UsageError("no file that a reader claims", where=str(folder), expected="raw logs",
                         got="; ".join(f"{p}: {w}" for p, w in found.ignored[:5]) or "nothing",
                         hint="thermodata plugins lists the installed readers; thermodata sniff FILE says more")
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", plain_name(folder.resolve().name)).strip("-._")[:100] or "campaign"
    draft = plan(name, folder, found)
    text = text_of(draft)
    _write_new(out, text)
    load_campaign(out)                           # a draft that doesn't load is a defect: it raises here
    asked = questions_in(text)
    session.say(f"{len(found.logs)} files, {len(draft.tests)} tests, {len(draft.sources)} sources, "
                f"{sum(c.said.quantity is not None for c in draft.channels)} channels; {asked} lines hold a question: "
                f"grep '# ?' {out}")
    session.answer(as_json(draft, out, len(found.logs), asked), lambda: str(out))


def plain_name(text: str) -> str:
    """A folder's name in plain letters, in any script."""
    from thermodata.draft.words import plain

    return text if text.isascii() else plain(text)


def _write_new(out: Path, text: str) -> None:
    """Writes a file that must not be there yet, not even since a moment ago."""
    try:
        with out.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise UsageError("the campaign file exists, and is never overwritten", where=str(out)) from None
    except OSError as error:
        raise UsageError("cannot write the draft", where=str(out), got=error.strerror or str(error)) from None


def _progress(session: Session) -> Callable[[int, int, str], None] | None:
    """A line on stderr that renews itself, on a terminal only."""
    if session.as_json or not sys.stderr.isatty():
        return None

    def tell(done: int, of: int, path: str) -> None:
        end = "\r" if done + 1 < of else "\r\x1b[K"
        click.echo(f"\x1b[K{done + 1}/{of} {path[:60]}{end}", err=True, nl=False)

    return tell


@command("sniff")
@click.argument("files", nargs=-1, required=True, type=_FILE, metavar="FILE...")
def sniff_command(session: Session, files: tuple[Path, ...]) -> int:
    """Say which reader claims each FILE, and why.

    Exit code 2 where none or several do.
    """
    from thermodata.reader import claims, readers

    rows: list[dict[str, Any]] = []
    for path in files:
        found = claims(path)
        rows.append({"file": str(path), "reader": next(iter(found)) if len(found) == 1 else None, "claims": found})
    known = ", ".join(sorted(readers()))

    def why(row: dict[str, Any]) -> str:
        return "; ".join(f"{k}: {v}" for k, v in row["claims"].items()) or f"no reader claims it (installed: {known})"

    session.answer(rows, lambda: table(
        [{"file": r["file"], "reader": r["reader"] or ("several" if r["claims"] else "none"), "why": why(r)}
         for r in rows], [("file", "file"), ("reader", "reader"), ("why", "why")], widest=100))
    return 0 if all(row["reader"] for row in rows) else 2


@command("preview")
@click.argument("file", type=_FILE)
@click.option("--reader", "name", help="Use this reader (default: the one that claims FILE).")
@click.option("--timezone", help="IANA zone of local times, for example Europe/Prague.")
@click.option("--rows", default=5, show_default=True, type=click.IntRange(0, 1000), help="Rows of each stream.")
def preview_command(session: Session, file: Path, name: str | None, timezone: str | None, rows: int) -> None:
    """Show what would be read from FILE.

    Its clock, its signals with their units, and the first rows of each stream.
    """
    from thermodata.cli.preview import preview, preview_text

    found = plain(preview(file, name, timezone, rows))
    session.answer(found, lambda: preview_text(found))
