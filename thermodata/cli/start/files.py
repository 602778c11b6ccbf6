"""Before the store: draft a campaign file, ask who reads a file, look at what would be ingested."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal.common import Session, command, plain
from thermodata.errors import UsageError
from thermodata.report.text.table import table
from thermodata.schema.words.sentences import with_count

if TYPE_CHECKING:
    from thermodata.draft.make import Drafted

_SAID = 5  # files that can't be read, each with its reason
_FILE = click.Path(path_type=Path, exists=True, dir_okay=False)


class _LogPath(click.Path):
    """A path of a file, or of one in an archive: 'day.zip/run.csv'."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        from thermodata.archive.members import archive_of

        if archive_of(Path(value)) is not None:
            return Path(value)
        return super().convert(value, param, ctx)


@command("init")
@click.argument("folder", type=click.Path(path_type=Path, exists=True, file_okay=False))
@click.option("--force", is_flag=True, help="Draft anew: an existing campaign.yaml is kept as campaign.1.yaml.")
def init_command(session: Session, folder: Path, force: bool) -> int:
    """Draft campaign.yaml and a first model.yaml from the raw files of FOLDER.

    It groups files into sources and tests, reads signals and units, guesses quantities and places, takes conditions
    from the names, finds jump tests, and says how sure it is; what only you know is marked '# ?'. What is there is
    never overwritten. Exit code 3 where a reader does not load: its files are missing, or read by another one.
    """
    from thermodata.draft.make import draft_files
    from thermodata.draft.writing.answer import as_json
    from thermodata.draft.writing.baseline import responses_of_draft
    from thermodata.draft.writing.write import one_line
    from thermodata.reader.finding.registry import failed_readers
    from thermodata.schema.words.sentences import counted
    from thermodata.store.catalogue.campaign_paths import campaign_paths

    made = draft_files(folder, force=force, progress=_progress(session), held=campaign_paths(session.store_path))
    if made.id_taken is not None:
        other, path = made.id_taken
        session.say(f"its id is '{made.draft.campaign}': the store holds another campaign '{other}' ({path})")
    for before, after in made.kept:
        session.say(f"the {before.name} that was there is now {after}")
    if made.model is not None:
        session.say(_model_of(made, *responses_of_draft(made.draft)))
        _say_left_out(session, made.left_out, made.model)
    if made.no_model is not None:
        session.say(made.no_model)
    draft = made.draft
    reasons = dict(draft.not_used)
    for path, _ in draft.failed[:_SAID]:
        session.say(f"{path}: {reasons[path]}")
    if len(draft.failed) > _SAID:
        session.say(
            f"{counted(len(draft.failed) - _SAID, 'more file')} that a reader claims and can't read: the draft "
            "names them"
        )
    if not draft.sources:
        whose = "no file of {} could be read" if draft.failed else "no reader claims any file of {}"
        session.say(f"{whose.format(folder)}: the draft names them, and what would help")
    elif draft.unused:
        named = with_count(map(one_line, draft.unused), _SAID)
        session.say(
            f"{len(draft.unused)} of {counted(made.seen, 'file')} {'is' if len(draft.unused) == 1 else 'are'} "
            f"not used ({named}): the end "
            f"of {made.campaign.name} says why"
        )
    if draft.machines.asked is not None:
        session.say(one_line(draft.machines.asked))
    session.say(
        f"{counted(made.files, 'file')}, {counted(len(draft.tests), 'test')}, {counted(len(draft.sources), 'source')}, "
        f"{counted(sum(c.said.quantity is not None for c in draft.channels) + len(draft.derived), 'channel')}; "
        f"{counted(made.questions, 'line', 'holds', 'hold')} a question: "
        f"grep '# ? ' {made.campaign}"
    )
    model = _first_model(made)
    session.say(_next_steps(made, model))
    answer = as_json(draft, made.campaign, made.files, made.questions, model)
    session.answer(answer, lambda: str(made.campaign))
    return 3 if failed_readers() else 0


@command("first-model")
@click.argument("campaign", type=_FILE)
@click.option("--response", metavar="CHANNEL", help="The displacement that it explains; by default the tool's along Z.")
def first_model_command(session: Session, campaign: Path, response: str | None) -> None:
    """Draft model.yaml of CAMPAIGN, for a displacement of your choice.

    From the campaign file as it stands, with the places that were answered since its draft: one plain effect for each
    sensor that stands where it acts. A model.yaml that somebody changed is kept as model.1.yaml; one that stands as
    drafted gives way, which is said where it is of another displacement.
    """
    from thermodata.draft.make import first_model

    made = first_model(campaign, response)
    others = ", ".join(r for r in made.responses if r != made.response)
    instead = f" in place of that of {made.replaced}, which stood as drafted" if made.replaced else ""
    session.say(f"a first model of {made.response}{instead}" + (f"; --response takes {others} too" if others else ""))
    if made.replaced:
        session.say(
            f"to have both: move {made.model} away, then thermodata first-model {campaign} --response {made.replaced}"
        )
    if made.kept is not None:
        session.say(f"the model.yaml that was there is now {made.kept}")
    _say_left_out(session, made.left_out, made.model)
    session.answer(
        {
            "model": str(made.model),
            "response": made.response,
            "responses": list(made.responses),
            "kept": None if made.kept is None else str(made.kept),
            "replaced": made.replaced,
        },
        lambda: str(made.model),
    )


def _model_of(made: Drafted, first: str, *others: str) -> str:
    """Which displacement the first model is of, and how one of another is drafted."""
    said = f"a first model of what the sensors explain of {first}: {made.model}"
    if not others:
        return said
    are = "is" if len(others) == 1 else "are"
    command = f"thermodata first-model {made.campaign} --response {others[0]}"
    return f"{said}; {' and '.join(others)} {are} measured too: {command}"


