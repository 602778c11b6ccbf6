"""`diagnose`: which physical effect is missing."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command, in_units_of
from thermodata.cli.terminal.stored_model import resolve, with_stale
from thermodata.report.text.confirmed import confirmed_text
from thermodata.report.text.diagnosis import diagnosis_text

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store import Store


KNOWN = "from the store: this was looked at before, and nothing has changed since"
SHORTEST_ID = 4  # characters that name a model by the beginning of its id; a shorter number is a rank


@command("diagnose")
@click.argument("model", required=False, shell_complete=completing.models)
@click.option("--top", default=8, show_default=True, type=click.IntRange(1), help="Most candidates of the table.")
@click.option("--response", metavar="CHANNEL", help="Of a model with several: ask of this one.")
def diagnose_command(session: Session, model: str | None, top: int, response: str | None) -> None:
    """Say which physical effect MODEL misses.

    Or that none is missing, that what MODEL has can be refined, or that these tests can't tell.

    A candidate is claimed only if all evidence holds; locked tests are opened only for what is claimed or likely, and
    counted. Of the model fitted last where none is named. Of a model with several responses one is asked, that of which
    the largest share is left, or --response; whose ranks the last answer has, add and confirm take.
    """
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.diagnosis.run import question

    store = session.store()
    ref = resolve(store, model, session, guess=False)
    _say_what_was_open(store, ref)
    asked = question(store, ref, response)
    found = asked.kept()
    if found is not None:
        click.echo("from the store: model, data, effects and rules are as they were", err=True)
    else:
        before = _answered_before(store, ref, response)
        with counting_line() as tell:
            found = asked.answered(tell)
        if said := _said_otherwise(before, found):
            click.echo(in_units_of(session, found.response, said), err=True)
    payload = with_stale(store, found.model, found)
    session.answer(payload, lambda: in_units_of(session, found.response, diagnosis_text(found, top)))


@command("confirm")
@click.argument("model", shell_complete=completing.models)
@click.argument("candidates", nargs=-1, metavar="[CANDIDATE | MODEL...]", shell_complete=completing.candidates)
@click.option("--response", metavar="CHANNEL", help="Of a model with several: by default that which was diagnosed.")
def confirm_command(session: Session, model: str, candidates: tuple[str, ...], response: str | None) -> None:
    """Ask the locked tests for an effect of your choice, or for whole models.

    CANDIDATE is its rank or id, as diagnose printed them, or any effect:channels. MODEL is fitted to all open tests
    without and with it, and both are scored on the locked ones. Every look is counted; asking the same again is none.

    Without a candidate each MODEL is scored on the locked tests as it stands: as tests are scored, and about each
    test's mean. The JSON is a list, a row a model and response.
    """
    from thermodata.diagnosis.choice import confirm_choice

    store = session.store()
    if len(candidates) != 1 or _is_model(store, candidates[0]):
        _answer_locked(session, store, (model, *candidates), response)
        return
    ref = resolve(store, model, guess=False)
    _say_what_was_open(store, ref)
    result, known = confirm_choice(store, ref, candidates[0], response)
    if known:
        click.echo(KNOWN, err=True)
    payload = with_stale(store, result.model, result)
    session.answer(payload, lambda: in_units_of(session, result.response, confirmed_text(result)))


def _is_model(store: Store, text: str) -> bool:
    """Whether a word stands for a model: a candidate is a rank, or names its channels after a colon."""
    from thermodata.errors import UsageError
    from thermodata.modelling.named import is_file
    from thermodata.store.catalogue.models.fits import find_model

    if ":" in text or (text.isdigit() and len(text) < SHORTEST_ID):
        return False
    with suppress(UsageError):
        return is_file(text) or bool(find_model(store, text).model)
    return False


def _answer_locked(session: Session, store: Store, refs: tuple[str, ...], response: str | None) -> None:
    """Each model as it stands on the locked tests."""
    from thermodata.modelling.on_locked import locked_errors
    from thermodata.report.text.locked_error import locked_text

    models = [resolve(store, ref, guess=False) for ref in refs]
    asked = [locked_errors(store, ref, response) for ref in dict.fromkeys(models)]
    for ref in dict.fromkeys(models):
        _say_what_was_open(store, ref)
    found = [row for rows, _ in asked for row in rows]
    if all(known for _, known in asked):
        click.echo(KNOWN, err=True)
    session.answer([with_stale(store, row.model, row) for row in found], lambda: locked_text(found))


def _answered_before(store: Store, ref: str, response: str | None) -> Diagnosis | None:
    """What the store holds of this question, whatever it was made from."""
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store.catalogue.format.document import read_document
    from thermodata.store.catalogue.models.findings import kept_answer
    from thermodata.store.catalogue.models.fits import find_model

    model = find_model(store, ref).model
    kept = kept_answer(store, model, "diagnose" if response is None else f"diagnose {response}")
    return None if kept is None else read_document(Diagnosis, kept, f"the diagnosis of {model}")


def _said_otherwise(before: Diagnosis | None, now: Diagnosis) -> str | None:
    """That an earlier answer to the same question was another one, and why; None where it said the same."""
    from thermodata.report.text.clauses import clauses
    from thermodata.report.verdict.verdict import verdict_sentence

    if before is None or verdict_sentence(before) == verdict_sentence(now):
        return None
    if before.data_version is None:
        why = "the data, the rules of the diagnosis or the effects"
    elif before.data_version != now.data_version:
        why = "the data"
    else:
        why = "the rules of the diagnosis, the effects or what is known of the locked tests"
    head = clauses(verdict_sentence(before))[0]
    return f"asked anew, for {why} changed since the store's answer, which was another one: {head}"


def _say_what_was_open(store: Store, ref: str) -> None:
    """Locked tests that were open when a model was fitted: what they confirm is not new to what came of it."""
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.catalogue.models.looks import open_in

    found = open_in(store, find_model(store, ref).spec.campaign_ids)
    if found:
        told = "; ".join(f"{test} ({', '.join(models)})" for (_, test), models in found.items())
        click.echo(f"locked now, but open when these were fitted or chosen: {told}", err=True)
