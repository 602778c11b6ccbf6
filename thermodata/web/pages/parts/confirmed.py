"""Locked tests that somebody asked of a candidate by choice: what they said, and what a verdict proposes to ask."""

from __future__ import annotations

import re
from collections.abc import Iterable

from thermodata.report.collected.by_choice import asked_by_choice
from thermodata.report.text.confirmed import confirmed_sentence
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.store import Store
from thermodata.view.lists.models import ModelRow

_ASKS = re.compile(r"thermodata confirm \w+ (\S+)")


def confirmed(store: Store, model: ModelRow, found: Diagnosis) -> dict[str, str]:
    """Candidate -> what the locked tests said of it, of those that `confirm` was asked of."""
    asked = asked_by_choice(store, model.model, model.responses, found)
    return {name: confirmed_sentence(answer) for name, answer in asked.items()}


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
