"""One test as a Parquet, CSV, Excel, MAT or MDF4 file, units in the columns' names or metadata."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError
from thermodata.export.content import LOGGED, check_test, read_content
from thermodata.schema.agreed.exported import SIGN, TIME_UTC, UNSIGNED
from thermodata.schema.words.sentences import listed
from thermodata.store.base.files import whole_file

if TYPE_CHECKING:
    from thermodata.view import StoreView

_SUFFIXES = {
    "parquet": (".parquet", ".pq"),
    "csv": (".csv",),
    "xlsx": (".xlsx",),
    "mat": (".mat",),
    "mdf4": (".mf4", ".mdf"),
}
FORMATS = tuple(_SUFFIXES)


@dataclass(frozen=True, slots=True)
class Exported:
    """What was written. rows: of the longest stream; streams: rows of each, where there are several; units: column ->
    canonical unit."""

    path: str
    format: str
    rows: int
    columns: list[str]
    units: dict[str, str]
    streams: dict[str, int] | None = None


def export_test(
    view: StoreView, campaign: str, test: str, out: Path, *, step: str, kind: str | None = None
) -> Exported:
    """Write `binned(campaign, test, step)` to `out`; kind None: by its suffix. step 'logged' (Excel, MAT, MDF4): each
    source at its own times, with its flags. UsageError on unknown names, and where `out` is called after another
    format; ThermodataError where `out` can't be written."""
    said = next((k for k, suffixes in _SUFFIXES.items() if out.suffix.lower() in suffixes), None)
    if kind is not None and said not in (None, kind):
        raise UsageError(
            "the file's name says another format",
            where=str(out),
            expected=f"a name that ends with {' or '.join(_SUFFIXES[kind])}",
            got=f"{out.suffix} as {kind}",
            hint=f"leave --format out, or name it {out.with_suffix(_SUFFIXES[kind][0]).name}",
        )
    kind = kind or said
    if kind is None:
        raise UsageError(
            "the file's name does not say the format",
            where=str(out),
            expected=listed([suffixes[0] for suffixes in _SUFFIXES.values()], "or"),
            got=out.suffix or "no suffix",
            hint=f"name it {out.with_suffix('.xlsx').name}, say, which Excel opens",
        )
    check_test(view, campaign, test)
    if step == LOGGED and kind in ("parquet", "csv"):
        raise UsageError(
            "sources that were logged at their own times are no one table",
            expected="a step such as 1 s",
            got=f"{step} as {kind}",
            hint="--format xlsx, mat or mdf4",
        )
    write = _write_table if kind in ("parquet", "csv") else _write_streams
    with whole_file(out, ".mf4" if kind == "mdf4" else "") as part:  # asammdf names the file itself
        sizes, columns, units = write(view, campaign, test, step, part, kind)
    streams = sizes if len(sizes) > 1 else None
    return Exported(str(out), kind, max(sizes.values(), default=0), columns, units, streams)


def _write_streams(
    view: StoreView, campaign: str, test: str, step: str, part: Path, kind: str
) -> tuple[dict[str, int], list[str], dict[str, str]]:
    content = read_content(view, campaign, test, step)
    if kind == "xlsx":
        from thermodata.export.xlsx import write_xlsx

        write_xlsx(content, part)
    elif kind == "mat":
        from thermodata.export.mat import write_mat

        write_mat(content, part)
    else:
        from thermodata.export.mdf import write_mdf

        write_mdf(content, part)
    columns = [name for s in content.streams for name in s.values]
    time = "t_s" if kind == "xlsx" else "time"
    dated = [TIME_UTC] if kind == "xlsx" and content.start_ns is not None else []
    return (
        {s.name: s.t_s.size for s in content.streams},
        [*dated, time, *columns],
        {time: "s", **{c: content.unit(c) for c in columns if content.unit(c)}},
    )


def _write_table(
    view: StoreView, campaign: str, test: str, step: str, part: Path, kind: str
) -> tuple[dict[str, int], list[str], dict[str, str]]:
    table: Any = view.binned(campaign, test, step=step).to_arrow_table()
    units = _units(view, campaign, test, table.column_names)
    signs = _signs(view, campaign, test)
    if kind == "parquet":
        import pyarrow.parquet as pq

        note = {b"thermodata.units": json.dumps(units).encode(), b"thermodata.test": f"{campaign}/{test}".encode()}
        table = _with_metadata(table, units, signs)
        pq.write_table(table.replace_schema_metadata(note), part)
    else:
        import pyarrow.csv

        table = _with_utc(table)
        bare = {c for c, sign in signs.items() if sign == "unknown"}
        names = [
            c + (UNSIGNED if c in bare else "") + (f" [{units[c]}]" if c in units else "") for c in table.column_names
        ]
        pyarrow.csv.write_csv(table.rename_columns(names), part)
    return {"grid": table.num_rows}, list(table.column_names), units


def _with_metadata(table: Any, units: Mapping[str, str], signs: Mapping[str, str]) -> Any:
    """The columns with their units and signs as metadata of each, and the times as what they are: in UTC. Without these
    where no clock was absolute."""
    import pyarrow as pa

    times = table.column("t")
    at = table.column_names.index("t")
    if times.null_count == len(times):
        table = table.remove_column(at)
    else:
        table = table.set_column(at, "t", times.cast(pa.timestamp("ns")).cast(pa.timestamp("ns", "UTC")))
    fields = []
    for field in table.schema:
        said = {"unit": units.get(field.name), SIGN: signs.get(field.name)}
        fields.append(field.with_metadata({k: v for k, v in said.items() if v} or None))
    return table.cast(pa.schema(fields))


def _with_utc(table: Any) -> Any:
    """The times as text that says that it is in UTC: 2026-03-30T06:00:30Z. Without them where no clock was absolute."""
    import pyarrow as pa
    import pyarrow.compute as pc

    at = table.column_names.index("t")
    times = table.column("t")
    if times.null_count == len(times):
        return table.remove_column(at)
    ns = times.cast(pa.timestamp("ns"))
    since = ns.cast(pa.int64()).drop_null().to_numpy()
    unit = next((u for u, size in (("s", 10**9), ("ms", 10**6), ("us", 10**3)) if not (since % size).any()), "ns")
    return table.set_column(at, TIME_UTC, pc.strftime(ns.cast(pa.timestamp(unit)), "%Y-%m-%dT%H:%M:%SZ"))


def _signs(view: StoreView, campaign: str, test: str) -> dict[str, str]:
    """Of each displacement its sign: unknown where nothing turned it to the machine's axes, which a file that leaves
    the store has to say."""
    found = view.sql(
        "select channel, sign from channel where campaign = ? and test = ? and quantity in ('displacement', 'tilt')",
        [campaign, test],
    ).fetchall()
    return {str(channel): str(sign or "unknown") for channel, sign in found}


def _units(view: StoreView, campaign: str, test: str, columns: list[str]) -> dict[str, str]:
    found = view.sql("select channel, unit from channel where campaign = ? and test = ?", [campaign, test]).fetchall()
    known = {"t_s": "s", **{str(channel): str(unit) for channel, unit in found}}
    return {c: known[c] for c in columns if c in known}
