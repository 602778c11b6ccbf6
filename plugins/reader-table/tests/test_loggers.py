"""Exports of data loggers: lists of channels above the table, units among other words, padded signs, long tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Source
from thermodata.testing.reader import load


def read(path: Path, source: Source = Source()) -> tuple[dict[str, str | None], dict[str, np.ndarray]]:  # noqa: B008
    """({signal: unit}, {signal: values})"""
    reader = Reader()
    units = {s.name: s.unit for s in reader.describe(path, source).signals}
    blocks = [b for b in reader.blocks(path, source) if isinstance(b, Block)]
    return units, {n: np.concatenate([b.values[n] for b in blocks]) for n in units}


def test_a_units_row_among_words_and_signs_before_padding(tmp_path: Path) -> None:
    path = tmp_path / "logger.csv"
    rows = [f"{i + 1},2026/03/27 06:00:{i:02d},+   {20 + i / 10:.1f},-    3.5,+  1.2500,LLLL" for i in range(30)]
    rows[4] = "5,2026/03/27 06:00:04,BURNOUT,-    3.5,+  1.2500,LLLL"
    path.write_text(
        "\n".join(
            [
                "Vendor,SOMEBODY",
                "Sampling interval,1s",
                "CH,Signal name,Input,Range",
                'CH1,"T front",TEMP,TC_K',
                "Data",
                "Number,Date&Time,CH1,CH2,CH3,AlarmOut",
                "NO.,Time,degC,degC,V,A1234",
                *rows,
                "",
            ]
        )
    )
    units, values = read(path)
    assert units == {"Number": None, "CH1": "degC", "CH2": "degC", "CH3": "V", "AlarmOut": None}
    expected = 20 + np.arange(30) / 10
    expected[4] = np.nan
    assert np.array_equal(values["CH1"].astype(float), expected, equal_nan=True)
    assert set(values["CH2"]) == {-3.5}


def test_a_list_of_channels_with_ranges_is_no_data(tmp_path: Path) -> None:
    path = tmp_path / "scan.csv"
    rows = [f"{i + 1},03/27/2026 06:00:{i:02d}:264,{20 + i / 10:.1f},0,21.5,0" for i in range(40)]
    path.write_text(
        "\n".join(
            [
                "Channel,Name,Function,Range,Resolution,Scale,Gain,Offset",
                "101,T_front,Temp (Type K),,C,No,1,0",
                "102,T_hall,Temp (RTD),,C,No,1,0",
                "103,probe,DC voltage,10 V,5.5 digits,No,1,0",
                "",
                "Scan,Time,101 <T_front> (C),Alarm 101,102 <T_hall> (C),Alarm 102",
                *rows,
                "",
            ]
        )
    )
    units, values = read(path)
    assert list(units) == ["Scan", "101 <T_front> (C)", "Alarm 101", "102 <T_hall> (C)", "Alarm 102"]
    assert values["101 <T_front> (C)"].astype(float).tolist() == [20 + i / 10 for i in range(40)]
    assert Reader().describe(path, Source()).start_ns == np.datetime64("2026-03-27T06:00:00.264", "ns").astype(int)


def test_a_table_with_a_row_a_value_is_left_to_its_reader() -> None:
    text = "id,_NAME,_NUMERICID,_VALUE,_TIMESTAMP,_QUALITY\n" + "".join(
        f"{i},Channel1.T,0,20.{i},2026-03-27 06:00:0{i}.123,192\n" for i in range(9)
    )
    assert Reader().sniff(Head("kepware.csv", len(text), text.encode())) is None


@pytest.mark.parametrize("by_name", [True, False])
def test_rows_that_name_what_they_measure_are_taken_apart_whatever_their_header_says(
    tmp_path: Path, by_name: bool
) -> None:
    pairs = [(f"06:00:{i:02d}", p) for i in range(30) for p in ("front", "rear")]
    pairs = sorted(pairs, key=lambda x: x[1]) if by_name else pairs
    rows = [f"2026-03-27 {t},{p},{t[-2:] if p == 'rear' else '20.5'}" for t, p in pairs]
    path = tmp_path / "long.csv"
    path.write_text("\n".join(["when,where,how much", *rows, ""]))
    data = load(Reader(), path, Source(timezone="UTC"))
    assert {k: v.tolist() for (_, k), v in data.values.items()} == {
        "front/how much": [20.5] * 30,
        "rear/how much": [float(i) for i in range(30)],
    }
    assert all(len(t) == 30 for t in data.t_ns.values())


def test_relative_times_that_begin_anew_with_each_name_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    path.write_text("\n".join(["t [s],where,how much", *(f"{i},{p},20.5" for p in "ab" for i in range(30)), ""]))
    with pytest.raises(FormatError, match="a long table") as said:
        read(path)
    assert "a, b" in str(said.value)


def test_a_state_beside_times_that_repeat_makes_no_long_table(tmp_path: Path) -> None:
    rows = [f"2026-03-27 06:{i // 6:02d},{'RUN' if i > 20 else 'STOP'},{20 + i / 10:.1f}" for i in range(60)]
    path = tmp_path / "minutes.csv"
    path.write_text("\n".join(["Time,Mode,T1", *rows, ""]))
    assert list(read(path)[0]) == ["Mode", "T1"]


def test_milliseconds_in_a_column_behind_the_time_are_part_of_it(tmp_path: Path) -> None:
    path = tmp_path / "fast.csv"
    rows = [f"{i + 1},2026/03/27 06:00:{i // 10:02d},{i % 10 * 100},+   {20 + i / 10:.1f}" for i in range(40)]
    path.write_text("\n".join(["Number,Date&Time,ms,CH1", "NO.,Time,ms,degC", *rows, ""]))
    units, _ = read(path)
    assert list(units) == ["Number", "CH1"]
    t_ns = np.concatenate([b.t_ns for b in Reader().blocks(path, Source()) if isinstance(b, Block)])
    assert t_ns[0] == np.datetime64("2026-03-27T06:00:00", "ns").astype(int)
    assert set(np.diff(t_ns)) == {100_000_000}


@pytest.mark.parametrize(("name", "cell"), [("us", "{0:6d}"), ("µs", "{0}"), ("sec", "{1:.3f}")])
def test_parts_of_a_second_in_a_column_behind_the_time_are_part_of_it(tmp_path: Path, name: str, cell: str) -> None:
    path = tmp_path / "fast.csv"
    part = [cell.format(i % 10 * 100_000, i % 10 / 10) for i in range(40)]
    rows = [f"2026/03/27,06:00:{i // 10:02d},{part[i]},{20 + i / 10:.1f}" for i in range(40)]
    path.write_text("\n".join([f"Date,Time,{name},CH1", *rows, ""]), encoding="utf-8")
    assert list(read(path)[0]) == ["CH1"]
    t_ns = np.concatenate([b.t_ns for b in Reader().blocks(path, Source()) if isinstance(b, Block)])
    assert set(np.diff(t_ns)) == {100_000_000}


def test_numbers_that_are_no_part_of_a_second_stay_a_signal(tmp_path: Path) -> None:
    path = tmp_path / "slow.csv"
    path.write_text("Date,Time,s,CH1\n" + "".join(f"2026/03/27,06:00:{i:02d},{i}.5,20.5\n" for i in range(40)))
    assert list(read(path)[0]) == ["s", "CH1"]


@pytest.mark.parametrize(
    ("header", "utc"),
    [
        ("Date Time, GMT+01:00", "10:30"),
        ("Date Time, GMT-04:00", "15:30"),
        ("time_utc", "11:30"),
        ("Time (UTC)", "11:30"),
        ("Time (UTC+2)", "09:30"),
        ("Time", "09:30"),
    ],
)
def test_the_zone_that_a_header_says_counts_all_year(tmp_path: Path, header: str, utc: str) -> None:
    """A logger that stays in winter time, in July, in a source with daylight saving."""
    path = tmp_path / "hall.csv"
    path.write_text(f'"#","{header}","T1"\n' + "".join(f"{i},2026-07-27 11:30:{i:02d},20.5\n" for i in range(40)))
    start = Reader().describe(path, Source(timezone="Europe/Prague")).start_ns
    assert start == np.datetime64(f"2026-07-27T{utc}", "ns").astype(int)
    assert not any("no time zone" in n for n in Reader().describe(path, Source()).notes) or header == "Time"


def test_quoted_numbers_with_a_decimal_comma_between_commas(tmp_path: Path) -> None:
    path = tmp_path / "sheet.csv"
    path.write_text("Time [s],T [°C]\n" + "".join(f'{i},"{20 + i},5"\n' for i in range(20)), encoding="utf-8")
    assert read(path)[1]["T [°C]"].tolist() == [20.5 + i for i in range(20)]
    path.write_text("Time [s],n [rpm]\n" + "".join(f'{i},"8,{i:03d}"\n' for i in range(20)), encoding="utf-8")
    with pytest.raises(FormatError, match="thousands or begin a fraction"):
        read(path)
    for decimal, factor in ((".", 1000.0), (",", 1.0)):
        n = read(path, Source(table={"decimal": decimal}))[1]["n [rpm]"]
        np.testing.assert_allclose(n, (8 + np.arange(20) / 1000) * factor)


def test_dates_in_chinese_and_korean(tmp_path: Path) -> None:
    for day in ("2026年03月27日", "2026년 3월 27일 "):
        path = tmp_path / "cn.csv"
        rows = "".join(f"{day},06:00:{i:02d},20.{i}\n" for i in range(9))
        path.write_text("日期,时间,主轴温度（℃）\n" + rows, encoding="utf-8")
        assert list(read(path)[0]) == ["主轴温度（℃）"]
        assert Reader().describe(path, Source()).start_ns == np.datetime64("2026-03-27T06:00:00", "ns").astype(int)


STAMPS = [f"2026-03-27 06:{i // 60:02d}:{i % 60:02d}" for i in range(90)]


def test_names_that_stand_above_units_and_kinds_of_reading(tmp_path: Path) -> None:
    """TOA5: what the logger is, names, units, and what was done with the readings."""
    path = tmp_path / "cr.dat"
    head = [
        '"TOA5","CR","CR1000X","12345","CR1000X.Std.05","CPU:t.CR1X","4711","Therm"',
        '"TIMESTAMP","RECORD","T_front_Avg","T_rear_Avg","gap"',
        '"TS","RN","Deg C","Deg C","mV"',
        '"","","Avg","Avg","Smp"',
    ]
    rows = [f'"{t}",{i},{20 + i / 10:.1f},21.5,{i}.25' for i, t in enumerate(STAMPS)]
    path.write_text("\n".join([*head, *rows, ""]))
    units, values = read(path)
    assert units == {"RECORD": None, "T_front_Avg": "Deg C", "T_rear_Avg": "Deg C", "gap": "mV"}
    notes = Reader().describe(path, Source()).notes
    assert any("line 4 between header and data is not read (1 such)" in note for note in notes)
    assert values["T_front_Avg"].tolist() == [float(f"{20 + i / 10:.1f}") for i in range(90)]


def test_a_row_that_is_called_units_above_minimum_and_maximum(tmp_path: Path) -> None:
    path = tmp_path / "gm.csv"
    head = [
        '"Device Type","GM"',
        '"Ch.","","","0001","","0002",""',
        '"Tag","","","spindle","","bed",""',
        '"Unit","","","°C","","K",""',
        '"Date","Time","n","MIN","MAX","MIN","MAX"',
    ]
    rows = [f'"{t[:10]}","{t[11:]}","0","{20 + i}","{21 + i}","{30 + i}","{31 + i}"' for i, t in enumerate(STAMPS)]
    path.write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    units, values = read(path)
    assert units == {"n": None, "spindle/MIN": "°C", "spindle/MAX": "°C", "bed/MIN": "K", "bed/MAX": "K"}
    assert values["bed/MIN"][:2].tolist() == [30.0, 31.0]
    assert not any("is not read" in note for note in Reader().describe(path, Source()).notes)


def test_names_of_times_below_a_row_of_units_leave_the_channels_their_names(tmp_path: Path) -> None:
    path = tmp_path / "event.csv"
    head = [
        '"Tag","","","spindle","bed"',
        '"Unit","","","°C","K"',
        '"Date","Time","sec","",""',
    ]
    rows = [f'"{t[:10]}","{t[11:]}","0.500","{20 + i}","{30 + i}"' for i, t in enumerate(STAMPS)]
    path.write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    assert read(path)[0] == {"spindle": "°C", "bed": "K"}
    assert not any("is not read" in note for note in Reader().describe(path, Source()).notes)


def test_rows_of_devices_and_rates_below_the_names_are_no_names(tmp_path: Path) -> None:
    path = tmp_path / "catman.asc"
    head = [
        "T0 = 27.03.2026 06:00:00",
        "",
        "Zeit  1 - Standard-Messrate [s]\tT vorn [°C]\tWeg Z [µm]",
        "MX840B_0_hw\tMX840B_1_hw\tMX840B_2_hw",
        "dt = 10\tdt = 10\tdt = 10",
    ]
    rows = [f"{10 * i},0000\t{20 + i},25\t{i},125" for i in range(90)]
    path.write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    units, values = read(path)
    assert units == {"T vorn [°C]": "°C", "Weg Z [µm]": "µm"}
    assert values["T vorn [°C]"][:2].tolist() == [20.25, 21.25]


def test_lines_of_dashes_and_of_plus_signs_are_no_values(tmp_path: Path) -> None:
    path = tmp_path / "marks.csv"
    cells = ["-----", "+++++++", "-------", "20.5"]
    path.write_text("Time [s],T1\n" + "".join(f"{i},{cells[i % 4]}\n" for i in range(40)))
    found = list(Reader().blocks(path, Source()))
    assert all(isinstance(b, Block) for b in found)
    assert np.array_equal(read(path)[1]["T1"][:4], [np.nan, np.nan, np.nan, 20.5], equal_nan=True)


def test_a_recorders_elapsed_time_of_three_digits_below_comments_and_units(tmp_path: Path) -> None:
    path = tmp_path / "nr.csv"
    head = ["NR-X", "#BeginData", "Elapsed time,CH1,CH2", "Comment,front,gap", "Unit,degC,mV"]
    rows = [f"{i // 120:03d}:{i // 2 % 60:02d}:{i % 2 * 30:02d}.000,{20 + i / 100:.2f},{i}" for i in range(3600)]
    path.write_text("\n".join([*head, *rows, ""]))
    assert "table" in (Reader().sniff(Head("nr.csv", path.stat().st_size, path.read_bytes()[:65536])) or "")
    units, values = read(path)
    assert units == {"front": "degC", "gap": "mV"}
    assert len(values["gap"]) == 3600
    t_ns = np.concatenate([b.t_ns for b in Reader().blocks(path, Source()) if isinstance(b, Block)])
    assert set(np.diff(t_ns)) == {30 * 10**9}


def test_cells_with_units_in_them_are_refused_with_what_to_do(tmp_path: Path) -> None:
    path = tmp_path / "panel.csv"
    rows = "".join(f'"2026-03-27 06:00:{i:02d}","{20 + i} °C","{i} µm"\n' for i in range(40))
    path.write_text('"Time","T1","dZ"\n' + rows, encoding="utf-8")
    with pytest.raises(FormatError, match="hold their units") as said:
        read(path)
    assert "without their units" in str(said.value)


def test_dates_behind_an_apostrophe_are_dates(tmp_path: Path) -> None:
    path = tmp_path / "lr.csv"
    rows = "".join(f'"\'2026-03-27","06:00:{i:02d}.500",{20 + i / 10:.2E}\n' for i in range(40))
    path.write_text('"Date","Time","CH1-1[C]"\n' + rows)
    recording = Reader().describe(path, Source())
    assert recording.start_ns == np.datetime64("2026-03-27T06:00:00.500", "ns").astype(int)
    assert list(read(path)[0]) == ["CH1-1[C]"]
