"""`schema`: the published documents, and the check that they are what the code says."""

from __future__ import annotations

from pathlib import Path

import click

from thermodata.cli.terminal.common import Session, command
from thermodata.errors import ThermodataError, unknown_name


@command("schema")
@click.argument("document", required=False)
@click.option(
    "--docs",
    is_flag=True,
    help="The generated pages of docs/ (effects.md, places.md) in place of the schemas.",
)
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
def schema_command(session: Session, document: str | None, docs: bool, write: Path | None, check: Path | None) -> None:
    """Print, write or check the published documents.

    JSON Schema of campaign and model files and of results, SQL of the store. Without DOCUMENT: their names.
    With --docs: the pages on effects, places and quantities that are generated from the code.
    """
    texts = pages() if docs else documents()
    if write is not None:
        write.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (write / name).write_text(text, encoding="utf-8")
            session.say(f"wrote {write / name}")
    if check is not None:
        # the folder docs holds pages written by hand too
        differ = differences(check, texts, alone=not docs)
        if differ:
            raise ThermodataError(
                f"{', '.join(differ)} differ from the code",
                where=str(check),
                hint=f"thermodata schema {'--docs ' if docs else ''}--write {check}",
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
    from thermodata.store.catalogue.format.ddl import FORMAT, TABLES

    head = f"-- Tables of a thermodata store, format {FORMAT}. Generated: thermodata schema --write schemas\n"
    return {**publish.documents(), "store.sql": head + TABLES}


def pages() -> dict[str, str]:
    """File name -> text of every page of docs/ that is generated from the code."""
    from thermodata.effect import publish
    from thermodata.schema import publish_places

    return {"effects.md": publish.text(), "places.md": publish_places.text()}


def differences(folder: Path, texts: dict[str, str], *, alone: bool = True) -> list[str]:
    """Names of documents that are missing in the folder or differ from it; and, where they are to stand there alone,
    of files without a source."""
    wrong = [
        name
        for name, text in texts.items()
        if not (folder / name).is_file() or (folder / name).read_text(encoding="utf-8") != text
    ]
    there = {path.name for path in folder.glob("*") if path.is_file()} if alone and folder.is_dir() else set()
    return wrong + sorted(there - set(texts))