def _say_left_out(session: Session, channels: Sequence[str], model: Path) -> None:
    """What is logged and drives nothing, of which each has its reason in the model file."""
    if channels:
        session.say(f"logged, and driving nothing in it: {', '.join(channels)}; the end of {model.name} says why")


def _next_steps(made: Drafted, model: Path | None) -> str:
    """What to type once the questions are answered."""
    draft_it = f"thermodata first-model {made.campaign}, " if model is None else ""
    fitted = made.campaign.with_name("model.yaml")
    answer = "answer the '# ?', then " if made.questions else ""
    return f"next: {answer}thermodata ingest {made.campaign}, {draft_it}thermodata fit {fitted}"


def _first_model(made: Drafted) -> Path | None:
    """The model file that is there now, drafted or older; None where the sensors allow none."""
    return made.campaign.with_name("model.yaml") if made.no_model is None else None


def _progress(session: Session) -> Callable[[int, int, str], None] | None:
    """A line on stderr that renews itself, on a terminal only."""
    if session.as_json or not sys.stderr.isatty():
        return None

    def tell(done: int, of: int, path: str) -> None:
        end = "\r" if done + 1 < of else "\r\x1b[K"
        click.echo(f"\x1b[K{done + 1}/{of} {path[:60]}{end}", err=True, nl=False)

    return tell


@command("sniff")
@click.argument("files", nargs=-1, required=True, type=_LogPath(path_type=Path, exists=True), metavar="FILE...")
def sniff_command(session: Session, files: tuple[Path, ...]) -> int:
    """Say which reader claims each FILE, and why the others do not.

    What to declare is said where that helps. FILE may be a folder: then all files in it, but for stores. Exit code 2
    where none or several readers claim a file, 3 where a reader does not load, so that another may claim its files.
    """
    from thermodata.reader.finding.explain import explain
    from thermodata.reader.finding.registry import failed_readers

    found = [explain(path) for path in _files_below(files)]
    if not found:
        raise UsageError(
            "no file in the folder",
            where=", ".join(map(str, files)),
            hint="name the logs themselves, or the folder that holds them",
        )
    rows = [
        {
            "file": e.file,
            "size_bytes": e.size_bytes,
            "kind": e.kind,
            "reader": e.reader,
            "claims": e.claims,
            "others": e.others,
            "advice": e.advice,
        }
        for e in found
    ]
    session.answer(rows, lambda: "\n\n".join(map(_explained, rows)) if len(rows) <= 5 else _summary(rows))
    return 2 if not all(e.reader for e in found) else 3 if failed_readers() else 0


def _files_below(given: tuple[Path, ...]) -> list[Path]:
    """Files as given, and those in archives; of a folder all below it, without hidden ones, links and what a store
    holds."""
    from thermodata.reader.files.stores import is_store, within_stores
    from thermodata.reader.finding.registry import files_in

    found: list[Path] = []
    for path in given:
        if path.is_dir():
            if is_store(path):
                continue
            in_store = within_stores(path)
            found += sorted(
                inside
                for p in path.rglob("*")
                if p.is_file()
                and not p.is_symlink()
                and not in_store(p)
                and not any(part.startswith(".") for part in p.relative_to(path).parts)
                for inside in files_in(p)
            )
        else:
            found += files_in(path)
    return list(dict.fromkeys(found))


def _explained(row: dict[str, Any]) -> str:
    who = row["reader"] or ("several readers" if row["claims"] else "no reader")
    lines = [f"{row['file']}: {who}", f"  it is    {row['kind']}"]
    lines += [f"  yes      {name}: {why.removeprefix(f'{name}: ')}" for name, why in row["claims"].items()]
    lines += [f"  no       {name}: {why.removeprefix('no; ')}" for name, why in row["others"].items()]
    return "\n".join(lines + ([f"  try      {row['advice']}"] if row["advice"] else []))


def _summary(rows: list[dict[str, Any]]) -> str:
    """One line a file, for many files."""

    def why(row: dict[str, Any]) -> str:
        return "; ".join(f"{k}: {v.removeprefix(f'{k}: ')}" for k, v in row["claims"].items()) or row["kind"]

    return (
        table(
            [
                {"file": r["file"], "reader": r["reader"] or ("several" if r["claims"] else "none"), "why": why(r)}
                for r in rows
            ],
            [("file", "file"), ("reader", "reader"), ("why", "why")],
            widest=100,
        )
        + "\n\nname up to five files for every reader's answer"
    )


@command("preview")
@click.argument("file", type=_LogPath(path_type=Path, exists=True, dir_okay=False))
@click.option("--reader", "name", metavar="READER", help="Use this reader (default: the one that claims FILE).")
@click.option("--timezone", metavar="ZONE", help="IANA zone of local times, for example Europe/Prague.")
@click.option("--rows", default=5, show_default=True, type=click.IntRange(0, 1000), help="Rows of each stream.")
@click.option(
    "--campaign",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="Read FILE as this campaign file declares it (default: the campaign.yaml beside or above it).",
)
def preview_command(
    session: Session, file: Path, name: str | None, timezone: str | None, rows: int, campaign: Path | None
) -> None:
    """Show what would be ingested from FILE, and what would be flagged.

    Its clock and time zone, signals with units and their course, rate, gaps, losses, flags, and first rows. Stores
    nothing; of a large file it reads a part, and says so.
    """
    from thermodata.cli.start.preview_text import preview_text, previewed

    found = previewed(file, name, timezone, rows, campaign)
    session.answer(found, lambda: preview_text(plain(found)))
