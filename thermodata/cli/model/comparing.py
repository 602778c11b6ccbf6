"""Models beside each other: on their tests, version by version, and on other machines."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command, in_units_of, plain
from thermodata.cli.terminal.stored_model import resolve, tell_same
from thermodata.errors import UsageError
from thermodata.report.text.fit import (
    compare_text,
    differences_text,
    history_text,
    spots_text,
)

if TYPE_CHECKING:
    from thermodata.store import Store


@command("compare")
@click.argument("models", nargs=-1, metavar="[MODEL]...", shell_complete=completing.models)
@click.option(
    "--against",
    metavar="MODEL",
    shell_complete=completing.models,
    help="Print what papers print: each model's rest against this one's.",
)
@click.option(
    "--layout",
    type=click.Choice(["text", "markdown", "csv", "latex"]),
    default="text",
    help="Of the table that --against prints.",
)
@click.option("--test", "tests", multiple=True, metavar="TEST", help="With --against: only this test; may be repeated.")
@click.option(
    "--contributions",
    "test_shown",
    metavar="TEST",
    shell_complete=completing.tests,
    help="Print what each effect gives in this test, in each MODEL, and how far that is from the first.",
)
def compare_command(
    session: Session,
    models: tuple[str, ...],
    against: str | None,
    layout: str,
    tests: tuple[str, ...],
    test_shown: str | None,
) -> None:
    """Score models against the measurements.

    By test and phase, each MODEL beside the others, and where the first fails; the one fitted last where none is named.

    With several models the JSON is that of the first, with the scores of all, and all of them in "models";
    "weak_spots" has those of the first, by response, and "differences" each model's error less that of the first, by
    test, with its interval of 95 %.

    With --against: peak to valley at first and left, both ways (max - min, |max| + |min|), range, how many times less,
    percent less than the reference, and the mean row (over the tests that all of them predict, or over each --test);
    the JSON is a list of these rows.

    With --contributions: where each effect gives most, the largest difference to the first MODEL, both with 95 %, and
    for how long the two bands are apart; a difference has the sum of both half widths. From what the fits stored; the
    JSON is a row an effect and model.
    """

    def named(store: Store) -> list[str]:
        found = [resolve(store, ref, session) for ref in models or (None,)]
        tell_same(store, models, found)
        return found

    if against is not None and test_shown is not None:
        raise UsageError("--against and --contributions print two tables", hint="ask for one of them")
    if test_shown is not None:
        from thermodata.cli.model.besides import answer_contributions

        store = session.store()
        answer_contributions(session, store, named(store), test_shown)
        return
    if against is not None:
        from thermodata.cli.model.besides import answer_against

        store = session.store()
        beside, reference = named(store), resolve(store, against)
        if len(beside) == 1:  # beside others the reference may stand as a row of its own
            tell_same(store, [beside[0], against], [beside[0], reference])
        answer_against(session, store, beside, reference, layout, tests)
        return
    if tests:
        raise UsageError("--test chooses rows of the table that --against prints", hint="add --against MODEL")
    store = session.store()
    _answer_scores(session, store, named(store))


def _answer_scores(session: Session, store: Store, models: list[str]) -> None:
    from thermodata.modelling.comparing import compare, differences_of
    from thermodata.modelling.model_file.not_installed import not_installed
    from thermodata.modelling.run import load
    from thermodata.report.collected.spots import weak_spots_of
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.catalogue.models.stale import stale_line

    results = compare(store, models)
    unknown = [r for r in results if not_installed(find_model(store, r.model).spec)]
    for result in unknown:
        warnings.warn(result.notes[-1], stacklevel=2)
    weak: dict[str, Any] = {}
    # the scores of a stale model are of the data before
    if results[0] not in unknown and not find_model(store, results[0].model).stale:
        loaded = load(store, results[0].model)
        weak = weak_spots_of(loaded, (load_diagnosis(store, m) for m in (loaded.parent, loaded.identity) if m))
    payload: dict[str, Any] = {**plain(results[0]), "weak_spots": weak}
    if len(results) > 1:
        payload |= {"scores": [s for r in results for s in r.scores], "models": results}
    apart = [] if unknown else differences_of(store, [r.model for r in results])
    payload["differences"] = apart or None
    payload["stale"] = "\n".join(filter(None, (stale_line(store, r.model) for r in results))) or None
    session.answer(
        payload,
        lambda: in_units_of(
            session,
            results[0].response,
            "\n\n".join(
                [
                    compare_text(results),
                    *([differences_text(apart, results)] if apart else []),
                    *(spots_text(found, response) for response, found in weak.items() if found),
                ]
            ),
        ),
    )


@command("history")
@click.argument("model", required=False, shell_complete=completing.models)
def history_command(session: Session, model: str | None) -> None:
    """Show the versions that led to MODEL, and their errors.

    Of the one fitted last where no MODEL is named.
    """
    from thermodata.report.collected.history import history_rows

    store = session.store()
    chain = history_rows(store, resolve(store, model, session))
    session.answer(chain, lambda: history_text(chain))


@command("portability")
@click.argument("model", shell_complete=completing.models)
@click.option(
    "--test",
    "tests",
    multiple=True,
    metavar="TEST",
    shell_complete=completing.tests,
    help="Only this test, also of another campaign of the store; may be repeated.",
)
@click.option(
    "--campaign",
    "campaigns",
    multiple=True,
    metavar="CAMPAIGN",
    shell_complete=completing.campaigns,
    help="The tests of this campaign, of another machine maybe; may be repeated (default: of the model's own).",
)
def portability_command(session: Session, model: str, tests: tuple[str, ...], campaigns: tuple[str, ...]) -> None:
    """Say how MODEL transfers to other tests and machines.

    To the tests of its own campaigns, or of those that --campaign or --test name, which need its channels. Roles of
    these are those that their campaign gives: the model was fitted to none of them.

    The gain g that fits the model to each, the error without (n) and with (c) it, and the class: portable,
    with_correction, not_portable.
    """
    from thermodata.modelling.compare.elsewhere import other_campaigns
    from thermodata.modelling.comparing import transfer
    from thermodata.report.text.portability import portability_text
    from thermodata.store.catalogue.models.fits import find_model

    store = session.store()
    found = resolve(store, model)
    rows = [plain(row) for row in transfer(store, found, tests, campaigns)]
    names = list(dict.fromkeys(str(row["response"]) for row in rows))
    own = find_model(store, found).spec.campaign_ids
    session.answer(rows, lambda: in_units_of(session, names, portability_text(rows, own)))
    others = other_campaigns(store, own)
    if others and not tests and not campaigns:
        session.say(f"in the store too: {', '.join(others)}; ask with --campaign {others[0]}")
