"""Models beside each other, as papers print them, and effect by effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thermodata.cli.terminal.common import Session, in_units_of, plain
from thermodata.cli.terminal.layout import LAYOUTS
from thermodata.report.words.glossary import LEVEL

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
    from thermodata.modelling.comparing import compare_against
    from thermodata.report.text.fit import leveled

    rows = [plain(row) for row in compare_against(store, models, against, tests)]
    names = list(dict.fromkeys(str(row["response"]) for row in rows))

    def text() -> str:
        told = as_table(rows, layout)
        return in_units_of(session, names, leveled(told) if layout == "text" else told)

    session.answer(rows, text)
    if layout != "text":  # a table that goes into a paper is that table alone
        session.say(LEVEL)


def answer_contributions(session: Session, store: Store, models: Sequence[str], test: str) -> None:
    """Print what each effect gives in a test. models: ids, prefixes or names."""
    from thermodata.report.text.fit import contributions_text
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.view.curves.contributions import contributions, open_test
    from thermodata.view.lists.models import model_rows

    models = list(dict.fromkeys(find_model(store, ref).model for ref in models))
    found = contributions(store, models, *open_test(store, models[0], test))
    names = {row.model: row.label for row in model_rows(store)}
    for model in models:
        if not any(model in part.models for part in found):
            session.say(f"{names[model]} was not predicted in {test} when it was fitted")
    rows = [row for part in found for row in part.to_json()]
    text = "\n\n".join(contributions_text(part, names) for part in found)
    session.answer(rows, lambda: in_units_of(session, [part.response for part in found], text))


def as_table(rows: Sequence[Mapping[str, Any]], layout: str) -> str:
    """Rows of `compare_against` in one of LAYOUTS. Versions of one model have their ids beside the name."""
    ids = dict.fromkeys((str(row["name"]), str(row["model"])) for row in rows)
    names = [name for name, _ in ids]
    label = {m: f"{name} {m[:6]}" if names.count(name) > 1 else name for name, m in ids}
    rows = [{**row, "name": label[str(row["model"])]} for row in rows]
    head = [("test", "test"), ("name", "model")]
    head = [("campaign", "campaign"), *head] if len({r["campaign"] for r in rows} - {""}) > 1 else head
    head = [("response", "response"), *head] if len({r["response"] for r in rows}) > 1 else head
    tail = [("why", "x for")] if any(row["why"] for row in rows) else []
    return LAYOUTS[layout](rows, [*head, *_COLUMNS, *tail])
