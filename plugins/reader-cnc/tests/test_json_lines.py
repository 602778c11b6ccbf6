"""Lines of JSON: what brokers, Telegraf, Industrial Edge and scripts write, and what is wrong with it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.messages.json_lines import claims
from thermodata_reader_cnc.messages.json_text import loads

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.schema.flag import Flag
from thermodata.testing.reader import load, reader_checks

from .logs import START_S, iso, messages_written, read_messages, values

SHAPES: dict[str, tuple[Callable[[int], Any], dict[str, list[Any]]]] = {
    "flat": (
        lambda k: {"ts": iso(k), "T1": 20 + k / 4, "T2 [degC]": 21, "mode": "AUTO"},
        {"T1": [20.0, 20.25, 20.5, 20.75], "T2 [degC]": [21.0] * 4, "mode": ["AUTO"] * 4},
    ),
    "ms since 1970": (
        lambda k: {"time": (START_S + k) * 1000, "T1": k, "T2": 2.5},
        {"T1": [0.0, 1.0, 2.0, 3.0], "T2": [2.5] * 4},
    ),
    "within": (
        lambda k: {"ts": iso(k), "spindle": {"T": {"value": k, "unit": "degC"}, "n": 3000}, "pos": [1, k]},
        {
            "spindle.T": [0.0, 1.0, 2.0, 3.0],
            "spindle.n": [3000.0] * 4,
            "pos[0]": [1.0] * 4,
            "pos[1]": [0.0, 1.0, 2.0, 3.0],
        },
    ),
    "telegraf": (
        lambda k: {"fields": {"T1": k, "n": 3000}, "name": "plc", "tags": {"host": "a"}, "timestamp": START_S + k},
        {"T1": [0.0, 1.0, 2.0, 3.0], "n": [3000.0] * 4},
    ),
    "telegraf in batches": (
        lambda k: {
            "metrics": [{"fields": {"T": k + i}, "name": f"m{i}", "tags": {}, "timestamp": START_S + k} for i in (0, 1)]
        },
        {"m0/T": [0.0, 1.0, 2.0, 3.0], "m1/T": [1.0, 2.0, 3.0, 4.0]},
    ),
    "industrial edge": (
        lambda k: {"seq": k, "vals": [{"id": i, "val": k + 0.5, "ts": iso(k), "qc": 3} for i in ("101", "102")]},
        {"101": [0.5, 1.5, 2.5, 3.5], "102": [0.5, 1.5, 2.5, 3.5]},
    ),
    "industrial edge, time series": (
        lambda k: {"seq": k, "records": [{"ts": iso(k), "rseq": k, "vals": [{"id": "1", "val": f"{k}.5", "qc": 3}]}]},
        {"1": [0.5, 1.5, 2.5, 3.5]},
    ),
    "mosquitto, a payload that is a text": (
        lambda k: {"tst": iso(k), "topic": "a", "qos": 0, "payloadlen": 9, "payload": json.dumps({"T": k, "h": 40})},
        {"T": [0.0, 1.0, 2.0, 3.0], "h": [40.0] * 4},
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_what_a_message_reports(tmp_path: Path, shape: str) -> None:
    make, expected = SHAPES[shape]
    data = read_messages(tmp_path, [make(k) for k in range(4)])
    assert values(data) == expected
    assert data.t_ns["nc"].tolist() == [(START_S + k) * 10**9 for k in range(4)]
    assert not data.losses


def test_a_value_of_a_topic_holds_until_its_next_one(tmp_path: Path) -> None:
    data = read_messages(tmp_path, [{"ts": iso(k), "topic": f"shop/T{k % 2}", "value": 20 + k} for k in range(6)])
    assert values(data)["shop/T0"] == [20.0, 20.0, 22.0, 22.0, 24.0, 24.0]
    assert all(signal.held for signal in data.recording.signals)


def test_objects_of_the_same_keys_hold_nothing(tmp_path: Path) -> None:
    messages = [{"ts": iso(k), "T1": 20 + k, "T2": 30 + k} for k in range(200)]
    late = {"ts": iso(200), "T1": 20.5, "T2": None}
    data = read_messages(tmp_path, [*messages, late])
    assert not any(signal.held for signal in data.recording.signals)
    assert np.isnan(values(data)["T2"][-1])


def test_labels_that_differ_part_the_names_and_those_that_come_late_are_told(tmp_path: Path) -> None:
    def message(k: int, host: str) -> dict[str, Any]:
        return {"ts": iso(k), "host": host, "T1": float(k)}

    both = read_messages(tmp_path, [message(k, "ab"[k % 2]) for k in range(8)])
    assert sorted(values(both)) == ["a/T1", "b/T1"]
    one = [message(k, "a") for k in range(150_000)]
    one[100_000]["host"] = "b"
    late = read_messages(tmp_path, one)
    assert sorted(values(late)) == ["T1"]
    assert len(late.t_ns["nc"]) == len(one) - 1
    (loss,) = late.losses
    assert loss.where == "log.jsonl line 100001"
    assert "'b'" in loss.reason


def test_units_and_qualities_beside_a_value(tmp_path: Path) -> None:
    messages = [{"ts": iso(k), "name": "dZ", "value": 1.5, "unit": "um", "quality": "Good"} for k in range(4)]
    messages[2] |= {"value": 0.0025, "unit": "mm", "quality": "Bad"}
    data = read_messages(tmp_path, messages)
    assert [(s.name, s.unit) for s in data.recording.signals] == [("dZ", "um")]
    assert values(data)["dZ"] == [1.5, 1.5, 2.5, 1.5]
    flags = data.flags["nc", "dZ"]
    assert [bool(f & int(Flag.NOT_MEASURING)) for f in flags] == [False, False, True, False]


def test_a_bad_value_of_industrial_edge_is_flagged(tmp_path: Path) -> None:
    messages = [{"vals": [{"id": "7", "val": k, "ts": iso(k), "qc": 0 if k == 1 else 2}]} for k in range(3)]
    data = read_messages(tmp_path, messages)
    assert [bool(f & int(Flag.NOT_MEASURING)) for f in data.flags["nc", "7"]] == [False, True, False]


def test_a_log_may_be_an_array_with_an_object_a_line(tmp_path: Path) -> None:
    lines = ["[", *(json.dumps({"ts": iso(k), "T1": k, "T2": 2}) + "," for k in range(4)), "]"]
    lines[-2] = lines[-2].removesuffix(",")
    data = read_messages(tmp_path, lines)
    assert values(data)["T1"] == [0.0, 1.0, 2.0, 3.0]
    assert not data.losses


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('{"ts": "2026-03-02T08:00:01Z", "T1": 1,', "expected an object of JSON"),
        ('{"ts": "2026-03-02T08:00:01Z", "T1": 1, "T1": 2}', "expected an object of JSON"),
        ("[" * 5000 + "]" * 5000, "expected an object of JSON"),
        ('{"T1": 20.5, "T2": 3}', "expected a time and a value"),
        ("1e999999", "expected an object of JSON"),
        ('{"' + ";" * 90_000 + '": 1, "ts": "2026-03-02T08:00:01Z"}', "expected an object of JSON"),
        ('{"ts": "' + "1" * 90_000 + '", "T1": 1, "T2": 2}', "expected a time and a value"),
        ('{"ts": "2026-03-02T08:00:01Z", "T1": ' + "9" * 6000 + ', "T2": 1}', "expected a number, got '9999"),
        ('{"ts": "2026-03-02T08:00:01Z", "T1": "x", "T2": 1}', "expected a number, got 'x'"),
    ],
)
def test_a_line_that_is_damaged_is_lost_alone(tmp_path: Path, line: str, said: str) -> None:
    good = [{"ts": iso(k), "T1": k, "T2": 2} for k in range(30)]
    data = read_messages(tmp_path, [*good[:10], line, *good[10:]])
    assert values(data)["T1"][-1] == 29.0
    assert [loss.where for loss in data.losses] == ["log.jsonl line 11"]
    assert said in data.losses[0].reason


def test_a_last_line_that_is_cut_is_lost(tmp_path: Path) -> None:
    path = messages_written(tmp_path, [{"ts": iso(k), "T1": k, "T2": 2} for k in range(30)])
    whole = path.read_bytes()
    path.write_bytes(whole[:-1])  # without its line end it is whole by its bracket
    assert not load(Reader(), path, Source()).losses
    path.write_bytes(whole[:-4])
    data = load(Reader(), path, Source())
    assert [loss.where for loss in data.losses] == ["log.jsonl line 30"]


def test_local_times_are_of_the_source_and_numbers_keep_their_digits(tmp_path: Path) -> None:
    local = [{"ts": f"2026-03-02 09:00:0{k}", "T1": k, "T2": 2} for k in range(4)]
    data = read_messages(tmp_path, local, Source(timezone="Europe/Prague"))
    assert data.t_ns["nc"][0] == START_S * 10**9
    fine = [{"ts": START_S * 10**9 + k, "T1": k, "T2": 2} for k in range(4)]
    assert np.diff(read_messages(tmp_path, fine).t_ns["nc"]).tolist() == [1, 1, 1]


def test_objects_without_a_date_are_refused(tmp_path: Path) -> None:
    path = messages_written(tmp_path, [{"ts": k / 2, "T1": k} for k in range(9)])
    with pytest.raises(FormatError, match="no lines of JSON with a time"):
        load(Reader(), path, Source())


@pytest.mark.parametrize(
    "lines",
    [
        ['{"T1": 20.5}'] * 9,  # no time
        ['{"ts": "2026-03-02T08:00:00Z", "T1": 1}'] * 2,  # too few to tell
        ["2026-03-02 08:00:00;20.5"] * 9,
        ['{"Header": {', '"Time": 1', "}}"],
    ],
)
def test_what_is_not_claimed(lines: list[str]) -> None:
    assert claims(lines) is None


@pytest.mark.parametrize("text", ["[" * 100 + "]" * 100, '{"a": ' * 60 + "1" + "}" * 60, '"' + "x" * (1 << 20) + '"'])
def test_texts_beyond_the_limits_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"brackets|longer"):
        loads(text)


KIT = {
    "topics": [{"ts": iso(k), "topic": f"T{k % 3}", "value": 20 + k / 8} for k in range(400)],
    "flat": [{"ts": iso(k), "T1": 20 + k / 8, "T2": 21.5, "mode": "AUTO"} for k in range(400)],
}


@pytest.mark.parametrize("kind", KIT)
@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
def test_kit(tmp_path: Path, number: int, kind: str) -> None:
    reader_checks(Reader, [(messages_written(tmp_path, KIT[kind]), Source())], unordered=True)[number]()


def dying(k: int, name: str) -> list[dict[str, Any]]:
    """A name each second, and one that is silent for 40 s, both with noise in the last digit."""
    noise = 20 + (k * 7 % 5) / 10
    own = [] if 50 <= k < 90 else [{"ts": iso(k), "topic": "T_dead", name: noise}]
    return [{"ts": iso(k), "topic": "T_bed", name: noise}, *own]


def test_a_sensor_that_dies_has_no_value_beyond_ten_of_its_steps(tmp_path: Path) -> None:
    data = read_messages(tmp_path, [m for k in range(120) for m in dying(k, "value")])
    dead = data.values["nc", "T_dead"]
    assert np.flatnonzero(np.isnan(dead)).tolist() == list(range(60, 90))
    flags = data.flags["nc", "T_dead"]
    assert (flags[60:90] == Flag.NOT_MEASURING).all()
    assert flags[90] == Flag.GAP
    assert not np.isnan(data.values["nc", "T_bed"]).any()


def test_a_value_on_change_holds_however_long_it_is_silent(tmp_path: Path) -> None:
    messages = [{"ts": iso(k), "topic": "T_bed", "value": 20 + (k * 7 % 5) / 10} for k in range(120)]
    messages[40:40] = [{"ts": iso(40), "topic": "n", "value": 3000}]
    messages[100:100] = [{"ts": iso(99), "topic": "n", "value": 0}]
    data = read_messages(tmp_path, messages)
    assert data.values["nc", "n"][41:90].tolist() == [3000.0] * 49


def test_a_metric_that_is_null_has_no_value(tmp_path: Path) -> None:
    def metric(k: int) -> dict[str, Any]:
        told = {"isNull": True} if k in (2, 3) else {"isNull": False, "value": 20.0 + k}
        return {"timestamp": (START_S + k) * 1000, "metrics": [{"name": "CH1/T", "dataType": "Double", **told}]}

    data = read_messages(tmp_path, [metric(k) for k in range(6)])
    ((_, column),) = data.values.items()
    assert np.isnan(column).tolist() == [False, False, True, True, False, False]
