"""Whether models are of one version of the data: differences of others would be those of the data."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from thermodata.errors import UsageError

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.store.catalogue.models.fits import StoredModel


def refuse_stale(store: Store, models: Iterable[StoredModel], reference: str) -> None:
    """UsageError where one of them was fitted before a change: it says what to fit, or which ids they have since."""
    from thermodata.store.catalogue.models.stale import fitted_again

    models = list(models)
    old = [stored for stored in models if stored.stale]
    if not old:
        return
    now = {stored.model: fitted_again(store, stored) or stored.model for stored in old}
    to_fit = [f"thermodata fit {model}" for model, again in now.items() if again == model]
    others = " ".join(now.get(stored.model, stored.model) for stored in models if stored.model != reference)
    raise UsageError(
        "the models were not fitted to the same version of the data",
        expected="models of the data as they are now",
        got=f"before a change: {', '.join(f'{stored.name} ({stored.model})' for stored in old)}",
        hint=f"{'; '.join(to_fit)}; each prints the id that it has then"
        if to_fit
        else f"they were fitted again: thermodata compare {others} --against {now.get(reference, reference)}",
    )
