"""How the error fell from version to version of a model, and the way back to the one before."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from thermodata.modelling.versions.same_tests import THE_ONE_BEFORE, UNSEEN, note_on_the_same_tests
from thermodata.report.collected.data import Version
from thermodata.report.collected.history import chain_units, how_it_went, versions
from thermodata.report.collected.lost import lost_of_versions
from thermodata.report.page.headline import capital
from thermodata.report.words.numbers import in_sample
from thermodata.report.words.of_response import some_of
from thermodata.schema.answers.result import Score
from thermodata.store import Store
from thermodata.store.catalogue.models.fits import find_model, model_chain
from thermodata.view.lists.models import ModelRow, fitted_last
from thermodata.view.lists.response_units import response_units, told_together
from thermodata.web.command import command


def how_it_fell(store: Store, models: Sequence[ModelRow], newest: ModelRow, store_path: Path) -> dict[str, Any]:
    """What the page says of the versions of `newest`. models: all of the store. store_path: as commands name it."""
    stored = model_chain(store, newest.model)
    chain = versions(stored, chain_units(store, stored))
    of_chain = told_together(newest.responses, response_units(store, newest.responses, newest.campaigns))
    waterfall = _waterfall(chain)
    undo = next((m for m in models if m.model == newest.parent), None)
    return {
        "waterfall": waterfall,
        "went": how_it_went([error for _, error, _ in waterfall]),
        "told_of_chain": some_of(of_chain, newest.responses),
        "refits": [(f"{v.name} {i}", v.refitted) for i, v in enumerate(chain, 1) if v.refitted],
        "lost": capital(lost_of_versions(chain, lambda v: f"{v.name} {chain.index(v) + 1}")),
        "undo": undo,
        "taken": fitted_last(models),
        "again_command": command(store_path, "fit", undo.model) if undo else "",
    }


def _waterfall(chain: tuple[Version, ...]) -> list[tuple[Version, float, float | None]]:
    """(version, its error, the error before it)."""
    known = [v for v in chain if v.all_um is not None]
    return [(v, v.all_um or 0.0, known[i - 1].all_um if i else None) for i, v in enumerate(known)]


def refitted(store: Store, pinned: ModelRow, newest: ModelRow, before: Sequence[Score], after: Sequence[Score]) -> str:
    """What is told of the pinned one where it was not fitted to verification tests that the newest is fitted to; else
    ''. before, after: their scores."""
    if not in_sample(after) - in_sample(before):
        return ""
    told = note_on_the_same_tests(find_model(store, newest.model).result.notes)
    return told if told and newest.parent == pinned.model else UNSEEN.replace(THE_ONE_BEFORE, pinned.label)
