"""Locked tests that somebody asked of a candidate by choice: what they said, and what a verdict proposes to ask."""

from __future__ import annotations

import re
from collections.abc import Iterable

from thermodata.report.text.confirmed import confirmed_sentence
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import kept_answer
from thermodata.view.lists.models import ModelRow

_ASKS = re.compile(r"thermodata confirm \w+ (\S+)")


def confirmed(store: Store, model: ModelRow, found: Diagnosis) -> dict[str, str]:
    """Candidate -> what the locked tests said of it, of those that `confirm` was asked of."""
    of = "" if len(model.responses) == 1 else f" of {found.response}"
    kept = {c.id: kept_answer(store, model.model, f"confirm {c.id}{of}") for c in found.candidates}
    answers = {name: Confirmed.model_validate_json(answer) for name, answer in kept.items() if answer is not None}
    return {name: confirmed_sentence(answer) for name, answer in answers.items()}


def proposed(clauses: Iterable[str], known: Iterable[str]) -> tuple[list[str], list[str]]:
    """(the clauses without those that propose to confirm what is known, the other candidates that they propose)."""
    kept, asked, known = list[str](), list[str](), set(known)
    for clause in clauses:
        named = _ASKS.findall(clause)
        if named and set(named) <= known:
            continue
        kept.append(clause)
        asked += [name for name in named if name not in known]
    return kept, list(dict.fromkeys(asked))
