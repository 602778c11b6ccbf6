"""What models as they stand leave on the locked tests, as text."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.report.text.table import prose, table
from thermodata.schema.answers.locked_error import LockedError
from thermodata.schema.words.sentences import counted

_COLUMNS = [
    ("name", "model"),
    ("model", "id"),
    ("response", "response"),
    ("campaign", "campaign"),
    ("test", "test"),
    ("rmse_um", "RMSE"),
    ("shape_um", "about its mean"),
    ("max_um", "largest"),
    ("ptp_um", "measured, max - min"),
    ("unit", "unit"),
]


def locked_text(found: Sequence[LockedError]) -> str:
    """A row a model, response and locked test, then one of all its tests."""
    rows = list[dict[str, object]]()
    for one in found:
        own = {"name": one.name, "model": one.model, "response": one.response, "unit": one.unit}
        rows += [{**own, **t.model_dump()} for t in one.tests]
        if len(one.tests) > 1:
            rows.append({**own, "test": "all", "rmse_um": one.rmse_um, "shape_um": one.shape_um})
    left_out = dict.fromkeys(f"left out: {why}" for one in found for why in one.left_out)
    most = max(one.looks for one in found)
    said = [
        "locked: of the model as it stands; RMSE counts from the first samples of a test, as it is scored",
        *left_out,
        f"the locked tests have been opened {counted(most, 'time')} so far",
    ]
    return f"{table(rows, _COLUMNS)}\n\n" + "\n".join(map(prose, said))
