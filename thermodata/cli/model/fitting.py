"""Versions of a model: fitted, with an effect more, with one less."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command, in_units_of
from thermodata.cli.terminal.stored_model import resolve, with_stale
from thermodata.modelling.versions.same_tests import note_on_the_same_tests
from thermodata.report.text.added import before_after_text, made_worse
from thermodata.report.text.fit import fit_text

if TYPE_CHECKING:
    from thermodata.schema.answers.result import FitResult


@command("fit")
@click.argument("model", shell_complete=completing.models)
def fit_command(session: Session, model: str) -> None:
    """Fit MODEL and print its id.

    MODEL is a model file, or a fitted model that is fitted again after its data changed: its id, or its name, as
    CAMPAIGN/NAME where several campaigns have a model of that name.
    """
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.modelling.named import fit_named, name_taken_over
    from thermodata.store.base.counting import watched

    store = session.store()
    with counting_line() as tell, watched(tell):
        result = fit_named(store, model)
    session.answer(result, lambda: in_units_of(session, result.response, fit_text(result)))
    for note in (*result.notes, name_taken_over(store, result.model)):
        if note is not None:
            session.say(note)


@command("add")
@click.argument("model", shell_complete=completing.models)
@click.argument("candidate", nargs=-1, required=True, shell_complete=completing.candidates)
@click.option("--plain", is_flag=True, help="Add what is named, each with one time constant, and no more.")
def add_command(session: Session, model: str, candidate: tuple[str, ...], plain: bool) -> None:
    """Make a new version of MODEL with an effect more.

    CANDIDATE is its rank or id, as diagnose printed them, or several of them; gain_by:EFFECT,CONDITION gives an effect
    of MODEL a gain for each value of a condition, phases:EFFECT,heating,cooling parts it into one for each phase, and
    step:TEST takes out the steps of a probe that diagnose told of this test.
    Where tests that are left out of the fit want it, the effects and those that MODEL has get a second lag, for a part
    of a machine answers heat by a quick share and a slow one.
    Prints the errors before and after.
    """
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.modelling.add import add
    from thermodata.store.base.counting import watched
    from thermodata.view.lists.response_units import response_units

    store = session.store()
    with counting_line() as tell, watched(tell):
        parent = resolve(store, model, guess=False)
        result = add(store, parent, *candidate, plain=plain)
    _answer_version(session, result, result.parent or parent)
    worse = made_worse(result, response_units(store, result.responses, result.campaigns))
    if worse is not None:
        session.say(worse)


def _answer_version(session: Session, result: FitResult, parent: str) -> None:
    """A version beside the one before it, and what to know of it. parent: the model that was asked for."""

    def text() -> str:
        return in_units_of(session, result.response, f"{before_after_text(result)}\n\n{fit_text(result, scores=False)}")

    session.answer(with_stale(session.store(), parent, result), text)
    told = "" if session.as_json else note_on_the_same_tests(result.notes)
    for note in result.notes:
        if note != told:
            session.say(note)


@command("remove")
@click.argument("model", shell_complete=completing.models)
@click.argument("effect", shell_complete=completing.effects_of_model)
def remove_command(session: Session, model: str, effect: str) -> None:
    """Make a new version of MODEL without an effect.

    EFFECT is its id in the model, as fit printed it, or its name where that is one effect only. Its second lag goes
    with it. Prints the errors before and after; the version before stays.
    """
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.modelling.remove import remove
    from thermodata.store.base.counting import watched

    store = session.store()
    with counting_line() as tell, watched(tell):
        parent = resolve(store, model, guess=False)
        result = remove(store, parent, effect)
    _answer_version(session, result, result.parent or parent)
