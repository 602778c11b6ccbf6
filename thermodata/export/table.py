"""One test as a Parquet, CSV, MAT or MDF4 file, units in the columns' names or metadata."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError
from thermodata.export.content import LOGGED, check_test, read_content
from thermodata.store.base.files import whole_file

if TYPE_CHECKING:
    from thermodata.view import StoreView

FORMATS = ("parquet", "csv", "mat", "mdf4")
_BY_SUFFIX = {".parquet": "parquet", ".pq": "parquet", ".csv": "csv", ".mat": "mat", ".mf4": "mdf4", ".mdf": "mdf4"}


@dataclass(frozen=True, slots=True)
class Exported:
    """What was written. rows: of the longest stream; units: column -> canonical unit."""

    path: str
    format: str
    rows: int
    columns: list[str]
    units: dict[str, str]


def export_test(
    view: StoreView, campaign: str, test: str, out: Path, *, step: str, kind: str | None = None
) -> Exported:
    """Write `binned(campaign, test, step)` to `out`; kind None: by its suffix. step 'logged' (MAT and MDF4): each
    source at its own times, with its flags. UsageError on unknown names; ThermodataError where `out` can't be
    written."""
    kind = kind or _BY_SUFFIX.get(out.suffix.lower())
    if kind not in FORMATS:
        raise UsageError(
            "the file's name does not say the format",
            where=str(out),
            expected=".parquet, .csv, .mat or .mf4",
            got=out.suffix or "no suffix",
            hint="--format parquet",
        )
    check_test(view, campaign, test)
    if step == LOGGED and kind in ("parquet", "csv"):
        raise UsageError(
            "sources that were logged at their own times are no one table",
            expected="a step such as 1 s",
            got=f"{step} as {kind}",
            hint="--format mat or mdf4",
        )
    write = _write_table if kind in ("parquet", "csv") else _write_streams
    with whole_file(out, ".mf4" if kind == "mdf4" else "") as part:  # asammdf names the file itself
        rows, columns, units = write(view, campaign, test, step, part, kind)
    return Exported(str(out), kind, rows, columns, units)


def _write_streams(
    view: StoreView, campaign: str, test: str, step: str, part: Path, kind: str
) -> tuple[int, list[str], dict[str, str]]:
    content = read_content(view, campaign, test, step)
    if kind == "mat":
        from thermodata.export.mat import write_mat

        write_mat(content, part)
    else:
        from thermodata.export.mdf import write_mdf

        write_mdf(content, part)
    columns = [name for s in content.streams for name in s.values]
    return (
        max((s.t_s.size for s in content.streams), default=0),
        ["t_s", *columns],
        {"t_s": "s", **{c: content.unit(c) for c in columns if content.unit(c)}},
    )


def _write_table(
    view: StoreView, campaign: str, test: str, step: str, part: Path, kind: str
) -> tuple[int, list[str], dict[str, str]]:
    table: Any = view.binned(campaign, test, step=step).to_arrow_table()
    units = _units(view, campaign, test, table.column_names)
    if kind == "parquet":
        import pyarrow.parquet as pq

        note = {b"thermodata.units": json.dumps(units).encode(), b"thermodata.test": f"{campaign}/{test}".encode()}
        pq.write_table(table.replace_schema_metadata({**(table.schema.metadata or {}), **note}), part)
    else:
        import pyarrow.csv

        names = [f"{c} [{units[c]}]" if units.get(c) else c for c in table.column_names]
        pyarrow.csv.write_csv(table.rename_columns(names), part)
    return table.num_rows, list(table.column_names), units


def _units(view: StoreView, campaign: str, test: str, columns: list[str]) -> dict[str, str]:
    found = view.sql("select channel, unit from channel where campaign = ? and test = ?", [campaign, test]).fetchall()
    known = {"t_s": "s", **{str(channel): str(unit) for channel, unit in found}}
    return {c: known[c] for c in columns if c in known}
