"""A sheet that is declared of files that have none is refused, whoever reads them."""

from __future__ import annotations

import json
from collections.abc import Callable
from copy import copy
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from thermodata.errors import UsageError
from thermodata.plugin import Recording, Signal, Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import readers

Look = Callable[[dict[str, Any]], Any]
CSV = "time,T1\n" + "".join(f"2026-03-02 08:00:{s:02},{20 + s}\n" for s in range(30))
TIMES = np.datetime64("2026-03-02T08:00:00", "us") + np.arange(60) * np.timedelta64(10, "s")


def sheet_of(sheet: Any = None, **others: Any) -> Any:
    return sheet


def by_match(table: dict[str, Any]) -> Any:
    match table:
        case {"sheet": sheet}:
            return sheet
    return None


# how a reader gets at a sheet: by its name, or out of the whole layout
BY_NAME: dict[str, Look] = {
    "get": lambda t: t.get("sheet"),
    "item": lambda t: t["sheet"] if "sheet" in t else None,  # noqa: SIM401
    "pop": lambda t: t.pop("sheet", None),
    "default": lambda t: t.setdefault("sheet", None),
    "match": by_match,
}
OF_ALL: dict[str, Look] = {
    "dict": lambda t: dict(t).get("sheet"),
    "items": lambda t: next((v for k, v in t.items() if k == "sheet"), None),
    "keys": lambda t: next((t[k] for k in t.keys() if k == "sheet"), None),  # noqa: SIM118
    "in turn": lambda t: next((t[k] for k in t if k == "sheet"), None),
    "unpacked": lambda t: {**t}.get("sheet"),
    "called": lambda t: sheet_of(**t),
    "copied": lambda t: t.copy().get("sheet"),
    "copy": lambda t: copy(t).get("sheet"),
    "united": lambda t: (t | {}).get("sheet"),
    "over defaults": lambda t: ({"sheet": None} | t).get("sheet"),
    "updated": lambda t: (d := {}, d.update(t), d.get("sheet"))[2],
    "JSON": lambda t: json.loads(json.dumps(t)).get("sheet"),
    "values": lambda t: next((v for v in t.values() if v != "none"), None),
}


class Plain:
    """A reader that takes a sheet in the way that `look` says, and heeds it or not."""

    name = "plain"

    def __init__(self, look: Look, *, heeds: bool = True) -> None:
        self.look, self.heeds = look, heeds

    def describe(self, path: Path, source: Source) -> Recording:
        sheet = self.look(source.table)  # type: ignore[arg-type]
        if not self.heeds or sheet is None:
            return Recording((Signal("T", "data"),), "relative")
        if sheet not in ("S1", "S2"):
            raise UsageError(f"no sheet '{sheet}'")
        return Recording((Signal(f"T_{sheet}", "data"),), "relative")


@pytest.mark.parametrize(("reader", "file"), [("cnc", "x.csv"), ("table", "x.csv"), ("table", "x.parquet")])
def test_files_without_sheets_refuse_one(tmp_path: Path, reader: str, file: str) -> None:
    (tmp_path / "x.csv").write_text(CSV)
    pq.write_table(pa.table({"time": pa.array(TIMES), "T1": np.arange(60.0)}), tmp_path / "x.parquet")
    assert described(readers()[reader], tmp_path / file, Source(table={"skip_rows": 0})).signals
    with pytest.raises(UsageError) as refused:
        described(readers()[reader], tmp_path / file, Source(table={"sheet": "S4000"}))
    error = refused.value
    assert (error.what, error.where) == (f"reader '{reader}' knows no sheets in such a file", file)
    assert error.got == "sheet: S4000"
    assert error.expected
    assert error.hint


@pytest.mark.parametrize("look", [*BY_NAME.values(), *OF_ALL.values()], ids=[*BY_NAME, *OF_ALL])
def test_a_reader_that_heeds_a_sheet_answers_for_it_itself(tmp_path: Path, look: Look) -> None:
    reader = Plain(look)
    assert described(reader, tmp_path / "x", Source(table={"sheet": "S2"})).signals[0].name == "T_S2"  # type: ignore[arg-type]
    assert described(reader, tmp_path / "x", Source(table={"series": "none"})).signals[0].name == "T"  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="no sheet 'S3'"):
        described(reader, tmp_path / "x", Source(table={"sheet": "S3"}))  # type: ignore[arg-type]


@pytest.mark.parametrize("look", [lambda t: None, *OF_ALL.values()], ids=["nothing", *OF_ALL])
def test_a_reader_that_looks_at_all_and_heeds_no_sheet_is_refused(tmp_path: Path, look: Look) -> None:
    reader = Plain(look, heeds=False)
    assert described(reader, tmp_path / "x", Source(table={"series": "none"}))  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="knows no sheets"):
        described(reader, tmp_path / "x", Source(table={"sheet": "S2"}))  # type: ignore[arg-type]


def test_columns_of_series_that_no_reader_looks_at_are_refused(tmp_path: Path) -> None:
    reader = Plain(lambda t: None)
    with pytest.raises(UsageError, match="parts no rows by what they are of") as refused:
        described(reader, tmp_path / "x", Source(table={"series": ["sensor"]}))  # type: ignore[arg-type]
    assert refused.value.got == "series: ['sensor']"
    assert described(reader, tmp_path / "x", Source(table={"series": "none"})).signals  # type: ignore[arg-type]


def test_columns_of_series_are_heeded_by_the_reader_of_tables(tmp_path: Path) -> None:
    rows = [f"2026-03-02 08:00:{s:02},{'ab'[s % 2]},{20 + s}" for s in range(30)]
    (tmp_path / "x.csv").write_text("\n".join(["time,spot,T", *rows, ""]))
    said = described(readers()["table"], tmp_path / "x.csv", Source(table={"series": ["spot"]}))
    assert {s.name for s in said.signals} == {"a/T", "b/T"}
