"""What is said of a model whose data changed since it was fitted, in one line for all who use it."""

from __future__ import annotations

import json
from collections.abc import Iterator

from thermodata.schema.files.model import Model
from thermodata.schema.words.sentences import with_count
from thermodata.store.base.connection import fetch
from thermodata.store.catalogue.models.came_after import came_after
from thermodata.store.catalogue.models.fits import BACK, GONE, STALE, StoredModel, find_model
from thermodata.store.catalogue.models.renamed import renamings as told_names
from thermodata.store.catalogue.store import Store

_NAMED = 4  # tests of one change


def stale_line(store: Store, model: str) -> str | None:
    """One line on a model whose data changed since it was fitted: which, what changed, and what to do; else None."""
    stored = find_model(store, model)
    if not stored.stale:
        return None
    with store.reader() as con:
        rows = fetch(
            con, "select payload from finding where model = ? and kind = ? order by rowid", [stored.model, STALE]
        )
    changed: dict[str, list[str]] = {}
    for found in (json.loads(r["payload"]) for r in rows):
        changed[found["test"]] = list(dict.fromkeys([*changed.get(found["test"], []), *found["what"]]))
    by_what: dict[str, list[str]] = {}
    for test, what in changed.items():
        by_what.setdefault(" and ".join(w for w in what if w == GONE or GONE not in what), []).append(test)
    told = "; ".join(
        f"{what}: {', '.join(tests)}" if what in (GONE, BACK) else f"{what} of {with_count(tests, _NAMED)}"
        for what, tests in by_what.items()
    )
    names = f"; {told_names(stored.renamed)}" if stored.renamed else ""
    again = fitted_again(store, stored)
    do = f"{again} is it, fitted" if again else f"thermodata fit {stored.model} fits it"
    return (
        f"stale: the data of {stored.name} {stored.model} changed since it was fitted ({told or 'its tests'}{names}); "
        f"{do} to them as they are now"
    )


def came_after_line(store: Store, stored: StoredModel) -> str | None:
    """One line on calibration tests that came after the fit of a model that is not stale; else None."""
    new = [] if stored.stale else came_after(store, stored)
    if not new:
        return None
    names = new if len(stored.spec.campaign_ids) > 1 else [name.partition("/")[2] for name in new]
    one = len(new) == 1
    again = fitted_again(store, stored)
    do = f"{again} is fitted to {'it' if one else 'them'} too" if again else f"thermodata fit {stored.model} takes "
    return (
        f"{with_count(names, _NAMED)} {'is a calibration test' if one else 'are calibration tests'} that {stored.name} "
        f"{stored.model} was not fitted to; {do}" + ("" if again else f"{'it' if one else 'them'} in")
    )


def results_gone(store: Store, stored: StoredModel) -> list[str]:
    """The campaign/test that a model was fitted to or checked on and has no results of any more: they were forgotten,
    whether the test came back or not."""
    with store.reader() as con:
        rows = fetch(
            con,
            "select campaign, payload from finding where model = ? and kind = ? order by rowid",
            [stored.model, STALE],
        )
    there = {(s.campaign, s.test) for s in stored.result.scores}
    found = [
        (row["campaign"], one["test"]) for row in rows if {GONE, BACK} & {*(one := json.loads(row["payload"]))["what"]}
    ]
    return ["/".join(key) for key in dict.fromkeys(found) if key not in there]


def fitted_again(store: Store, stored: StoredModel) -> str | None:
    """The id of the same model fitted to the data as they are now; None where nobody did."""
    return next(iter(all_fitted_again(store, stored)), None)


def all_fitted_again(store: Store, stored: StoredModel) -> Iterator[str]:
    """The ids of the same model fitted to the data as they are now, the last one first."""
    with store.reader() as con:
        fresh = fetch(con, "select model from model where name = ? and not stale order by rowid desc", [stored.name])
    for row in fresh:
        other = find_model(store, row["model"])
        # one that was fitted while a test was away is not of the data as they are now
        if _model_without_choice(other) == _model_without_choice(stored) and not came_after(store, other):
            yield other.model


def _model_without_choice(stored: StoredModel) -> Model:
    """What makes it the same model: on which tests its effects were chosen is set with a fit to more of them."""
    return stored.spec.model_copy(update={"in_sample_on": None})
