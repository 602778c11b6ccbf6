"""Before the store: draft a campaign file, ask who reads a file, look at what would be ingested."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.common import Session, command, plain
from thermodata.cli.table import table
from thermodata.errors import ThermodataError, UsageError

if TYPE_CHECKING:
    from thermodata.cli.draft import RawFile

_FILE = click.Path(path_type=Path, exists=True, dir_okay=False)


@command("init")
@click.argument("folder", type=click.Path(path_type=Path, exists=True, file_okay=False))
@click.option("--force", is_flag=True, help="Replace FOLDER/campaign.yaml where it exists.")
def init_command(session: Session, folder: Path, force: bool) -> None:
    """Draft FOLDER/campaign.yaml from the raw files found there.

    It groups files, lists signals and guesses quantities and places; what you should look at is marked '# ?'.
    """
    from thermodata.cli.draft import draft
    from thermodata.schema.load import load_campaign

    out = folder / "campaign.yaml"
    if out.exists() and not force:
        raise UsageError("the campaign file exists", where=str(out), hint="--force replaces it")
    files, ignored = find_raw(folder)
    if not files:
        raise UsageError("no file that a reader claims", where=str(folder),
                         expected="raw logs", got="; ".join(f"{p}: {w}" for p, w in ignored[:5]) or "nothing",
                         hint="thermodata plugins lists the installed readers; thermodata sniff FILE says more")
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", folder.resolve().name).strip("-._") or "campaign"
    text = draft(name, files, ignored)
    out.write_text(text, encoding="utf-8")
    load_campaign(out)                           # a draft that doesn't load is a defect: it raises here
    result = {"campaign": str(out), "files": len(files), "questions": text.count("# ?"),
              "ignored": [{"file": p, "why": w} for p, w in ignored]}
    session.say(f"{len(files)} files, {result['questions']} lines with questions: grep '# ?' {out}")
    session.answer(result, lambda: str(out))


def find_raw(folder: Path) -> tuple[list[RawFile], list[tuple[str, str]]]:
    """(files that a reader describes, (path, why not) of the others); hidden files and stores are skipped."""
    from thermodata.cli.draft import RawFile
    from thermodata.plugin import Source
    from thermodata.reader import sniff

    files, ignored = [], []
    for path in sorted(folder.rglob("*")):
        inside = PurePosixPath(path.relative_to(folder).as_posix())
        hidden = any(p.startswith(".") or p.endswith(".store") for p in inside.parts)
        if hidden or not path.is_file() or path.is_symlink() or path.suffix in (".yaml", ".yml", ".md"):
            continue
        try:
            reader = sniff(path)
            files.append(RawFile(inside, reader.name, reader.describe(path, Source())))
        except ThermodataError as error:
            ignored.append((str(inside), error.what))
    return files, ignored


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
