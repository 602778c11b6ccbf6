"""TNCscope recordings and OPC UA logs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.opcua import long_table

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Scaling, Source
from thermodata.reader.finding.registry import head
from thermodata.schema.flag import Flag
from thermodata.testing.reader import load, reader_checks

from .logs import written

GLOBAL = "%[GLOBAL]\r\n%VERSION=1\r\n%DATE=02.03.2026\r\n%TIME=09:00:00\r\n%\r\n"


def curve(name: str, axis: str, count: int, cycle: int, unit: str = "mm", more: str = "") -> str:
    return (
        f"%[CURVE]\r\n%CHANNELTYPE={name}\r\n%AXISTYPE={axis}\r\n%DIMENSION={unit}\r\n%COUNT={count}\r\n"
        f"%CYCLETIME={cycle}\r\n{more}%\r\n"
    )


def scope(rows: int = 20, start: str = GLOBAL) -> str:
    data = "".join(f"{k / 8:.3f};{k};{k * 2 if k < rows // 2 else ''}\r\n" for k in range(rows))
    return (
        start
        + curve("s actual", "X", rows, 3000)
        + curve("v actual", "X", rows, 3000, "mm/min", "%FACTOR=0.5\r\n")
        + curve("T", "S", rows // 2, 6000, "°C")
        + "%[DATA]\r\n"
        + data
    )


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_curves_of_one_cycle_time_are_a_stream(tmp_path: Path, encoding: str) -> None:
    path = written(tmp_path, scope(), "a.sco", encoding)
    assert "TNCscope" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert not data.losses
    assert data.recording.start_ns == np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
    assert [(s.name, s.stream, s.unit) for s in data.recording.signals] == [
        ("s actual X", "scope_3000us", "mm"),
        ("v actual X", "scope_3000us", "mm/min"),
        ("T S", "scope_6000us", "°C"),
    ]
    assert data.recording.signals[1].scaling == Scaling("linear", {"gain": 0.5, "offset": 0.0})
    assert np.diff(data.t_ns["scope_3000us"]).tolist() == [3_000_000] * 19
    assert np.diff(data.t_ns["scope_6000us"]).tolist() == [6_000_000] * 9
    assert data.values["scope_3000us", "s actual X"].tolist() == [k / 8 for k in range(20)]
    assert data.values["scope_6000us", "T S"].tolist() == [k * 2.0 for k in range(10)]


def test_fewer_values_than_announced_are_a_loss(tmp_path: Path) -> None:
    text = scope(start="%[GLOBAL]\r\n%VERSION=1\r\n%\r\n")
    data = load(Reader(), written(tmp_path, text[: text.rindex("\r\n", 0, -40) + 2], "a.sco"), Source())
    assert data.recording.clock == "relative"
    assert any("announces 20 values" in loss.reason for loss in data.losses)


def counted(rows: list[int], end: str = ";", mark: str = ".") -> str:
    """As TNCscope writes it: the time of the row [us] first, every cell with its ';' behind it."""
    data = "".join(f"{k * 3000};{k / 8:.3f};{k}{end}\r\n" for k in rows).replace(".", mark)
    return (
        GLOBAL + curve("s actual", "X", 20, 3000) + curve("DSP-Debug", "X", 20, 3000, "id(10)") + "%[DATA]\r\n" + data
    )


@pytest.mark.parametrize(("end", "mark"), [(";", "."), ("", "."), (";", ",")])
def test_the_first_column_counts_the_rows(tmp_path: Path, end: str, mark: str) -> None:
    data = load(Reader(), written(tmp_path, counted(list(range(20)), end, mark), "a.sco"), Source())
    assert not data.losses
    assert [s.unit for s in data.recording.signals] == ["mm", "id(10)"]
    assert data.values["scope_3000us", "s actual X"].tolist() == [k / 8 for k in range(20)]
    holed = [k for k in range(20) if k != 7]
    data = load(Reader(), written(tmp_path, counted(holed, end, mark), "a.sco"), Source())
    assert ((data.t_ns["scope_3000us"] - data.recording.start_ns) // 3_000_000).tolist() == holed
    assert ["rows are missing" in loss.reason for loss in data.losses] == [True, False, False]


def test_values_behind_a_curves_count_are_padding_or_a_loss(tmp_path: Path) -> None:
    text = scope().replace(";\r\n", ";0\r\n")
    data = load(Reader(), written(tmp_path, text, "a.sco"), Source())
    assert data.values["scope_6000us", "T S"].tolist() == [k * 2.0 for k in range(10)]
    assert not data.losses
    data = load(Reader(), written(tmp_path, text.replace("1.500;12;0", "1.500;12;77"), "a.sco"), Source())
    assert "behind the announced 10" in data.losses[0].reason
    with pytest.raises(FormatError, match="impossible count"):
        load(Reader(), written(tmp_path, text.replace("COUNT=10", "COUNT=1e300"), "a.sco"), Source())


def test_columns_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    text = GLOBAL + curve("s", "X", 2, 3000) + "%[DATA]\r\n1;2;3;4\r\n1;2;3;4\r\n"
    with pytest.raises(FormatError, match="columns do not fit"):
        load(Reader(), written(tmp_path, text, "a.sco"), Source())


OPC = "DateTime,TagName,TagVal,TagQuality\n"


def test_opc_values_are_held_and_bad_ones_are_flagged(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        OPC
        + "".join(
            (
                "2026-03-02 08:00:00,T1,20.5,192\n",
                "2026-03-02 08:00:00,speed,1000,192\n",
                "2026-03-02 08:00:05,T1,21,192\n",
                "2026-03-02 08:00:06,T1,0,0x80000000\n",
                "2026-03-02 08:00:07,mode,AUTO,Good\n",
                "garbage\n",
            )
        ),
        "opc.csv",
    )
    assert "OPC UA" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert data.recording.start_ns == np.datetime64("2026-03-02T07:00:00", "ns").astype(np.int64)
    assert data.values["nc", "T1"].tolist() == [20.5, 21, 0, 0]
    assert data.flags["nc", "T1"].tolist() == [0, 0, Flag.NOT_MEASURING, Flag.NOT_MEASURING]
    assert data.values["nc", "speed"].tolist() == [1000] * 4
    assert data.values["nc", "mode"].tolist() == [None, None, None, "AUTO"]
    assert [loss.where for loss in data.losses] == ["opc.csv line 7"]


def test_a_table_sorted_by_tag_is_a_stream_a_tag(tmp_path: Path) -> None:
    lines = [
        f"2026-03-02T08:{k // 60:02d}:{k % 60:02d}.000Z;{tag};{k + 0.5};Good"
        for tag in ("T1", "T2")
        for k in range(100)
    ]
    path = written(tmp_path, "SourceTimestamp;NodeId;Value;StatusCode\n" + "\n".join(lines) + "\n", "opc.csv")
    data = load(Reader(), path, Source())
    assert set(data.t_ns) == {"T1", "T2"}
    assert data.values["T2", "T2"].tolist() == [k + 0.5 for k in range(100)]
    assert (np.diff(data.t_ns["T1"]) > 0).all()


@pytest.mark.parametrize(
    ("text", "t1", "flagged"),
    [
        (
            "nodeId,value,dataType,status,statusName,sourceTimestamp,serverTimestamp\n"
            "T1,12.34,Float,0,Good,2026-03-02T08:00:00Z,2026-03-02T08:00:00Z\n"
            "T1,13.5,Float,2147483648,Bad,2026-03-02T08:00:01Z,2026-03-02T08:00:01Z\n",
            [12.34, 13.5],
            [0, 128],
        ),
        (
            "ReceivedAt,SourceTimestamp,ServerTimestamp,Name,NodeId,Value,Status\n"
            '2026-03-02T08:00:00.1000000+00:00,,,"x","T1","1",Good\n'
            '2026-03-02T08:00:01.1000000+00:00,2026-03-02T08:00:01.0000000+00:00,,"x","T1","2,5",Good\n',
            [1, 2.5],
            [64, 0],
        ),
        (
            '"VarName";"TimeString";"VarValue";"Validity";"Time_ms"\n"T1";"13.03.26 11:02:52";66,00;1;46094460322,81\n'
            '"T1";"13.03.26 11:02:53";0,00;0;46094460334,38\n',
            [66, 0],
            [0, 128],
        ),
        (
            "DateTime;TagName;TagVal;TagQuality\n2026-03-02 08:00:00;T1;1,5;192\n2026-03-02 08:00:01;T1;0;0\n",
            [1.5, 0],
            [0, 128],
        ),
        (
            "TagName,DateTime,Value,QualityDetail\nT1,2026-03-02 08:00:00,1,192\nT1,2026-03-02 08:00:01,0,24\n",
            [1, 0],
            [0, 128],
        ),
        (
            "TagName,DateTime,Value,Quality,OPCQuality\nT1,2026-03-02 08:00:00,1,0,192\nT1,2026-03-02 08:00:01,0,1,0\n",
            [1, 0],
            [0, 128],
        ),
        (
            "TagName,DateTime,Value,quality_code\nT1,2026-03-02 08:00:00,1,0\nT1,2026-03-02 08:00:01,0,2147483648\n",
            [1, 0],
            [0, 128],
        ),
        (
            "SourceTime,NodeId,Value,StatusCode\n2026-03-02T08:00:00Z,T1,1,0x00000000\n2026-03-02T08:00:01Z,T1,2,0\n",
            [1, 2],
            [0, 0],
        ),
    ],
)
def test_the_layouts_of_loggers(tmp_path: Path, text: str, t1: list[float], flagged: list[int]) -> None:
    path = written(tmp_path, text, "opc.csv")
    assert "OPC UA" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source(timezone="UTC"))
    assert data.values["nc", "T1"].tolist() == t1
    assert data.flags.get(("nc", "T1"), np.zeros(2)).tolist() == flagged
    assert not data.losses


def test_a_quality_of_0_alone_is_asked(tmp_path: Path) -> None:
    rows = "".join(f"2026-03-02 08:00:{k:02d},T1,{k},0\n" for k in range(30))
    path = written(tmp_path, OPC + rows, "opc.csv")
    assert "OPC UA" in (Reader().sniff(head(path)) or "")
    with pytest.raises(QuestionError, match="may mean good or bad"):
        load(Reader(), path, Source(timezone="UTC"))
    good, bad = (load(Reader(), path, Source(timezone="UTC", table={"quality_zero": x})) for x in ("good", "bad"))
    assert not good.flags["nc", "T1"].any()
    assert bad.flags["nc", "T1"].tolist() == [Flag.NOT_MEASURING] * 30


def test_a_quoted_value_may_hold_line_ends_and_one_node_needs_no_tag(tmp_path: Path) -> None:
    text = (
        '#,Source Timestamp,Server Timestamp,Value,Status\n1,2026-03-02 08:00:00.5Z,,"12,""a""\nb","Good,Clamped"\n'
        "2,2026-03-02 08:00:01.5Z,,c,Good\n"
    )
    data = load(Reader(), written(tmp_path, text, "opc.csv"), Source())
    assert data.values["nc", "Value"].tolist() == ['12,""a""\nb'.replace('""', '"'), "c"]
    assert not data.losses


def test_a_quoted_value_may_go_over_two_parts_of_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(long_table, "_PART", 64)
    rows = "".join(
        f'2026-03-02 08:00:{k:02d},T,{k},192\n2026-03-02 08:00:{k:02d},note,"first of {k}\nsecond",192\n'
        for k in range(40)
    )
    path = written(tmp_path, OPC + rows, "opc.csv")
    data = load(Reader(), path, Source())
    assert not data.losses
    assert data.values["nc", "note"].tolist() == [f"first of {k}\nsecond" for k in range(40)]
    assert Reader().locate(path, Source(), "nc", 30) == "lines 92 to 94"


def test_tags_of_a_table_that_step_back_a_little_are_put_in_order(tmp_path: Path) -> None:
    rows = "".join(
        f"2026-03-02T08:00:{k:02d}.{5 if k % 2 else 9}Z,T{k % 2},{k},Good\n"
        + (f"2026-03-02T08:00:{k:02d}.1Z,T2,{k},Good\n")
        for k in range(30)
    )
    data = load(Reader(), written(tmp_path, OPC.replace("DateTime", "SourceTimestamp") + rows, "opc.csv"), Source())
    assert (np.diff(data.t_ns["nc"]) > 0).all()
    assert data.values["nc", "T2"].tolist()[::2] == list(range(30))


def test_a_thousand_tags_and_more_are_streams(tmp_path: Path) -> None:
    rows = "".join(f"2026-03-02 08:00:{k // 3000:02d},T{k % 3000},{k},192\n" for k in range(9000))
    data = load(Reader(), written(tmp_path, OPC + rows, "opc.csv"), Source())
    assert len(data.t_ns) == 3000
    assert data.values["T17", "T17"].tolist() == [17, 3017, 6017]


@pytest.fixture(scope="module")
def kit_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("kit")
    log = OPC + "".join(f"2026-03-02 08:00:{k:02d},T{k % 3},{20 + k / 4},192\n" for k in range(16))
    return {"sco": written(folder, scope(), "a.sco"), "opc": written(folder, log, "opc.csv")}


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
@pytest.mark.parametrize("kind", ["sco", "opc"])
def test_they_keep_the_rules_of_readers(kit_files: dict[str, Path], kind: str, number: int) -> None:
    reader_checks(Reader, [(kit_files[kind], Source())])[number]()
