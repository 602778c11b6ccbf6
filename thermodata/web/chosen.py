"""The model that an address names: one that there is not is refused, never replaced by another."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.store import Store
from thermodata.view.lists.models import ModelRow, fitted_last

WITHOUT = "none"  # of a chart of a test that shows no model


def model_in(store: Store, models: Sequence[ModelRow], named: str | None) -> ModelRow | None:
    """The model by id, name or beginning of an id; the one fitted last where none is named; None where there is none.

    models: those that the page offers. UsageError, as commands have it, for one that the store does not know; where
    the page does not offer it, the last that it offers."""
    if not models or not named or named == WITHOUT:
        return fitted_last(models) if models else None
    by_id = {m.model: m for m in models}
    if named in by_id:
        return by_id[named]
    from thermodata.store.catalogue.models.fits import (
        find_model,  # pydantic: a page of a known model is shown without it
    )

    return by_id.get(find_model(store, named).model, fitted_last(models))
