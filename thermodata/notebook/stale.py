"""What commands say on the way of a model, as Python says it: which it is, what changed, that it has no band."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.store import Store


class StaleModelWarning(UserWarning):
    """An answer is of a model whose data changed since it was fitted."""


class NoBandWarning(UserWarning):
    """Predictions have no band of 95 %."""


class GuessedModelWarning(UserWarning):
    """Models of several campaigns have the name: the newest of all is taken."""


def heed_guess(store: Store, ref: str) -> None:
    """A `GuessedModelWarning` that names the others, where models of several campaigns have the name."""
    from thermodata.modelling.named import of_which_campaign

    if (line := of_which_campaign(store, ref)) is not None:
        warnings.warn(line, GuessedModelWarning, stacklevel=_callers() + 1)


def heed_no_band(why_not: str | None) -> None:
    """A `NoBandWarning` that says why, where there is no band."""
    if why_not is not None:
        warnings.warn(f"no band of 95 %: {why_not}", NoBandWarning, stacklevel=_callers() + 1)


def heed(store: Store, models: Iterable[str]) -> None:
    """A `StaleModelWarning` for each that is stale, where the call stands that asked."""
    from thermodata.store.catalogue.models.stale import stale_line

    for line in dict.fromkeys(filter(None, (stale_line(store, model) for model in models))):
        warnings.warn(line, StaleModelWarning, stacklevel=_callers() + 1)


def _callers() -> int:
    """How many calls up, counted from who calls this, the first one stands that is not of this package."""
    level, frame = 0, sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).partition(".")[0] == "thermodata":
        level, frame = level + 1, frame.f_back
    return level
