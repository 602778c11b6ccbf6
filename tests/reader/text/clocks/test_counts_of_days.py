"""Julian days and decimal years are known by size and step, and a unit in which numbers are no times is told."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files
from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Recording, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.clocks.counts_of_days import counted_by, quick_note
from thermodata.reader.times.time_units import EPOCHS

SEVEN = 1772434800 * 10**9  # 2026-03-02 07:00 UTC
DAYS = np.arange(60) * 20 / 86400


def _read(folder: Path, name: str, times: Sequence[float], time: object = None) -> tuple[Recording, list[int]]:
    path = folder / "a.csv"
    path.write_text("\n".join([f"{name},T1 [degC],n", *(f"{t:.10f},2{i % 9}.5,{i}" for i, t in enumerate(times)), ""]))
    source = Source(table={"time": time} if time else None)
    table = delimited.open_table(path, source)
    ns = [int(t) for b in delimited.blocks(path, table, source) if isinstance(b, Block) for t in b.t_ns]
    return delimited.describe(table, source), ns


@pytest.mark.parametrize(
    ("name", "first", "each_day", "unit"),
    [
        ("JD", 2461101.7916666667, 1.0, "jd"),
        ("MJD", 61101.2916666667, 1.0, "mjd"),
        ("year", 2026 + (60 + 7 / 24) / 365, 1 / 365, "decimal_year"),
        ("column", 2026 + (60 + 7 / 24) / 365, 1 / 365, "decimal_year"),
    ],
)
@pytest.mark.parametrize("called_time", [True, False])
def test_counts_of_days_and_years_are_asked_as_such_and_read(
    tmp_path: Path, name: str, first: float, each_day: float, unit: str, called_time: bool
) -> None:
    name = f"Time {name}" if called_time and unit != "mjd" else name
    with pytest.raises(QuestionError) as asked:
        _read(tmp_path, name, first + DAYS * each_day)
    assert asked.value.declare["time"]["unit"] == unit
    assert "2026-03-02 07:00:00" in asked.value.ask
    assert "unit: s" not in f"{asked.value.ask} {asked.value.hint}"
    said, ns = _read(tmp_path, name, first + DAYS * each_day, {"column": 1, "unit": unit})
    assert said.clock == "absolute"
    assert np.abs(np.array(ns) - SEVEN - np.arange(60) * 20 * 10**9).max() < 6e6  # ten digits of a year: 3 ms


def test_a_draft_asks_for_the_unit_of_rows_that_are_too_quick(tmp_path: Path) -> None:
    years = 2026 + (60 + 7 / 24) / 365 + DAYS / 365
    for name, asked in (("t [s]", True), ("t [h]", False)):
        folder = tmp_path / name
        folder.mkdir()
        times = years if asked else np.arange(60) / 3600
        (folder / "a.csv").write_text(
            "\n".join([f"{name},T1 [degC]", *(f"{t:.10f},2{i % 9}.5" for i, t in enumerate(times)), ""])
        )
        draft_files(folder)
        assert ("0.63 us apart" in (folder / "campaign.yaml").read_text()) is asked


@pytest.mark.parametrize(
    "values",
    [
        2026.0 + np.arange(60),  # years
        2026.5 + np.arange(60) * 0.05,  # 18 days from row to row
        1995.0 + np.arange(60) * 0.01,  # seconds at 100 Hz, of a log that is cut out of a longer one
        np.linspace(2026.9, 2026.1, 60),  # falls
        2461101.0 + np.arange(60),  # whole numbers
        61101.25 + DAYS,  # of days, but of Excel's as well
    ],
)
def test_numbers_that_may_be_anything_are_no_counts(values: np.ndarray) -> None:
    assert counted_by("x", values) is None


def test_a_decimal_year_is_as_long_as_it_is() -> None:
    ns = EPOCHS["decimal_year"].ns(np.array([2024.5, 2025.5, 2026.0, np.nan, 99999.0]))
    assert ns[:3].astype("datetime64[ns]").astype("datetime64[h]").astype(str).tolist() == [
        "2024-07-02T00",
        "2025-07-02T12",
        "2026-01-01T00",
    ]
    assert (ns[3:] == np.iinfo(np.int64).min).all()


def test_days_beyond_any_time_are_refused_with_what_they_may_be(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="can be no time in d") as told:
        _read(tmp_path, "JD", 2461101.7916666667 + DAYS, {"column": 1, "unit": "d"})
    assert "unit: jd" in str(told.value.hint)
    assert "2026-03-02 07:00:00" in str(told.value.hint)
    assert _read(tmp_path, "age", 1000 + DAYS, {"column": 1, "unit": "d"})[0].clock == "relative"


def test_a_unit_of_the_header_that_can_not_be_is_asked_for_and_claimed(tmp_path: Path) -> None:
    """Unix milliseconds below 'time [s]': a reader claims the file, and a draft asks."""
    with pytest.raises(QuestionError, match="can be no time in s") as asked:
        _read(tmp_path, "time [s]", 1772438400000.0 + 1000 * np.arange(60))
    assert asked.value.declare == {"time": {"unit": "unix_ms"}}
    draft_files(tmp_path)
    assert "1772438400000 is 2026-03-02 08:00:00 then" in (tmp_path / "campaign.yaml").read_text()
    with pytest.raises(FormatError) as told:
        _read(tmp_path, "time [s]", 1e25 + 1e21 * np.arange(60))
    assert not isinstance(told.value, QuestionError)


def test_rows_that_are_too_quick_are_told(tmp_path: Path) -> None:
    years = 2026 + (60 + 7 / 24) / 365 + DAYS / 365
    said, _ = _read(tmp_path, "year", years, {"column": 1, "unit": "s"})
    assert any("0.63 us apart by 'year' in s: is that its unit; as decimal_year" in n for n in said.notes)
    assert quick_note("t", np.arange(60) * 1e-5, "s") is None
    assert quick_note("t", np.arange(60) * 4e-6, "s") is not None
    assert quick_note("t", np.zeros(60), "s") is None


OLE_DAYS = 46083.2916666667 + DAYS  # 2026-03-02 07:00


@pytest.mark.parametrize(("name", "other"), [("Time [d]", "d (days from a start)"), ("Time", "s?")])
def test_days_of_excel_are_asked_whether_their_header_says_days_or_nothing(
    tmp_path: Path, name: str, other: str
) -> None:
    with pytest.raises(QuestionError) as asked:
        _read(tmp_path, name, OLE_DAYS)
    assert asked.value.declare["time"]["unit"] == "unknown"
    assert "2026-03-02" in asked.value.ask
    assert other in asked.value.ask
    assert _read(tmp_path, name, OLE_DAYS, {"unit": "excel"})[1][0] // 10**9 == SEVEN // 10**9
    assert _read(tmp_path, name, OLE_DAYS, {"unit": "d"})[0].clock == "relative"


@pytest.mark.parametrize("units", ["days,degC,degC", None])
def test_days_of_ole_by_their_name_are_read_whatever_the_row_of_units_says(tmp_path: Path, units: str | None) -> None:
    rows = (f"{t:.10f},2{i % 9}.5,2{i % 8}.25" for i, t in enumerate(OLE_DAYS))
    (tmp_path / "a.csv").write_text("\n".join(["Timestamp (OADate),T1,T2", *([units] if units else []), *rows, ""]))
    table = delimited.open_table(tmp_path / "a.csv", Source())
    (first, *_) = [b for b in delimited.blocks(tmp_path / "a.csv", table, Source()) if isinstance(b, Block)]
    assert int(first.t_ns[0]) // 10**9 == SEVEN // 10**9
    assert any("counts days from a date by its size: excel" in note for note in table.notes) is (units is not None)


def test_days_that_count_from_a_start_are_taken_so(tmp_path: Path) -> None:
    assert _read(tmp_path, "Time [d]", DAYS)[0].clock == "relative"
