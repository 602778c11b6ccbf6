"""Tables whose rows are of several sensors or hosts: each is a stream, and nothing of them is mixed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import load
from thermodata.testing.reader.case import Data

from .test_sheets import sheet, workbook

N = 60
UTC = Source(timezone="UTC")


def stamp(t: float) -> str:
    return f"2026-03-02 08:{int(t) // 60:02d}:{t % 60:06.3f}"


def read(path: Path, header: str, rows: list[str], source: Source = UTC) -> Data:
    path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    return load(Reader(), path, source)


def values(data: Data) -> dict[str, list[float]]:
    return {name: array.tolist() for (_, name), array in data.values.items()}


@pytest.mark.parametrize("apart_s", [0.0, 0.3])
@pytest.mark.parametrize("header", ["time,host,temperature,humidity", "Time,Kostka,Temp [degC],rH [%]"])
def test_each_host_has_its_own_channels(tmp_path: Path, header: str, apart_s: float) -> None:
    rows = [f"{stamp(10 * k + d * apart_s)},h{d},{20 + 10 * d + k / 8},{40 + d}" for k in range(N) for d in (0, 1)]
    data = read(tmp_path / "a.csv", header, rows)
    _, _, temperature, humidity = header.split(",")
    assert values(data) == {
        f"h{d}/{name}": made
        for d in (0, 1)
        for name, made in ((temperature, [20 + 10 * d + k / 8 for k in range(N)]), (humidity, [40.0 + d] * N))
    }
    for d in (0, 1):
        assert np.diff(data.t_ns[f"h{d}"]).tolist() == [10 * 10**9] * (N - 1)
    assert not data.losses
    assert any("2 series" in note and "h0, h1" in note for note in data.recording.notes)
    assert {s.unit for s in data.recording.signals} == ({"degC", "%"} if "[" in header else {None})


def test_what_a_host_never_logs_is_no_channel_of_it(tmp_path: Path) -> None:
    rows = []
    for k in range(10 * N):
        rows.append(f"thermal,{stamp(k)},daq1,{k / 8},{20 + k / 100}")
        if k % 15 == 0:
            rows.append(f"thermal,{stamp(k + 0.7)},daq2,,{10 + k / 100}")
    data = read(tmp_path / "a.csv", "name,time,host,eddy_V,T_column", rows)
    found = values(data)
    assert set(found) == {"daq1/name", "daq1/eddy_V", "daq1/T_column", "daq2/name", "daq2/T_column"}
    assert found["daq2/T_column"] == [10 + k / 100 for k in range(0, 10 * N, 15)]
    assert found["daq1/T_column"] == [20 + k / 100 for k in range(10 * N)]


def test_ids_that_are_numbers_name_their_channels_with_their_header(tmp_path: Path) -> None:
    rows = [f"{stamp(10 * k)},{d},{20 + 10 * d + k / 8}" for k in range(N) for d in (1, 2)]
    found = values(read(tmp_path / "a.csv", "time,Sensor-ID,T", rows))
    assert found == {f"Sensor-ID {d}/T": [20 + 10 * d + k / 8 for k in range(N)] for d in (1, 2)}


def test_a_sensor_that_comes_later_than_the_first_look_is_a_loss(tmp_path: Path) -> None:
    rows = [f"{stamp(k / 10)},h{k % 2},{k}" + " " * 40 for k in range(30_000)]
    rows[10_001] = f"{stamp(1000.1)},h7,{10_001}" + " " * 40
    data = read(tmp_path / "a.csv", "time,host,T", rows)
    assert [loss.reason for loss in data.losses] == ["1 row of 'h7', which the first look at the file did not meet"]
    assert sum(map(len, values(data).values())) == 29_999


def test_a_row_of_a_series_is_found_in_its_file(tmp_path: Path) -> None:
    rows = [f"{stamp(10 * k + d)},h{d},{20 + 10 * d}" for k in range(N) for d in (0, 1)]
    read(tmp_path / "a.csv", "time,host,T", rows)
    assert Reader().locate(tmp_path / "a.csv", UTC, "h1", 3) == "line 9"


@pytest.mark.parametrize(
    ("header", "cells"),
    [
        ("time,operator,T", ["Novak"] * 30 + ["Horak"] * 30),
        ("time,phase,T", (["roughing"] * 5 + ["finishing"] * 7) * 5),
        ("time,tool,T", (["T1"] * 9 + ["T4"] * 3) * 5),
        ("time,coolant,T", ["ON", "OFF"] * 30),
        ("time,alarm,T", ["", "700012 door open", "", "", ""] * 12),
        ("time,Step,T", [str(k // 6) for k in range(60)]),
        ("time,nSoll,T", ["0", "3000"] * 30),
    ],
)
def test_what_the_machine_did_is_no_sensor(tmp_path: Path, header: str, cells: list[str]) -> None:
    rows = [f"{stamp(10 * k)},{cell},{20 + k / 8}" for k, cell in enumerate(cells)]
    data = read(tmp_path / "a.csv", header, rows)
    assert list(values(data)) == header.split(",")[1:]
    assert not data.losses


@pytest.mark.parametrize("apart_ms", [0, 300])
@pytest.mark.parametrize("ids", [("bearing", "column"), (1, 2)])
def test_sensors_below_each_other_in_parquet_have_their_own_channels(
    tmp_path: Path, ids: tuple[object, ...], apart_ms: int
) -> None:
    t = np.datetime64("2026-03-02T07:00", "ms") + np.add.outer(np.arange(N) * 10_000, [0, apart_ms]).ravel()
    table = pa.table({"ts": t, "sensor": list(ids) * N, "temperature": np.tile([20.0, 17.0], N), "rh": [45.0] * 2 * N})
    pq.write_table(table, tmp_path / "a.parquet")
    data = load(Reader(), tmp_path / "a.parquet", Source())
    called = [f"sensor {one}" if isinstance(one, int) else str(one) for one in ids]
    assert values(data) == {
        f"{one}/{name}": [value] * N
        for one, own in zip(called, (20.0, 17.0), strict=True)
        for name, value in (("temperature", own), ("rh", 45.0))
    }
    assert not data.losses
    place = Reader().locate(tmp_path / "a.parquet", Source(), called[1], 2)
    assert place == "row group 1, row 6 of it (row 6 of the file)"


@pytest.mark.parametrize("rows_of_a_group", [None, 700])
def test_a_table_of_parquet_that_was_melted_is_taken_apart(tmp_path: Path, rows_of_a_group: int | None) -> None:
    many, names = 5000, ["T_bearing", "T_hall", "speed"]
    t = np.datetime64("2026-03-02T07:00", "ms") + np.tile(np.arange(many) * 10_000, 3)
    table = pa.table({"time": t, "name": np.repeat(names, many), "value": np.arange(3.0 * many)})
    pq.write_table(table, tmp_path / "a.parquet", row_group_size=rows_of_a_group)
    data = load(Reader(), tmp_path / "a.parquet", Source())
    assert {name: (own[0], len(own)) for name, own in values(data).items()} == {
        f"{name}/value": (float(k * many), many) for k, name in enumerate(names)
    }
    assert not data.losses


def test_a_long_table_of_parquet_without_dates_is_refused(tmp_path: Path) -> None:
    table = {"t [s]": np.tile(np.arange(90.0), 2), "name": np.repeat(["a", "b"], 90), "value": np.arange(180.0)}
    pq.write_table(pa.table(table), tmp_path / "a.parquet")
    with pytest.raises(FormatError, match="a long table: each row names what it measures") as said:
        Reader().describe(tmp_path / "a.parquet", Source())
    assert "'name' holds a, b" in str(said.value)
    assert "pivot" in str(said.value)
    assert "cnc" not in str(said.value), "which reads no Parquet"
    assert [s.name for s in Reader().describe(tmp_path / "a.parquet", declared("none")).signals] == ["name", "value"]


def test_a_tool_that_is_changed_is_no_long_table_of_parquet(tmp_path: Path) -> None:
    t = np.datetime64("2026-03-02T07:00", "ms") + np.arange(N) * 10_000
    pq.write_table(
        pa.table({"ts": t, "tool": (["T1"] * 9 + ["T4"] * 3) * 5, "T": np.arange(60.0)}), tmp_path / "a.parquet"
    )
    assert [s.name for s in Reader().describe(tmp_path / "a.parquet", Source()).signals] == ["tool", "T"]


@pytest.mark.parametrize("sheets", [1, 2])
@pytest.mark.parametrize("apart_s", [0, 3])
def test_sensors_below_each_other_in_a_sheet_are_streams(tmp_path: Path, sheets: int, apart_s: int) -> None:
    rows: list[list[object]] = [["Time", "sensor", "T [degC]"]]
    rows += [
        [46083 + (k // 2 * 10 + k % 2 * apart_s) / 86400, f"p{k % 2}", 20 + 10 * (k % 2) + k / 8] for k in range(2 * N)
    ]
    workbook(tmp_path / "a.xlsx", {f"S{n}": sheet(rows, (1, 0, 0)) for n in range(sheets)})
    data = load(Reader(), tmp_path / "a.xlsx", UTC)
    before = ["S0/", "S1/"] if sheets > 1 else [""]
    assert values(data) == {
        f"{b}p{d}/T [degC]": [20 + 10 * d + k / 8 for k in range(d, 2 * N, 2)] for b in before for d in (0, 1)
    }
    assert {s.unit for s in data.recording.signals} == {"degC"}
    assert not data.losses
    stream = next(s.stream for s in data.recording.signals if s.name.endswith("p1/T [degC]"))
    assert Reader().locate(tmp_path / "a.xlsx", UTC, stream, 3) == "sheet 'S0', row 9"


def declared(series: object) -> Source:
    return Source(timezone="UTC", table={"series": series})


def test_a_wide_log_with_a_seldom_word_is_read_as_it_stands_with_a_note(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},{20 + k / 8},{'TOOLCHG.SPF' if k % 20 == 19 else 'MAIN.MPF'}" for k in range(10 * N)]
    data = read(tmp_path / "a.csv", "time,dZ,Line", rows)
    assert list(values(data)) == ["dZ", "Line"]
    note = next(note for note in data.recording.notes if "'Line'" in note)
    assert "MAIN.MPF" in note
    assert "table: {series: [Line]}" in note
    assert "table: {series: none}" in note
    assert not read(tmp_path / "b.csv", "time,dZ,Line", rows, declared("none")).recording.notes
    assert list(values(read(tmp_path / "c.csv", "time,dZ,Line", rows, declared(["Line"])))) == [
        "MAIN.MPF/dZ",
        "TOOLCHG.SPF/dZ",
    ]


def test_series_are_declined_where_it_is_declared(tmp_path: Path) -> None:
    rows = [f"{stamp(10 * k)},h{d},{20 + d}" for k in range(N) for d in (0, 1)]
    assert any("table: {series: none}" in n for n in read(tmp_path / "a.csv", "time,host,T", rows).recording.notes)
    assert list(values(read(tmp_path / "b.csv", "time,host,T", rows, declared("none")))) == ["host", "T"]
    value = read(tmp_path / "c.csv", "time,signal,value", rows, declared("none"))
    assert list(values(value)) == ["signal", "value"]


def test_a_declared_column_that_is_not_there_is_named(tmp_path: Path) -> None:
    rows = [f"{stamp(10 * k)},h{d},{20 + d}" for k in range(N) for d in (0, 1)]
    with pytest.raises(FormatError, match="nothing is called 'Host'"):
        read(tmp_path / "a.csv", "time,host,T", rows, declared(["Host"]))
    with pytest.raises(FormatError, match="neither a list of columns nor none"):
        read(tmp_path / "a.csv", "time,host,T", rows, declared("host"))


@pytest.mark.parametrize("n", [3_000, 16_000])
def test_hosts_that_are_asked_in_turn_are_parted_in_a_file_of_any_size(tmp_path: Path, n: int) -> None:
    rows = [f"{stamp(k / 5)},plc{k % 16},{20 + 3 * (k % 16) + k / 1e4:.4f}" + " " * 60 for k in range(n)]
    data = read(tmp_path / "a.csv", "time,station,T", rows)
    assert ((tmp_path / "a.csv").stat().st_size > 512 * 1024) == (n > 5_000)
    assert set(values(data)) == {f"plc{k}/T" for k in range(16)}
    assert not data.losses


@pytest.mark.parametrize("cell", [lambda k: "SUB" if k % 50 == 49 else "MAIN", lambda k: int(k % 50 < 3)])
def test_a_wide_log_in_parquet_is_read_as_it_stands(tmp_path: Path, cell: Callable[[int], object]) -> None:
    t = np.datetime64("2026-03-02T07:00", "s") + np.arange(10 * N)
    for header in ("Line", "Probe"):
        wide = pa.table({"ts": t, header: [cell(k) for k in range(10 * N)], "T": np.arange(10.0 * N)})
        pq.write_table(wide, tmp_path / "a.parquet")
        assert [s.name for s in Reader().describe(tmp_path / "a.parquet", Source()).signals] == [header, "T"]


def test_parquet_takes_what_is_declared_of_series(tmp_path: Path) -> None:
    t = np.datetime64("2026-03-02T07:00", "ms") + np.repeat(np.arange(N) * 10_000, 2)
    pq.write_table(pa.table({"ts": t, "sensor": ["a", "b"] * N, "T": [20.0, 17.0] * N}), tmp_path / "a.parquet")
    assert any("table: {series: none}" in n for n in Reader().describe(tmp_path / "a.parquet", Source()).notes)
    assert [s.name for s in Reader().describe(tmp_path / "a.parquet", declared("none")).signals] == ["sensor", "T"]
    apart = Reader().describe(tmp_path / "a.parquet", declared(["sensor"]))
    assert [s.name for s in apart.signals] == ["a/T", "b/T"]


@pytest.mark.parametrize("sheets", [1, 2])
def test_sheets_take_what_is_declared_of_series(tmp_path: Path, sheets: int) -> None:
    rows: list[list[object]] = [["Time", "sensor", "T"]]
    rows += [[46083 + (k // 2 * 10) / 86400, f"p{k % 2}", 20 + 10 * (k % 2) + k / 8] for k in range(2 * N)]
    workbook(tmp_path / "a.xlsx", {f"S{n}": sheet(rows, (1, 0, 0)) for n in range(sheets)})
    before = ["S0/", "S1/"] if sheets > 1 else [""]
    plain = load(Reader(), tmp_path / "a.xlsx", declared("none"))
    assert set(values(plain)) == {f"{b}{name}" for b in before for name in ("sensor", "T")}
    parted = load(Reader(), tmp_path / "a.xlsx", declared(["sensor"]))
    assert set(values(parted)) == {f"{b}p{d}/T" for b in before for d in (0, 1)}
    with pytest.raises(FormatError, match="nothing is called 'host'"):
        load(Reader(), tmp_path / "a.xlsx", declared(["host"]))


@pytest.mark.parametrize(("header", "parted"), [("TagIndex", True), ("Channels", False)])
def test_the_number_of_a_tag_parts_the_rows_of_a_data_log(tmp_path: Path, header: str, parted: bool) -> None:
    rows = [
        f'"03/18/2026","08:{10 * k // 60:02d}:{10 * k % 60:02d}",{250 + d},{d},{20 + 10 * d + k / 8:.3f}," ","B",0'
        for k in range(N)
        for d in (0, 1, 2)
    ]
    data = read(tmp_path / "a.csv", f'"Date","Time","Millitm","{header}","Value","Status","Marker","Internal"', rows)
    found = values(data)
    assert (f"{header} 1/Value" in found) is parted
    assert not any("Millitm" in name for name in found)
    if parted:
        assert found["TagIndex 1/Value"] == [30 + k / 8 for k in range(N)]
        first = np.datetime64("2026-03-18T08:00:00.251", "ns").astype(np.int64)
        assert data.t_ns["TagIndex 1"].tolist() == [first + 10 * 10**9 * k for k in range(N)]
