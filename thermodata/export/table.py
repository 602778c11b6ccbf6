"""One test on a uniform grid as a Parquet or CSV file, units in the columns' names or metadata."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError, unknown_name

if TYPE_CHECKING:
    from thermodata.view import StoreView

FORMATS = ("parquet", "csv")
_LATER = ("mat", "mdf4")
_BY_SUFFIX = {".parquet": "parquet", ".pq": "parquet", ".csv": "csv", ".mat": "mat", ".mf4": "mdf4", ".mdf": "mdf4"}


@dataclass(frozen=True, slots=True)
class Exported:
    """What was written. units: column -> canonical unit."""

    path: str
    format: str
    rows: int
    columns: list[str]
    units: dict[str, str]


def export_test(
    view: StoreView, campaign: str, test: str, out: Path, *, step: str = "30 s", kind: str | None = None
) -> Exported:
    """Write `binned(campaign, test, step)` to `out`; kind None: by its suffix. UsageError on unknown names."""
    kind = kind or _BY_SUFFIX.get(out.suffix.lower())
    if kind in _LATER:
        raise UsageError(f"export to {kind} is not supported yet", expected=" or ".join(FORMATS), got=kind)
    if kind not in FORMATS:
        raise UsageError("the file's name does not say the format", where=str(out),
                         expected=".parquet or .csv", got=out.suffix or "no suffix", hint="--format parquet")
    known = [str(row[0]) for row in view.sql("select test from test where campaign = ?", [campaign]).fetchall()]
    if not known:
        campaigns = view.sql("select campaign from campaign").fetchall()
        raise unknown_name("campaign", campaign, [str(row[0]) for row in campaigns])
    if test not in known:
        raise unknown_name("test", test, known)
    table: Any = view.binned(campaign, test, step=step).to_arrow_table()
    units = _units(view, campaign, test, table.column_names)
    out.parent.mkdir(parents=True, exist_ok=True)
    part = out.with_name(f".{out.name}.{os.getpid()}.part")          # a cut write never looks like a whole file
    try:
        if kind == "parquet":
            import pyarrow.parquet as pq

            note = {b"thermodata.units": json.dumps(units).encode(), b"thermodata.test": f"{campaign}/{test}".encode()}
            pq.write_table(table.replace_schema_metadata({**(table.schema.metadata or {}), **note}), part)
        else:
            import pyarrow.csv

            names = [f"{c} [{units[c]}]" if units.get(c) else c for c in table.column_names]
            pyarrow.csv.write_csv(table.rename_columns(names), part)
        part.replace(out)
    finally:
        part.unlink(missing_ok=True)
    return Exported(str(out), kind, table.num_rows, list(table.column_names), units)


def _units(view: StoreView, campaign: str, test: str, columns: list[str]) -> dict[str, str]:
    found = view.sql("select channel, unit from channel where campaign = ? and test = ?", [campaign, test]).fetchall()
    known = {"t_s": "s", **{str(channel): str(unit) for channel, unit in found}}
    return {c: known[c] for c in columns if c in known}
