"""What locked tests said of candidates that somebody asked them of by choice."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TYPE_CHECKING

from thermodata.schema.answers.confirmed import Confirmed

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store import Store


def asked_by_choice(store: Store, model: str, responses: Collection[str], found: Diagnosis) -> dict[str, Confirmed]:
    """Candidate -> the kept answer, of those of a model's diagnosis that `confirm` was asked of. responses: of the
    model."""
    from thermodata.store.catalogue.models.findings import kept_answer

    of = "" if len(responses) == 1 else f" of {found.response}"
    kept = {c.id: kept_answer(store, model, f"confirm {c.id}{of}") for c in found.candidates}
    return {name: Confirmed.model_validate_json(answer) for name, answer in kept.items() if answer is not None}


def of_added(asked: dict[str, Confirmed], added: Collection[str]) -> tuple[Confirmed, ...]:
    """Those of effects that a version added, whose ids are an effect's name and perhaps a number."""

    def is_added(name: str) -> bool:
        return any(re.fullmatch(rf"{re.escape(name.partition(':')[0])}(_\d+)?", term) for term in added)

    return tuple(answer for name, answer in asked.items() if is_added(name))
