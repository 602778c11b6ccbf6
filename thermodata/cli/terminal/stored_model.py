"""The stored model that a command is asked about: by what is written for it, and what is said of it on the way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal.common import Session, plain
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from thermodata.store import Store


def resolve(store: Store, ref: str | None, session: Session | None = None, *, guess: bool = True) -> str:
    """MODEL as the store knows it; where none is named, the one fitted last, and the session says which that is. Says
    on stderr where models of several campaigns have the name, or versions alike in number, where the data of the model
    changed since its fit, and where calibration tests came after it: every command that uses one comes by here.
    guess=False, for what makes versions or looks at locked tests: a name of several campaigns is refused."""
    from thermodata.modelling.named import (
        model_named,
        newest_model,
        of_which_campaign,
        of_which_version,
        refuse_several_campaigns,
    )
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.catalogue.models.stale import came_after_line, stale_line

    found = newest_model(store) if ref is None else model_named(store, ref)
    if not guess:
        refuse_several_campaigns(store, found)
    stored = find_model(store, found)
    if ref is None and session is not None:
        session.say(f"of the model fitted last: {found} ({stored.name}, {', '.join(stored.spec.campaign_ids)})")
    which = of_which_campaign(store, found) or of_which_version(store, found)
    for said in (which, stale_line(store, stored.model), came_after_line(store, stored)):
        if said is not None:
            click.echo(said, err=True)
    return found


def tell_same(store: Store, refs: Sequence[str], models: Sequence[str]) -> None:
    """Says on stderr which of several names are of one model, and by what its versions before are called: a name is of
    its newest version. models: what each of refs was resolved to."""
    from thermodata.store.catalogue.models.fits import find_model, model_chain

    ids = [find_model(store, m).model for m in models]
    for model in dict.fromkeys(m for m in ids if ids.count(m) > 1):
        names = list(dict.fromkeys(ref for ref, m in zip(refs, ids, strict=True) if m == model))
        what = f"{listed(names)} are one model, {model}" if len(names) > 1 else f"{names[0]} is named twice"
        stored = find_model(store, model)
        before = [m.model for m in model_chain(store, model) if m.model != model]
        newest = f": '{stored.name}' is the newest version of that name" if stored.name in names else ""
        earlier = f"; the version before it is {before[-1]}" if before else ""
        click.echo(f"{what}{newest}{earlier}; it is compared with itself", err=True)


def with_stale(store: Store, model: str, answer: Any) -> dict[str, Any]:
    """The answer as JSON has it, with `stale`: the line on a model whose data changed since its fit, or null."""
    from thermodata.store.catalogue.models.stale import stale_line

    return {**plain(answer), "stale": stale_line(store, model)}
