"""Predictions as one table: Parquet, CSV, or Arrow."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.predictions.predict import Predicted
from thermodata.plugin import Float1D
from thermodata.store.base.files import whole_file
from thermodata.view.query.rows import with_units

_SUFFIXES = {".parquet": "parquet", ".pq": "parquet", ".csv": "csv"}


_ENDS = ("predicted_low", "predicted_high")
_TEXTS, _NUMBERS = ("campaign", "test", "response"), ("t_s", "predicted", "measured")
_COLUMNS = [
    *((n, "string") for n in _TEXTS),
    *((n, "double") for n in _NUMBERS),
    ("known", "bool"),
    *((n, "double") for n in _ENDS),
]
"""Of a table without rows."""


def as_table(predictions: Sequence[Predicted], unit_in_names: bool = False) -> Any:
    """pyarrow table, one row a test, response and time: predicted, measured (null where there is none), known,
    c__EFFECT, its share, and predicted_low and predicted_high, the ends of the band of 95 % (null where it is not
    known). Values are means of a step, which begins at t_s. unit_in_names: 'predicted [um]'."""
    import pyarrow as pa

    effects = list(dict.fromkeys(n for p in predictions for n in p.contributions))
    parts = []
    for p in predictions:
        n = len(p.t_s)
        nothing = np.full(n, np.nan)
        columns: dict[str, Any] = {
            "campaign": pa.array([p.campaign] * n),
            "test": pa.array([p.test] * n),
            "response": pa.array([p.response] * n),
            "t_s": p.t_s,
            "predicted": p.predicted,
            "measured": pa.array(nothing if p.measured is None else p.measured, from_pandas=True),
            "known": p.known,
            **{f"c__{e}": p.contributions.get(e, nothing) for e in effects},
            **{n: pa.array(nothing if end is None else end, from_pandas=True) for n, end in _ends(p).items()},
        }
        parts.append(pa.table(columns))
    table = pa.concat_tables(parts) if parts else pa.schema(_COLUMNS).empty_table()
    units = sorted({p.unit for p in predictions})
    # rows of several units have none in common
    named = {n: unit for unit in units for n in table.column_names if n[:3] in ("pre", "mea", "c__")}
    named = {"t_s": "s", **(named if len(units) == 1 else {})}
    if not unit_in_names or len(units) != 1:
        table = table.replace_schema_metadata({b"thermodata.unit": json.dumps(units).encode()})
        return with_units(table, named)
    return table.rename_columns([f"{n} [{named[n]}]" if n in named else n for n in table.column_names])


def _ends(p: Predicted) -> dict[str, Float1D | None]:
    return dict(zip(_ENDS, p.ends, strict=True))


def check_out(out: Path, force: bool) -> str:
    """The format that a file's name says. UsageError for another, and for a file that exists."""
    kind = _SUFFIXES.get(out.suffix.lower())
    if kind is None:
        raise UsageError(
            "the file's name does not say the format", where=str(out), expected=".parquet or .csv", got=out.suffix
        )
    if out.exists() and not force:
        raise UsageError("the file exists", where=str(out), hint="--force replaces it")
    return kind


def write_table(predictions: Sequence[Predicted], out: Path, kind: str) -> None:
    """Write the table; a cut write leaves no half file."""
    import pyarrow.csv
    import pyarrow.parquet as pq

    with whole_file(out) as part:
        if kind == "parquet":
            pq.write_table(as_table(predictions), part)
        else:
            pyarrow.csv.write_csv(as_table(predictions, unit_in_names=True), part)
