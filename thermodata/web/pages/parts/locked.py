"""Locked tests of a model's campaigns: which they are, and how often each was opened, for what."""

from __future__ import annotations

from dataclasses import dataclass

from thermodata.store import Store
from thermodata.store.base.connection import fetch
from thermodata.store.catalogue.models.looks import Look, looks_of
from thermodata.view.lists.models import ModelRow

_MOST = 6  # looks that are told of one test


@dataclass(frozen=True, slots=True)
class Locked:
    """A test that is locked, or whose lock was opened before. n: how often it was. reason: each look with its model,
    the last ones where they are many. open: whether it is locked no more."""

    test: str
    n: int
    reason: str
    open: bool = False


def locked_tests(store: Store, model: ModelRow) -> list[Locked]:
    """All of the model's campaigns, in the order of the campaign file; behind them those that are open by now."""
    with store.reader() as con:
        rows = fetch(
            con,
            "select campaign, test from test where role = 'locked' and list_contains(?, campaign)",
            [list(model.campaigns)],
        )
    looks, closed = looks_of(store, model.campaigns), [(row["campaign"], row["test"]) for row in rows]
    return [
        Locked(_named(model, *key), len(looks.get(key, [])), _reason(looks.get(key, [])), key not in closed)
        for key in dict.fromkeys([*closed, *looks])
    ]


def next_look(locked: list[Locked]) -> int:
    """Which look it would be if all were opened now: of the one that was opened most."""
    return 1 + max((one.n for one in locked if not one.open), default=0)


def _reason(looks: list[Look]) -> str:
    said = [f"{look.model[:6]}: {look.reason}" for look in looks[-_MOST:]]
    left = len(looks) - len(said)
    return "; ".join([f"{left} before"] * bool(left) + said)


def _named(model: ModelRow, campaign: str, test: str) -> str:
    return f"{campaign}/{test}" if len(model.campaigns) > 1 else test
