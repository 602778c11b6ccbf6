"""Taking things out of a store."""

from __future__ import annotations

from collections.abc import Sequence

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command, plain
from thermodata.cli.terminal.stored_model import resolve
from thermodata.errors import UsageError
from thermodata.report.text.table import fields

_UNTIL_GC = "the files stay on the disk until thermodata gc, which leaves those of the last hour alone (--grace)"


@command("forget")
@click.argument("campaign", required=False, shell_complete=completing.campaigns)
@click.argument("test", required=False, shell_complete=completing.tests)
@click.option("--earlier", is_flag=True, help="Only the earlier versions of files that changed.")
@click.option("--models", is_flag=True, help="Models that span other campaigns too may go with this one.")
@click.option(
    "--model",
    "versions",
    multiple=True,
    metavar="MODEL",
    shell_complete=completing.models,
    help="No campaign, but this version of a model (repeat it for several).",
)
def forget_command(
    session: Session, campaign: str | None, test: str | None, earlier: bool, models: bool, versions: tuple[str, ...]
) -> None:
    """Remove a campaign, one TEST, or versions of models from the store.

    With all that derives from it; a campaign whose models span others is refused without --models, and a version that
    another one was made from without that one. The source files stay untouched, and so does how often locked tests were
    looked at: it counts on where the same data are ingested again.
    """
    from thermodata.schema.words.sentences import counted
    from thermodata.store.keep.forget import forget

    if (campaign is None) == (not versions) or (versions and (earlier or models)):
        raise UsageError(
            "what is to be forgotten?",
            expected="a CAMPAIGN, or --model MODEL",
            got="neither" if not versions else "both" if campaign else "--model with --earlier or --models",
            hint="thermodata campaigns and thermodata models list them",
        )
    if campaign is None:
        _forget_versions(session, versions)
        return
    gone = plain(forget(session.store(), campaign, test, earlier=earlier, models=models))
    session.answer(gone, lambda: fields(gone.items()))
    session.say(_UNTIL_GC)
    if n := gone["looks"]:
        session.say(f"{counted(n, 'look')} at locked tests will count on where the same data are ingested again")


def _forget_versions(session: Session, versions: Sequence[str]) -> None:
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.keep.forget import forget_models

    store = session.store()
    ids = [find_model(store, resolve(store, ref, guess=False)).model for ref in versions]
    gone = plain(forget_models(store, list(dict.fromkeys(ids))))
    session.answer(gone, lambda: fields(gone.items()))
    session.say(_UNTIL_GC)
    if n := gone["looks"]:
        session.say(f"looks at locked tests that were opened for them stay counted: {n}")


@command("gc")
@click.option(
    "--grace", metavar="TIME", default="1 h", show_default=True, help="Files younger than this are left alone."
)
def gc_command(session: Session, grace: str) -> None:
    """Delete files of the store that nothing refers to any more."""
    from thermodata.schema.units.value import value_in
    from thermodata.schema.words.sentences import counted
    from thermodata.store.keep.gc import gc

    gone = plain(gc(session.store(), grace_s=value_in(grace, "s")))
    session.answer(gone, lambda: fields(gone.items()))
    if n := gone["too_young"]:
        session.say(
            f"{counted(n, 'file', 'is', 'are')} younger than {grace} and left alone, for an ingest may be writing "
            "meanwhile: run gc again later, or with --grace '0 s' where nobody works on this store"
        )


@command("check")
@click.option("--repair", is_flag=True, help="Remove damaged files, so that the next ingest makes them anew.")
def check_command(session: Session, repair: bool) -> int:
    """Check that the store holds what was written.

    Reads every file with its checksums. Exit code 4 says that one is gone, cut or altered.
    """
    from thermodata.cli.look.tracing_text import check_text
    from thermodata.store.keep.check import check_store

    found = plain(check_store(session.store(), repair=repair).to_json())
    session.answer(found, lambda: check_text(found))
    if found["damaged"]:
        session.say(
            "ingest the campaigns named again: what can be made anew is made anew"
            if repair
            else "thermodata check --repair removes them, and the next ingest makes them anew"
        )
    return 4 if found["damaged"] else 0
