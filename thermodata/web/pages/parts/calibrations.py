"""Calibrations of campaigns as the store has them: what each probe's volts come to, and the checks that fail."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from thermodata.store import Store
from thermodata.store.base.connection import fetch


def calibrations(store: Store, campaigns: Sequence[str]) -> list[dict[str, Any]]:
    """Rows of the table, in the order of their names; checks as they were kept."""
    with store.reader() as con:
        rows = fetch(
            con,
            "select * from calibration where list_contains(?, campaign) order by campaign, calibration",
            [list(campaigns)],
        )
    return [{**row, "checks": json.loads(row["checks"] or "[]")} for row in rows]


def failing(rows: Sequence[dict[str, Any]]) -> int:
    """How many have a check that does not hold."""
    return sum(any(not check["passed"] for check in row["checks"]) for row in rows)
