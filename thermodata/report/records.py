"""Rows of a query as plain mappings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.view import StoreView


def records(view: StoreView, query: str, params: Sequence[Any] | None = None) -> list[dict[str, Any]]:
    """One mapping a row, column name -> value. params: for the query's `?`."""
    relation = view.sql(query, params)
    names: list[str] = list(relation.columns)
    return [dict(zip(names, row, strict=True)) for row in relation.fetchall()]
