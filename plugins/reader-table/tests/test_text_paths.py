"""The quick way and the careful way through a text give the same, and damage is told on both."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.times.time_units import to_ns
from thermodata.testing.reader import Data, load

PRAGUE = Source(timezone="Europe/Prague")


def read(tmp_path: Path, text: str, source: Source = PRAGUE) -> Data:
    path = tmp_path / "x.csv"
    path.write_bytes(text.encode())
    return load(Reader(), path, source)


def test_what_is_odd_far_down_costs_its_own_rows_only(tmp_path: Path) -> None:
    n = 200_000
    rows = [f"{i},{i / 4}" for i in range(n)]
    rows[150_000] = "150000,broken"
    rows[160_000] = "160000"
    data = read(tmp_path, "t [s],T\n" + "\n".join(rows) + "\n")
    values = data.values["table", "T"]
    assert np.flatnonzero(np.isnan(values)).tolist() == [150_000]
    np.testing.assert_array_equal(data.t_ns["table"], np.delete(np.arange(n), 160_000) * 1_000_000_000)
    assert [(x.where, x.reason) for x in data.losses] == [
        ("x.csv line 150002 column 'T'", "expected a number, got 'broken'"),
        ("x.csv line 160002", "expected 2 cells, got 1: '160000'"),
    ]


def test_an_hour_that_repeats_far_down_is_resolved_over_all_rows(tmp_path: Path) -> None:
    start = np.datetime64("2025-10-25T20:00", "s")
    utc = start + np.arange(0, 12 * 3600, 10) * np.timedelta64(1, "s")
    shift = np.where(utc < np.datetime64("2025-10-26T01:00"), 7200, 3600) * np.timedelta64(1, "s")
    rows = [f"{str(t).replace('T', ' ')},{i}" for i, t in enumerate(utc + shift)]
    data = read(tmp_path, "time,T\n" + "\n".join(rows) + "\n")
    np.testing.assert_array_equal(data.t_ns["table"], utc.astype("datetime64[ns]").astype(np.int64))


@pytest.mark.parametrize(("cell", "value"), [("1.234,5", 1234.5), ("1 234,5", 1234.5), ("1_000", np.nan), ("7", 7.0)])
def test_marks_between_thousands(tmp_path: Path, cell: str, value: float) -> None:
    data = read(tmp_path, f"t [s];T\n0;1,5\n1;2,5\n2;3,5\n3;{cell}\n")
    np.testing.assert_array_equal(data.values["table", "T"][-1], value)
    assert bool(data.losses) == bool(np.isnan(value))


def test_a_line_between_header_and_data_is_named(tmp_path: Path) -> None:
    data = read(tmp_path, "t [s];T;n\n0;1\n1;2;3\n2;3;4\n3;4;5\n")
    assert any("line 2 between header and data" in n for n in data.recording.notes) or data.losses


def test_days_of_a_spreadsheet_are_dates_where_named_so_and_asked_else(tmp_path: Path) -> None:
    rows = "".join(f"{46082 + i / 1440!r},{i}\n" for i in range(20))
    data = read(tmp_path, "Datum,T\n" + rows)
    assert data.recording.clock == "absolute"
    assert np.datetime64(int(data.t_ns["table"][0]), "ns") == np.datetime64("2026-02-28T23:00")
    with pytest.raises(FormatError, match="unit: excel"):
        read(tmp_path, "Zeit,T\n" + rows)


@given(st.integers(-8_000_000_000, 8_000_000_000), st.integers(0, 999))
def test_seconds_with_milliseconds_are_exact(seconds: int, milli: int) -> None:
    got = to_ns(np.array([float(f"{seconds}.{milli:03}")]), 1.0)[0]
    want = seconds * 10**9 + (milli if not str(seconds).startswith("-") else -milli) * 10**6
    assert abs(int(got) - want) <= max(1, abs(seconds) // 4_000_000)  # the step of a double of this size


def test_tests_from_file_names_and_a_workbook_of_tests(tmp_path: Path) -> None:
    from thermodata.schema.files.load import load_campaign
    from thermodata.store import Store
    from thermodata.store.ingest.run import ingest
    from thermodata.view import StoreView

    from .test_workbook import least

    for nr, speed in ((1, 3000), (2, 9000)):
        rows = "".join(f"{i},{20 + i / 8 + nr}\n" for i in range(50))
        (tmp_path / f"S{speed}_{nr}.csv").write_text("time [s],T1 [degC]\n" + rows)

    def words(row: int, *values: object) -> str:
        return (
            f'<row r="{row}">'
            + "".join(
                f'<c r="{"ABC"[i]}{row}"><v>{v}</v></c>'
                if isinstance(v, int)
                else f'<c r="{"ABC"[i]}{row}" t="inlineStr"><is><t>{v}</t></is></c>'
                for i, v in enumerate(values)
            )
            + "</row>"
        )

    least(tmp_path / "tests.xlsx", words(1, "nr", "air", "n") + words(2, 1, "on", 3000) + words(3, 2, "off", 9000))
    (tmp_path / "campaign.yaml").write_text("""
schema: thermodata/campaign/1
id: c
sources: {daq: {reader: table}}
channels: {T1: {source: daq, signal: T1, quantity: temperature, unit: degC, at: spindle}}
tests_from:
  files: "S{speed}_{nr}.csv"
  table: {file: tests.xlsx, key: nr, columns: {air: air, speed: n}}
  units: {speed: rpm}
  set: {kind: spindle, role: calibration}
""")
    assert [t.conditions["air"] for t in load_campaign(tmp_path / "campaign.yaml").tests] == ["on", "off"]
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    found = StoreView(store).sql("select test, max(value) from sample group by test order by test").fetchall()
    assert found == [("S3000_1", 27.125), ("S9000_2", 28.125)]


@pytest.mark.parametrize("end", ["\r", "\n", "\r\n", "\n\r"])
@pytest.mark.parametrize("head", ["time [s];T", "Rig;138\n\ntime;T\ns;degC"])
@pytest.mark.parametrize("word", ["", ";idle"])
def test_all_rows_come_whatever_ends_the_lines(tmp_path: Path, head: str, end: str, word: str) -> None:
    text = head + "".join(f"\n{i};{i / 4}" for i in range(50)) + "\n"
    for more in ("", "x\n" if word else ""):  # the second of them goes the careful way
        data = read(tmp_path, (text + more).replace("\n", end))
        np.testing.assert_array_equal(data.t_ns["table"], np.arange(50) * 10**9)
        np.testing.assert_array_equal(data.values["table", "T"], np.arange(50) / 4)


def test_a_quote_left_open_behind_the_header_costs_its_own_line(tmp_path: Path) -> None:
    rows = "".join(f'"{i}","{i / 4}","7","8"\n' for i in range(1, 40))
    data = read(tmp_path, '"time [s]","T","a","b"\n"0","\n' + rows)
    assert (data.t_ns["table"] // 10**9).tolist() == list(range(1, 40))
    assert [x.where for x in data.losses] == ["x.csv line 2"] or "line 2" in data.recording.notes[0]
