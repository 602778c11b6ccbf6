"""Exports of historians and of InfluxDB: a row a value, taken apart by what it is of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import load

from .test_sco_opcua import written

INFLUX = ",result,table,_start,_stop,_time,_value,_field,_measurement,machine\n"


NOTES = "#group,false,false,true,true,false,false,true,true,true\n#default,_result,,,,,,,,\n"


def of_influx(table: int, field: str, machine: str = "m1") -> str:
    span = "2026-03-02T00:00:00Z,2026-03-03T00:00:00Z"
    rows = range(20)
    return "".join(f",,{table},{span},2026-03-02T08:00:{k:02d}Z,{k + table / 4},{field},temp,{machine}\n" for k in rows)


def test_an_export_of_influxdb_is_taken_apart_over_its_tables(tmp_path: Path) -> None:
    text = NOTES + INFLUX + of_influx(0, "T1") + of_influx(1, "T2") + "\n" + NOTES + INFLUX + of_influx(2, "T3")
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert {n: v.tolist() for (_, n), v in data.values.items()} == {
        f"T{1 + k}": [i + k / 4 for i in range(20)] for k in range(3)
    }
    assert data.recording.start_ns == np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
    assert not data.losses


def test_tags_of_influxdb_that_differ_are_part_of_the_name(tmp_path: Path) -> None:
    text = INFLUX + of_influx(0, "T1", "m1") + of_influx(1, "T1", "m2")
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert sorted(n for _, n in data.values) == ["m1", "m2"]


def test_columns_that_are_named_anew_end_a_long_table(tmp_path: Path) -> None:
    other = INFLUX.replace("_field,_measurement,machine", "hall,_measurement,_field")
    text = INFLUX + of_influx(0, "T1") + of_influx(1, "T2") + other + of_influx(2, "T3")
    data = load(Reader(), written(tmp_path, text, "influx.csv"), Source())
    assert sorted(n for _, n in data.values) == ["T1", "T2"]
    assert [loss.where for loss in data.losses] == ["influx.csv line 42"]
    assert "other columns" in data.losses[0].reason


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
