"""Locked tests that somebody asks of a candidate by choice: what they said, and what a verdict proposes to ask."""

from __future__ import annotations

import re
from collections.abc import Iterable

from thermodata.schema.answers.confirmed import Confirmed
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import kept_answer
from thermodata.view.lists.models import ModelRow

_ASKS = re.compile(r"thermodata confirm \w+ (\S+)")


def answer_of(store: Store, model: ModelRow, candidate: str, response: str) -> Confirmed | None:
    """What the store holds of this question; None where nobody asked it."""
    of = "" if len(model.responses) == 1 else f" of {response}"
    kept = kept_answer(store, model.model, f"confirm {candidate}{of}")
    return None if kept is None else Confirmed.model_validate_json(kept)


def proposed(clauses: Iterable[str], known: Iterable[str], *, acts: bool) -> tuple[list[str], list[str]]:
    """(the clauses without those that propose to confirm what is known, the other candidates that they propose).

    acts: whether the page has a button for each of them, so that the command alone says nothing more."""
    kept, asked, known = list[str](), list[str](), set(known)
    for clause in clauses:
        named = _ASKS.findall(clause)
        if named and set(named) <= known:
            continue
        if not (acts and _ASKS.match(clause)):
            kept.append(clause)
        asked += [name for name in named if name not in known]
    return kept, list(dict.fromkeys(asked))
