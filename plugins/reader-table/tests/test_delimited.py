"""Delimited text: layouts declared and found, times, numbers, damage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError, QuestionError, UsageError
from thermodata.plugin import Head, Source
from thermodata.testing.reader import Data, load

S = 1_000_000_000


def read(
    tmp_path: Path, text: str, encoding: str = "utf-8", timezone: str | None = "Europe/Prague", **table: Any
) -> Data:
    path = tmp_path / "x.csv"
    path.write_bytes(text.encode(encoding))
    return load(Reader(), path, Source(timezone=timezone, table=table or None))


def utc(text: str) -> int:
    return int(np.datetime64(text, "ns").astype(np.int64))


def test_semicolon_decimal_comma_units_row_and_cp1250(tmp_path: Path) -> None:
    text = "Datum a čas;Teplota ložiska;Výkon\n;°C;kW\n1.3.2026 8:00:00;20,5;1,25\n1.3.2026 8:00:10;20,75;1,5\n"
    data = read(tmp_path, text, "cp1250")
    assert [(s.name, s.unit) for s in data.recording.signals] == [("Teplota ložiska", "°C"), ("Výkon", "kW")]
    np.testing.assert_array_equal(data.t_ns["table"], [utc("2026-03-01T07:00:00"), utc("2026-03-01T07:00:10")])
    np.testing.assert_array_equal(data.values["table", "Teplota ložiska"], [20.5, 20.75])
    assert "cp1250" in data.recording.notes[0]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("2026-03-01 08:00:00.125", "2026-03-01T07:00:00.125"),
        ("2026-03-01T08:00:00Z", "2026-03-01T08:00:00"),
        ("2026-03-01T08:00:00+02:00", "2026-03-01T06:00:00"),
        ("2026/3/1 8:00", "2026-03-01T07:00"),
        ("01.03.2026 08:00:00", "2026-03-01T07:00"),
        ("1. 3. 2026 8:00:00", "2026-03-01T07:00"),
        ("13/03/2026 08:00:00", "2026-03-13T07:00"),
        ("03/13/2026 08:00:00 PM", "2026-03-13T19:00"),
    ],
)
def test_dates_as_labs_write_them(tmp_path: Path, written: str, meant: str) -> None:
    data = read(tmp_path, f"time;T [degC]\n{written};1.5\n{written};2.5\n")
    assert data.t_ns["table"].tolist() == [utc(meant)] * 2
    assert data.recording.clock == "absolute"


def test_day_and_month_that_could_be_either_are_refused_unless_declared(tmp_path: Path) -> None:
    text = "time;T\n03/04/2026 08:00:00;1.5\n03/05/2026 08:00:00;2.5\n"
    with pytest.raises(FormatError, match="either way round"):
        read(tmp_path, text)
    data = read(tmp_path, text, time={"column": 1, "format": "%d/%m/%Y %H:%M:%S"})
    assert data.t_ns["table"][0] == utc("2026-04-03T06:00:00")


def test_the_day_may_show_far_down(tmp_path: Path) -> None:
    rows = [f"03/{1 + i // 1440:02}/2026 {i // 60 % 24:02}:{i % 60:02}:00;{i}" for i in range(20_000)]
    data = read(tmp_path, "time;T [degC]\n" + "\n".join(rows) + "\n", timezone="UTC")
    assert data.recording.start_ns == utc("2026-03-01")
    assert set(np.diff(data.t_ns["table"]).tolist()) == {60 * S}


def test_date_and_time_columns_join_and_the_repeated_hour_is_resolved(tmp_path: Path) -> None:
    rows = [("26.10.2025", f"{h:02}:{m:02}:00") for h, m in [(1, 30), (2, 0), (2, 30), (2, 0), (2, 30), (3, 0)]]
    text = "Datum;Uhrzeit;T [°C]\n" + "".join(f"{d};{t};{i},5\n" for i, (d, t) in enumerate(rows))
    data = read(tmp_path, text)
    assert set(np.diff(data.t_ns["table"]).tolist()) == {1800 * S}
    assert data.t_ns["table"][0] == utc("2025-10-25T23:30")


@pytest.mark.parametrize(("unit", "factor"), [("s", 1), ("min", 60), ("h", 3600), ("ms", 0.001)])
def test_relative_times_in_any_unit(tmp_path: Path, unit: str, factor: float) -> None:
    data = read(tmp_path, f"time [{unit}],T\n0,1.5\n0.5,2.5\n10,3.5\n")
    assert data.recording.clock == "relative"
    np.testing.assert_array_equal(data.t_ns["table"], (np.array([0, 0.5, 10]) * factor * S).astype(int))


def test_preamble_group_row_and_declared_layout(tmp_path: Path) -> None:
    text = "Machine 138\nOperator;Novák\n\nclock;probe a;probe b\nh;um;um\n0;1,5;2\n0,5;2,5;3\n"
    found = read(tmp_path, text, skip_rows=3, header_rows=2, units_row=5, time={"column": "clock", "unit": "h"})
    assert [(s.name, s.unit) for s in found.recording.signals] == [("probe a", "um"), ("probe b", "um")]
    np.testing.assert_array_equal(found.t_ns["table"], [0, 1800 * S])


def test_declared_names_are_those_of_files_without_a_header(tmp_path: Path) -> None:
    names = ["t [min]", "T", "dZ [um]"]
    found = read(tmp_path, "0,20.5,1.5\n1,20.6,2.5\n2,20.7,3.5\n", names=names)
    assert [(s.name, s.unit) for s in found.recording.signals] == [("T", None), ("dZ [um]", "um")]
    np.testing.assert_array_equal(found.t_ns["table"], [0, 60 * S, 120 * S])
    own = read(tmp_path, "t [s],a,b\n0,20.5,1.5\n1,20.6,2.5\n2,20.7,3.5\n", names=names)
    assert [s.name for s in own.recording.signals] == ["a", "b"]
    np.testing.assert_array_equal(own.t_ns["table"], [0, S, 2 * S])


@pytest.mark.parametrize("row", ["20.5", "20.5,1.5,7"])
def test_declared_names_have_to_be_of_all_columns(tmp_path: Path, row: str) -> None:
    with pytest.raises(FormatError, match="other columns than are declared") as refused:
        read(tmp_path, "".join(f"{k},{row}\n" for k in range(5)), names=["t [min]", "T", "dZ [um]"])
    assert refused.value.got == f"{row.count(',') + 2} columns"


def test_text_columns_empty_cells_and_words_among_numbers(tmp_path: Path) -> None:
    text = "time [s];T [degC];note;door\n0;20,5;start;TRUE\n1;;ok;FALSE\n2;broken;ok;TRUE\n3;20,8;;TRUE\n4;20,9;;TRUE\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["table", "T [degC]"], [20.5, np.nan, np.nan, 20.8, 20.9])
    np.testing.assert_array_equal(data.values["table", "door"], [1, 0, 1, 1, 1])
    assert list(data.values["table", "note"]) == ["start", "ok", "ok", None, None]
    assert [(x.where, x.reason) for x in data.losses] == [
        ("x.csv line 4 column 'T [degC]'", "expected a number, got 'broken'")
    ]


def test_one_word_far_down_a_column_of_numbers_costs_one_cell(tmp_path: Path) -> None:
    n = 60_000
    rows = [f"{i};{i / 4}".replace(".", ",") for i in range(n)]
    rows[45_000] = "45000;broken"
    data = read(tmp_path, "time [s];T\n" + "\n".join(rows) + "\n")
    values = data.values["table", "T"]
    assert np.flatnonzero(np.isnan(values)).tolist() == [45_000]
    np.testing.assert_array_equal(np.delete(values, 45_000), np.delete(np.arange(n) / 4, 45_000))
    assert (data.losses[0].where, data.losses[0].reason) == (
        "x.csv line 45002 column 'T'",
        "expected a number, got 'broken'",
    )


def test_a_temperature_called_t_is_no_time(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no time column"):
        read(tmp_path, "T;n\n20.5;100\n20.6;200\n")


def test_names_that_repeat_are_told_apart(tmp_path: Path) -> None:
    data = read(tmp_path, "time [s];T;T;\n0;1;2;3\n1;4;5;6\n")
    assert [s.name for s in data.recording.signals] == ["T", "T#2", "column 4"]


def test_rows_without_a_time_are_a_loss(tmp_path: Path) -> None:
    data = read(tmp_path, "time [s];T\n0;1\n1;2\n2;3\npower gone;\n")
    assert data.t_ns["table"].size == 3
    assert data.losses[0].where == "x.csv line 5"
    assert data.losses[0].reason == "expected a time as a number [s], got 'power gone'"


def test_a_cut_last_line_is_a_loss_and_not_a_value(tmp_path: Path) -> None:
    data = read(tmp_path, "time [s];T\n0;12.25\n1;12.50\n2;12.7")
    np.testing.assert_array_equal(data.values["table", "T"], [12.25, 12.5])
    assert data.recording.complete is False
    assert "ends without a line end" in data.losses[0].reason


def test_a_whole_last_line_without_line_end_is_kept(tmp_path: Path) -> None:
    data = read(tmp_path, "time [s];T\n0;12.25\n1;12.50\n2;12.75")
    assert data.values["table", "T"][-1] == 12.75
    assert data.losses == ()


def test_a_line_far_too_long_is_lost_alone_with_its_number(tmp_path: Path) -> None:
    data = read(tmp_path, "time [s];T\n0;1\n1;2\n2;3" + ";9" * 20 + "\n" + "3;4\n" * 5)
    assert data.t_ns["table"].size == 7
    assert [(x.where, x.reason[:26]) for x in data.losses] == [("x.csv line 4", "expected 2 cells, got 22: ")]


def test_a_wrong_column_name_is_answered_with_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="did you mean 'Zeit'"):
        read(tmp_path, "Zeit;T\n0;1\n1;2\n", time={"column": "Ziet", "unit": "s"})


def test_utf16_of_a_spreadsheet(tmp_path: Path) -> None:
    data = read(tmp_path, "Zeit [s]\tT [°C]\n0\t20,5\n1\t20,75\n", "utf-16")
    np.testing.assert_array_equal(data.values["table", "T [°C]"], [20.5, 20.75])


@pytest.mark.parametrize(
    "text",
    [
        "LabVIEW Measurement\t\nWriter_Version\t2\n",
        "2009-06-15T00:00:00|power|ON\n2009-06-15T00:00:01|Xabs|1\n",
        "Dear reader,\nthe probe, as said, failed.\nYours, N.\n",
        "1;2;3\n4;5;6\n",
    ],
)
def test_text_that_is_no_table_is_not_claimed(text: str) -> None:
    assert Reader().sniff(Head("x.csv", len(text), text.encode())) is None


def test_a_first_row_whose_time_is_destroyed_is_told_and_no_header(tmp_path: Path) -> None:
    rows = "".join(f"2026-03-01 08:{m:02d}:00,{20 + m / 8:.3f},{-m / 4:.2f}\n" for m in range(1, 30))
    data = read(tmp_path, "time,T1 [degC],dZ [um]\nERR,20.000,0.00\n" + rows)
    assert {name for _, name in data.values} == {"T1 [degC]", "dZ [um]"}
    assert len(data.t_ns["table"]) == 29
    assert [x.where for x in data.losses] == ["x.csv line 2"]


def _speeds(cells: list[str]) -> str:
    return "time,n (rpm),T (C)\n" + "".join(
        f'2025-06-10 07:{k:02d}:00,"{cell}",20.{k:02d}\n' for k, cell in enumerate(cells)
    )


def test_a_column_of_thousands_beside_decimals_is_asked(tmp_path: Path) -> None:
    with pytest.raises(QuestionError) as asked:
        read(tmp_path, _speeds(["0"] * 10 + ["8,000"] * 6 + ["950"] * 4))
    assert "6 of 10 numbers other than 0 in column 'n (rpm)' look like thousands ('8,000')" in asked.value.ask
    assert "declare table: {decimal: '.'} where '8,000' is 8000" in str(asked.value.hint)
    data = read(tmp_path, _speeds(["0"] * 10 + ["8,000"] * 6 + ["950"] * 4), decimal=".")
    assert data.values["table", "n (rpm)"].tolist() == [0.0] * 10 + [8000.0] * 6 + [950.0] * 4


def test_one_odd_cell_is_a_loss_and_no_question(tmp_path: Path) -> None:
    data = read(tmp_path, _speeds(["0"] * 10 + ["8,000"] + ["950"] * 9))
    assert next(loss.reason for loss in data.losses).startswith("'8,000' may be thousands or a fraction")


def test_thousands_that_leave_no_choice_are_read(tmp_path: Path) -> None:
    data = read(tmp_path, _speeds(["0"] * 10 + ["8,000.0"] * 10))
    assert data.values["table", "n (rpm)"].max() == 8000.0


_NODES = "SourceTimestamp;NodeId;Value;StatusCode\n" + "".join(
    f"2025-06-10T07:{k:02d}:00Z;ns=2;s=M.nSp;{100 * k}.00;Good\n" for k in range(20)
)


def test_a_header_with_fewer_cells_than_its_rows_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError) as refused:
        read(tmp_path, _NODES)
    assert refused.value.what == "the header has fewer cells than the rows below it"
    assert str(refused.value.got).startswith("4 in the header, 5 in the rows: '2025-06-10")
    assert refused.value.where == "x.csv line 1, rows from line 2"
    assert "declare table: {header_rows: 1}" in str(refused.value.hint)


def test_decimal_commas_between_commas_are_named(tmp_path: Path) -> None:
    rows = "".join(f"2026-03-02 07:{k:02d}:00,{20 + k},9,0,4\n" for k in range(20))
    with pytest.raises(FormatError) as refused:
        read(tmp_path, "Time,T [°C],dZ [um]\n" + rows)
    assert str(refused.value.hint).startswith(
        "has 2 columns a decimal comma? then export with ';' between cells; else "
    )


def test_last_columns_without_a_name_are_read_where_the_header_is_declared(tmp_path: Path) -> None:
    assert "column 5" in [s.name for s in read(tmp_path, _NODES, header_rows=1).recording.signals]


@pytest.mark.parametrize("tail", ["", "coffee"])
def test_rows_that_end_with_a_delimiter_or_rarely_with_a_remark_keep_their_header(tmp_path: Path, tail: str) -> None:
    rows = "".join(f"2025-06-10 07:{k:02d}:00;{k}.5;3.5;{tail if k == 5 else ''}\n" for k in range(20))
    data = read(tmp_path, "time;T [degC];U\n" + rows)
    np.testing.assert_array_equal(data.values["table", "T [degC]"], np.arange(20) + 0.5)


@pytest.mark.parametrize("name", ["ts_ms", "time [ms]"])
def test_milliseconds_since_1970_are_dates_and_others_count_from_their_start(tmp_path: Path, name: str) -> None:
    text = f"{name};T\n" + "".join(f"{1749540600000 + 20000 * k};2.5\n" for k in range(5))
    data = read(tmp_path, text)
    assert data.recording.clock == "absolute"
    assert data.t_ns["table"][0] == utc("2025-06-10T07:30:00")
    assert "unix_ms" in " ".join(data.recording.notes)
    started = read(tmp_path, f"{name};T\n" + "".join(f"{20000 * k};2.5\n" for k in range(5)))
    assert started.recording.clock == "relative"
    assert started.t_ns["table"].tolist() == [20 * S * k for k in range(5)]
