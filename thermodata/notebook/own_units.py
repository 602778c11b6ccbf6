"""Tables of errors in the units of their responses: kelvins under a heading of micrometres would be micrometres."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from thermodata.report.text.table import Column


def in_own_units(
    rows: Iterable[Mapping[str, Any]], columns: Iterable[Column], units: Mapping[str, str]
) -> tuple[list[dict[str, Any]], list[Column]]:
    """Rows with a `response`, and columns whose headings say [um]. units: response -> that of its errors. One unit
    stands in the headings; of several each stands with its response."""
    told, columns = [dict(row) for row in rows], list(columns)
    each = {units.get(str(row["response"]), "um") for row in told}
    if len(each) > 1:
        for row in told:
            row["response"] = f"{row['response']} [{units.get(str(row['response']), 'um')}]"
        return told, _headed(columns, " [um]", "")
    return told, _headed(columns, "[um]", f"[{each.pop() if each else 'um'}]")


def _headed(columns: Sequence[Column], old: str, new: str) -> list[Column]:
    return [(key, heading.replace(old, new)) for key, heading in columns]
