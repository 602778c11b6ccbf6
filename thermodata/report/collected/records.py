"""Rows of a query as plain mappings, and conditions as they were written."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.view import StoreView


def records(view: StoreView, query: str, params: Sequence[Any] | dict[str, Any] | None = None) -> list[dict[str, Any]]:
    """One mapping a row, column name -> value. params: for the query's `?` or `$name`."""
    relation = view.sql(query, params)
    names: list[str] = list(relation.columns)
    return [dict(zip(names, row, strict=True)) for row in relation.fetchall()]


def written_conditions(specs: Iterable[str]) -> dict[tuple[str, str], dict[str, Any]]:
    """(campaign, test) -> conditions with their units, as the campaign files say them; specs: `campaign.spec`."""
    parsed = [json.loads(spec) for spec in specs]
    return {(c["id"], t["id"]): t.get("conditions") or {} for c in parsed for t in c.get("tests") or []}
