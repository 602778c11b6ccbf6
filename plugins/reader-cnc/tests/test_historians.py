"""Exports of historians and of InfluxDB: a row a value, taken apart by what it is of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.opcua import long_table, sections

from thermodata.plugin import Source
from thermodata.testing.reader import load

from .logs import values, written

INFLUX = ",result,table,_start,_stop,_time,_value,_field,_measurement,machine\n"


NOTES = "#group,false,false,true,true,false,false,true,true,true\n#default,_result,,,,,,,,\n"


def of_influx(table: int, field: str, machine: str = "m1") -> str:
    span = "2026-03-02T00:00:00Z,2026-03-03T00:00:00Z"
    rows = range(20)
    return "".join(f",,{table},{span},2026-03-02T08:00:{k:02d}Z,{k + table / 4},{field},temp,{machine}\n" for k in rows)


def test_an_export_of_influxdb_is_taken_apart_over_its_tables(tmp_path: Path) -> None:
    text = NOTES + INFLUX + of_influx(0, "T1") + of_influx(1, "T2") + "\n" + NOTES + INFLUX + of_influx(2, "T3")
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert values(data) == {f"T{1 + k}": [i + k / 4 for i in range(20)] for k in range(3)}
    assert data.recording.start_ns == np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
    assert not data.losses


def test_tags_of_influxdb_that_differ_are_part_of_the_name(tmp_path: Path) -> None:
    text = INFLUX + of_influx(0, "T1", "m1") + of_influx(1, "T1", "m2")
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert sorted(n for _, n in data.values) == ["m1", "m2"]


def test_columns_that_are_named_anew_end_a_long_table(tmp_path: Path) -> None:
    rows = "".join(f"2026-03-02 08:00:{k:02d},T1,{k}.5\n" for k in range(40))
    other = "Time,Value,Tag\n" + "".join(f"2026-03-02 08:01:{k:02d},{k}.5,T2\n" for k in range(40))
    data = load(Reader(), written(tmp_path, "Time,Tag,Value\n" + rows + other, "pi.csv"), Source(timezone="UTC"))
    assert sorted(n for _, n in data.values) == ["T1"]
    assert [loss.where for loss in data.losses] == ["pi.csv line 42"]
    assert "other columns" in data.losses[0].reason


SPINDLE = ",result,table,_start,_stop,_time,_value,_field,_measurement\n"


def of_spindle(table: int, field: str, first: int = 0, n: int = 20) -> str:
    span = "2026-03-02T00:00:00Z,2026-03-03T00:00:00Z"
    times = (f"2026-03-02T08:{k // 60:02d}:{k % 60:02d}Z" for k in range(first, first + n))
    return "".join(f",,{table},{span},{t},{1000 + k},{field},drive\n" for k, t in enumerate(times, first))


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("part", [1 << 20, 700])
def test_tables_of_influxdb_with_other_columns_are_all_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, end: str, part: int
) -> None:
    monkeypatch.setattr(long_table, "_PART", part)
    monkeypatch.setattr(sections, "_PART", part)
    temperatures = of_influx(0, "T", "m1") + of_influx(1, "T", "m2")
    text = NOTES + INFLUX + temperatures + "\n" + NOTES + SPINDLE + of_spindle(2, "speed")
    text += "\n" + NOTES + INFLUX + of_influx(3, "T", "m3")
    path = written(tmp_path, text.replace("\n", end), "influx.csv")
    data = load(Reader(), path, Source())
    assert not data.losses
    assert values(data) == {
        **{f"m{1 + k}": [i + table / 4 for i in range(20)] for k, table in enumerate((0, 1, 3))},
        "speed": [1000.0 + k for k in range(20)],
    }
    line = text.split("\n").index(of_spindle(2, "speed").split("\n")[5]) + 1
    assert Reader().locate(path, Source(), "speed", 5) == f"line {line}"


def test_a_long_second_table_is_known_though_the_first_look_ends_before_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(long_table, "_LOOK", 2000)
    second = of_spindle(2, "speed", n=3000) + of_spindle(3, "load", n=3000)
    text = NOTES + INFLUX + of_influx(0, "T1") + of_influx(1, "T2") + NOTES + SPINDLE + second
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert not data.losses
    assert {n: v.size for (_, n), v in data.values.items()} == {"T1": 20, "T2": 20, "speed": 3000, "load": 3000}


def test_a_field_of_two_tables_is_called_by_all_that_tells_it(tmp_path: Path) -> None:
    text = NOTES + INFLUX + of_influx(0, "value") + NOTES + SPINDLE + of_spindle(1, "value")
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert sorted(n for _, n in data.values) == ["value/drive", "value/m1/temp"]
    assert not data.losses


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Tag,Timestamp,Value", "{tag},{k:02d}-Mar-2026 08:00:00,{v}"),
        ("tagpath,floatvalue,dataintegrity,t_stamp", "{tag},{v},192,{ms}"),
        ("Time,Series,Value", "2026-03-{k:02d} 08:00:00,{tag},{v}"),
    ],
)
def test_the_layouts_of_historians(tmp_path: Path, head: str, row: str) -> None:
    first = np.datetime64("2026-03-01T08:00:00", "ms").astype(int)
    rows = [
        row.format(tag=tag, k=k, v=k + 0.5, ms=first + (k - 1) * 86_400_000)
        for tag in ("a/T1", "a/T2")
        for k in range(1, 29)
    ]
    data = load(Reader(), written(tmp_path, "\n".join([head, *rows, ""]), "pi.csv"), Source(timezone="UTC"))
    assert data.values["a/T2", "a/T2"].tolist() == [k + 0.5 for k in range(1, 29)]
    assert data.t_ns["a/T2"][:2].tolist() == [first * 1_000_000, (first + 86_400_000) * 1_000_000]
    assert not data.losses


@pytest.mark.parametrize(
    ("name", "bad", "told"),
    [
        ("Quality", ["16408", "24", "512"], True),  # 0x4018: a vendor's byte above OPC's own
        ("dataintegrity", ["300", "500", "512", "88", "200"], True),  # Ignition: good is 192 alone
        ("Quality", ["16576", "192", "64"], False),
    ],
)
def test_a_quality_of_16_bit_is_none_of_opc_ua(tmp_path: Path, name: str, bad: list[str], told: bool) -> None:
    rows = [f"2026-03-02 08:00:{k:02d},T1,{20 + k / 10},{192 if k % 3 else bad[k % len(bad)]}\n" for k in range(40)]
    path = written(tmp_path, f"Time,Tag,Value,{name}\n" + "".join(rows), "h.csv")
    data = load(Reader(), path, Source(timezone="UTC"))
    (flags,) = data.flags.values()
    assert [k for k, flag in enumerate(flags) if flag] == ([*range(0, 40, 3)] if told else [])


FAULTS = {"Error": ("0", "3001"), "Fehlercode": ("0", "1200"), "Fault": ("", "sensor break")}


@pytest.mark.parametrize("name", FAULTS)
@pytest.mark.parametrize("tag", ["Point", "MPoint", "Ch"])
def test_a_column_of_faults_flags_its_row(tmp_path: Path, name: str, tag: str) -> None:
    none, fault = FAULTS[name]
    rows = [
        f"{point};2026-03-02 08:00:{k:02d};{850 if k == 7 else 20 + k / 10};°C;{fault if k == 7 and p else none}\n"
        for k in range(40)
        for p, point in enumerate(("T_bed", "T_front") if tag != "Ch" else ("10", "11"))
    ]
    path = written(tmp_path, f"{tag};Time;Value;Unit;{name}\n" + "".join(rows), "h.csv")
    source = Source(timezone="UTC", table=None if tag != "Ch" else {"series": ["Ch"]})
    data = load(Reader(), path, source)
    flags = [data.flags[key] for key in data.values if key[1] in ("T_bed", "T_front") or "Value" in key[1]]
    assert [np.flatnonzero(each).tolist() for each in flags] == [[], [7]]
    assert any(f"'{name}' tells the faults of" in note for note in Reader().describe(path, source).notes)


def test_an_error_that_is_a_length_is_no_fault(tmp_path: Path) -> None:
    rows = [f"X;2026-03-02 08:00:{k:02d};{20 + k / 10};{k % 3 / 8}\n" for k in range(40)]
    data = load(Reader(), written(tmp_path, "Tag;Time;Value;Error\n" + "".join(rows), "h.csv"), Source(timezone="UTC"))
    assert not any(flags.any() for flags in data.flags.values())


@pytest.mark.parametrize("tag", ["tagid", "tagpath"])
@pytest.mark.parametrize("none", ["", "NULL"])
def test_a_value_stands_in_the_column_of_its_type(tmp_path: Path, tag: str, none: str) -> None:
    """As Ignition keeps it: a number that is whole in one column, one with decimals in another."""
    names = {"tagid": ("11", "31"), "tagpath": ("mill7/bed_c", "mill7/speed_rpm")}[tag]
    times = [1792742400000 + 10_000 * k for k in range(40)]
    rows = [f"{names[0]},{none},{21 + k / 8},{none},192,{t}\n" for k, t in enumerate(times)]
    rows += [f"{names[1]},{4000 + k},{none},{none},192,{t + 1}\n" for k, t in enumerate(times)]
    text = f"{tag},intvalue,floatvalue,stringvalue,dataintegrity,t_stamp\n" + "".join(
        sorted(rows, key=lambda r: r.split(",")[-1])
    )
    data = load(Reader(), written(tmp_path, text, "h.csv"), Source())
    distinct = {n: list(dict.fromkeys(v[np.isfinite(v)].tolist())) for (_, n), v in data.values.items()}
    assert distinct == {names[0]: [21 + k / 8 for k in range(40)], names[1]: [4000.0 + k for k in range(40)]}
    assert not data.losses


def test_a_tag_that_dies_has_no_value_beyond_ten_of_its_steps(tmp_path: Path) -> None:
    rows = [
        f"2026-03-02T08:{k // 60:02d}:{k % 60:02d}Z;{tag};{20 + (k * 7 % 5) / 10};192"
        for k in range(120)
        for tag in ("T_bed", "T_dead")
        if tag == "T_bed" or not 50 <= k < 90
    ]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["time;tag;value;quality", *rows, ""]))
    data = load(Reader(), path, Source())
    dead = np.isnan(data.values["nc", "T_dead"])
    assert np.flatnonzero(dead).tolist() == list(range(60, 90))


def test_an_axis_at_rest_keeps_its_feed_between_heartbeats(tmp_path: Path) -> None:
    moves = [(3600 * h + 10 * k, 9 + (k * 7 % 5) / 10) for h in range(4) for k in range(180)]
    rests = [(3600 * h + 1800 + 600 * k, 0.0) for h in range(4) for k in range(3)]
    bed = [(60 * k, 20 + (k * 7 % 5) / 10) for k in range(240)]
    rows = sorted((t, tag, v) for tag, log in (("Feed_X", moves + rests), ("T_bed", bed)) for t, v in log)
    path = tmp_path / "log.csv"
    told = [f"2026-03-02T{t // 3600:02d}:{t // 60 % 60:02d}:{t % 60:02d}Z;{tag};{v};192" for t, tag, v in rows]
    path.write_text("\n".join(["time;tag;value;quality", *told, ""]))
    data = load(Reader(), path, Source())
    feed = data.values["nc", "Feed_X"]
    assert not np.isnan(feed).any()
    assert (feed == 0).sum() == 4 * 30
