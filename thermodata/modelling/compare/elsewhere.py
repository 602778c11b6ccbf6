"""A model on tests of other campaigns of the store: those that have its channels, on whatever machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from thermodata.errors import UsageError, unknown_name
from thermodata.modelling.compare.portability import Portability, portability
from thermodata.modelling.inputs.coarse_readings import drawn
from thermodata.modelling.predictions.predict import rebound
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.view.grid.dataset import Dataset

if TYPE_CHECKING:
    from thermodata.store import Store


def other_campaigns(store: Store, own: Sequence[str]) -> list[str]:
    """The campaigns of the store that a model is not of."""
    with store.reader() as con:
        rows = con.execute("select campaign from campaign order by rowid").fetchall()
    return [str(c) for (c,) in rows if c not in own]


def asked_for(store: Store, own: Sequence[str], tests: Sequence[str], campaigns: Sequence[str]) -> list[str]:
    """Other campaigns that are named, or whose tests are named where no own test is called so. UsageError for an
    unknown campaign."""
    others = other_campaigns(store, own)
    for name in campaigns:
        if name not in (*own, *others):
            raise unknown_name("campaign", name, [*own, *others], where="--campaign")
    with store.reader() as con:
        rows = con.execute("select campaign, test from test").fetchall()
    found = [c for c in campaigns if c in others]
    for name in tests:
        hits = [c for c, t in rows if name in (t, f"{c}/{t}") and (not campaigns or c in campaigns)]
        if not any(c in own for c in hits):
            found += [c for c in hits if c in others]
    return list(dict.fromkeys(found))


def data_of(store: Store, campaigns: Sequence[str], step_s: float) -> Dataset:
    """All tests of these campaigns, on the step of the model."""
    from thermodata.view.grid.load import load_dataset

    return drawn(load_dataset(store, campaigns, step_s))


def portability_of(fitted: FittedModel, data: Dataset) -> list[Portability]:
    """The rows of tests that the model is not of; their own locked ones are none of them. UsageError for a campaign
    without the model's responses, or where a driver is ambiguous there."""
    carried = replace(fitted, responses=tuple(rebound(r, fitted, data) for r in fitted.responses))
    rows = portability(carried, replace(data, tests=tuple(t for t in data.tests if t.role != "locked")))
    bare = [c for c in dict.fromkeys(t.campaign for t in data.tests) if c not in {r.campaign for r in rows}]
    if bare:
        raise UsageError(
            "nothing to carry over to in campaign " + ", ".join(bare),
            where="--campaign",
            expected=f"tests with {' or '.join(r.name for r in fitted.responses)}, as axis and place say, not locked",
            got="none",
            hint="thermodata predict shows the model on logs without displacement",
        )
    return rows
