"""A sheet that is declared of files that have none is refused, whoever reads them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from thermodata.errors import UsageError
from thermodata.plugin import Recording, Signal, Source
from thermodata.reader.guard import described
from thermodata.reader.registry import readers

CSV = "time,T1\n" + "".join(f"2026-03-02 08:00:{s:02},{20 + s}\n" for s in range(30))
TIMES = np.datetime64("2026-03-02T08:00:00", "us") + np.arange(60) * np.timedelta64(10, "s")


class Plain:
    """A reader that keeps what it is told in the way that `look` says."""

    name = "plain"

    def __init__(self, look: str) -> None:
        self.look = look

    def describe(self, path: Path, source: Source) -> Recording:
        table = source.table or {}
        {"nothing": lambda: None, "get": lambda: table.get("sheet"), "copy": lambda: dict(table)}[self.look]()
        return Recording((Signal("T", "data"),), "relative")


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


@pytest.mark.parametrize(("look", "refused"), [("nothing", True), ("get", False), ("copy", False)])
def test_a_reader_that_looks_at_the_sheet_answers_for_it_itself(tmp_path: Path, look: str, refused: bool) -> None:
    reader = Plain(look)
    if refused:
        with pytest.raises(UsageError, match="knows no sheets"):
            described(reader, tmp_path / "x", Source(table={"sheet": 1}))  # type: ignore[arg-type]
    else:
        assert described(reader, tmp_path / "x", Source(table={"sheet": 1}))  # type: ignore[arg-type]
    assert described(reader, tmp_path / "x", Source(table={"series": "none"}))  # type: ignore[arg-type]
