"""Times as a week of GPS and the seconds in it, in two columns: asked with what they are then, in UTC."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io

from tests.draft.labs import workbook
from thermodata.draft.make import draft_files
from thermodata.errors import QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.finding.registry import readers

AT = datetime(2026, 3, 14, 23, 55, tzinfo=UTC)  # a Saturday: the week of GPS ends within the rows
FIRST = (AT - datetime(1980, 1, 6, tzinfo=UTC)).total_seconds() + 18
TIMES = FIRST + 30.0 * np.arange(40)
WEEKS, SECONDS = np.floor(TIMES / 604_800), TIMES % 604_800
NS = [int(AT.timestamp()) * 10**9 + 30 * k * 10**9 for k in range(40)]


def written(folder: Path, ext: str, week: str, of_week: str, *, scale: int = 1, weeks: object = WEEKS) -> Path:
    path, values = folder / f"run.{ext}", np.linspace(20, 25, 40)
    columns = {week: np.asarray(weeks).astype(int), of_week: SECONDS * scale, "T [degC]": values}
    rows = [list(r) for r in zip(*(c.tolist() for c in columns.values()), strict=True)]
    if ext == "xlsx":
        workbook(path, {"log": [list(columns), *rows]})
    elif ext == "parquet":
        pq.write_table(pa.table(columns), path)
    elif ext == "mat":
        scipy.io.savemat(path, {week: columns[week].astype(float), of_week: columns[of_week], "T": values})
    else:
        path.write_text("\n".join([",".join(columns), *(",".join(f"{v:.15g}" for v in r) for r in rows), ""]))
    return path


def times(path: Path, time: dict[str, object] | None = None) -> list[int]:
    source = Source(timezone="Europe/Berlin", table={"time": time} if time else None)
    reader = readers()["table"]
    recording = described(reader, path, source)
    assert recording.clock == "absolute"
    return [int(t) for b in guarded(reader, path, source, recording) if isinstance(b, Block) for t in b.t_ns]


@pytest.mark.parametrize("ext", ["csv", "xlsx", "parquet"])
@pytest.mark.parametrize(
    ("week", "of_week", "scale"),
    [
        ("gps_week", "gps_seconds", 1),
        ("GPS Week", "TOW [s]", 1),
        ("week", "seconds_of_week", 1),
        ("GPSWeek", "SoW", 1),
        ("gps_week", "tow_ms", 1000),
        ("week", "iTOW", 1000),
        ("gps_week", "gps_time", 1),
    ],
)
def test_a_week_and_the_time_in_it_are_asked_together(
    tmp_path: Path, ext: str, week: str, of_week: str, scale: int
) -> None:
    path = written(tmp_path, ext, week, of_week, scale=scale)
    with pytest.raises(QuestionError) as asked:
        times(path)
    assert "2026-03-14 23:55:00 UTC" in asked.value.ask
    assert asked.value.declare["time"]["column"] == [1, 2]
    assert times(path, dict(asked.value.declare["time"])) == NS
    (source,) = draft_files(tmp_path).draft.sources
    assert source.table == asked.value.declare


def test_a_number_of_ten_bits_began_anew(tmp_path: Path) -> None:
    path = written(tmp_path, "csv", "gps_week", "tow", weeks=WEEKS % 1024)
    with pytest.raises(QuestionError) as asked:
        times(path)
    assert asked.value.declare["time"]["format"] == "gps_week+2048 gps_s"
    assert times(path, dict(asked.value.declare["time"])) == NS


def test_two_vectors_of_a_mat_file_are_read_so_and_noted(tmp_path: Path) -> None:
    path = written(tmp_path, "mat", "gps_week", "tow")
    assert times(path) == NS
    recording = described(readers()["table"], path, Source())
    assert [s.name for s in recording.signals] == ["T"]
    assert any("weeks of GPS" in n for n in recording.notes)


@pytest.mark.parametrize(("week", "of_week"), [("week", "seconds"), ("Kalenderwoche", "tow"), ("week", "tow_force")])
def test_other_weeks_ask_what_they_asked(tmp_path: Path, week: str, of_week: str) -> None:
    path = written(tmp_path, "csv", week, of_week)
    with pytest.raises(QuestionError) as asked:
        times(path)
    assert "GPS" not in asked.value.ask


def test_weeks_beside_dates_are_signals(tmp_path: Path) -> None:
    rows = [f"2026-03-14T23:{i:02}:00Z,{int(WEEKS[0])},{SECONDS[i]:g},{20 + i / 10}" for i in range(40)]
    path = tmp_path / "run.csv"
    path.write_text("\n".join(["time,gps_week,tow,T [degC]", *rows, ""]))
    assert len(times(path)) == 40
