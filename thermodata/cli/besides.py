"""Models beside each other, as papers print them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thermodata.cli.common import Session, in_units_of, plain
from thermodata.cli.layout import LAYOUTS

if TYPE_CHECKING:
    from thermodata.store import Store

_COLUMNS = [
    ("fit", "FIT [%]"),
    ("initial", "initial [um]"),
    ("residual", "left [um]"),
    ("initial_peaks", "initial |max|+|min| [um]"),
    ("residual_peaks", "left |max|+|min| [um]"),
    ("low", "from [um]"),
    ("high", "to [um]"),
    ("fold", "x-fold"),
    ("against", "less than the reference [%]"),
]


def answer_against(
    session: Session, store: Store, models: Sequence[str], against: str, layout: str, tests: Sequence[str]
) -> None:
    """Print the table of `compare --against`. models, against: as the store knows them; tests: none for all."""
    from thermodata.modelling.run import compare_against

    rows = [plain(row) for row in compare_against(store, models, against, tests)]
    names = [str(row["response"]) for row in rows]
    session.answer(rows, lambda: in_units_of(session, list(dict.fromkeys(names)), _text(rows, layout)))


def _text(rows: list[dict[str, Any]], layout: str) -> str:
    head = [("test", "test"), ("name", "model")]
    head = [("campaign", "campaign"), *head] if len({r["campaign"] for r in rows} - {""}) > 1 else head
    head = [("response", "response"), *head] if len({r["response"] for r in rows}) > 1 else head
    tail = [("why", "x for")] if any(row["why"] for row in rows) else []
    return LAYOUTS[layout](rows, [*head, *_COLUMNS, *tail])
