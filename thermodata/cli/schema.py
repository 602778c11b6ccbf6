"""`schema`: the published documents, and the check that they are what the code says."""

from __future__ import annotations

from pathlib import Path

import click

from thermodata.cli.common import Session, command
from thermodata.errors import ThermodataError, unknown_name


@command("schema")
@click.argument("document", required=False)
@click.option(
    "--write",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="FOLDER",
    help="Write all documents into FOLDER.",
)
@click.option(
    "--check",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="FOLDER",
    help="Compare FOLDER with the code; exit code 1 names what differs.",
)
def schema_command(session: Session, document: str | None, write: Path | None, check: Path | None) -> None:
    """Print, write or check the published documents.

    JSON Schema of campaign and model files and of results, SQL of the store. Without DOCUMENT: their names.
    """
    texts = documents()
    if write is not None:
        write.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (write / name).write_text(text, encoding="utf-8")
            session.say(f"wrote {write / name}")
    if check is not None:
        differ = differences(check, texts)
        if differ:
            raise ThermodataError(
                f"{', '.join(differ)} differ from the code", where=str(check), hint=f"thermodata schema --write {check}"
            )
        session.say(f"{check}: {len(texts)} documents match the code")
    if document is not None:
        if document not in texts:
            raise unknown_name("document", document, list(texts))
        session.answer({document: texts[document]}, lambda: texts[document].rstrip())
    elif write is None and check is None:
        session.answer(texts, lambda: "\n".join(texts))


def documents() -> dict[str, str]:
    """File name -> text of every published document; the store's floor gives its SQL, `schema` the rest."""
    from thermodata.schema import publish
    from thermodata.store.catalogue.ddl import FORMAT, TABLES

    head = f"-- Tables of a thermodata store, format {FORMAT}. Generated: thermodata schema --write schemas\n"
    return {**publish.documents(), "store.sql": head + TABLES}


def differences(folder: Path, texts: dict[str, str]) -> list[str]:
    """Names of documents that are missing in the folder, differ from it, or stand there without a source."""
    wrong = [
        name
        for name, text in texts.items()
        if not (folder / name).is_file() or (folder / name).read_text(encoding="utf-8") != text
    ]
    there = {path.name for path in folder.glob("*") if path.is_file()} if folder.is_dir() else set()
    return wrong + sorted(there - set(texts))
