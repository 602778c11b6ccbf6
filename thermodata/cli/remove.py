"""Taking things out of a store."""

from __future__ import annotations

import click

from thermodata.cli.common import Session, command, plain
from thermodata.cli.table import fields


@command("forget")
@click.argument("campaign")
@click.argument("test", required=False)
def forget_command(session: Session, campaign: str, test: str | None) -> None:
    """Remove a campaign or one TEST from the store.

    With all that derives from it. The source files stay untouched.
    """
    from thermodata.store.lifecycle import forget

    gone = plain(forget(session.store(), campaign, test))
    session.answer(gone, lambda: fields(gone.items()))


@command("gc")
@click.option("--grace", default="1 h", show_default=True, help="Files younger than this are left alone.")
def gc_command(session: Session, grace: str) -> None:
    """Delete files of the store that nothing refers to any more."""
    from thermodata.schema.quantity import value_in
    from thermodata.store.lifecycle import gc

    gone = plain(gc(session.store(), grace_s=value_in(grace, "s")))
    session.answer(gone, lambda: fields(gone.items()))
