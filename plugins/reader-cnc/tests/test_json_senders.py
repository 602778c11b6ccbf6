"""Lines of JSON of several sensors: what says whose a message is."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import load
from thermodata.testing.reader.case import head

from .logs import START_S, iso, read_messages, values


def of_two(message: Callable[[str, dict[str, Any]], Any], n: int = 40) -> list[Any]:
    """Messages of two sensors in turn, of 20 and 30 degrees."""
    return [
        message(name, {"ts": iso(10 * k + 3 * j), "T": 20.0 + 10 * j + k / 100})
        for k in range(n)
        for j, name in enumerate(("bed", "front"))
    ]


BESIDE: dict[str, Callable[[str, dict[str, Any]], Any]] = {
    "device": lambda name, at: {"device": {"name": name}, "data": at},
    "source": lambda name, at: {"source": {"id": name}, "time": at["ts"], "c8y": {"T": {"value": at["T"]}}},
    "ids": lambda name, at: {
        "end_device_ids": {"device_id": name, "application_ids": {"application_id": "hall"}},
        "received_at": at["ts"],
        "uplink_message": {"decoded_payload": {"T": at["T"]}},
    },
    "behind": lambda name, at: {**at, "meta": {"sensor": name}},
    "mac": lambda name, at: {**at, "mac": f"a4:c1:{name}"},
    "gateway": lambda name, at: {**at, "gateway": name},
    "labels": lambda name, at: {**at, "labels": {"instance": name}},
    "number": lambda name, at: {**at, "slave": 3 if name == "bed" else 4},
}


@pytest.mark.parametrize("kind", BESIDE)
def test_sensors_that_a_message_names_beside_its_values_are_parted(tmp_path: Path, kind: str) -> None:
    data = read_messages(tmp_path, of_two(BESIDE[kind]))
    found = [v[-1] for (_, name), v in data.values.items() if v.dtype.kind == "f" and name.endswith("T")]
    assert found == [20.39, 30.39]
    assert not data.losses


@pytest.mark.parametrize("kind", ["mac", "gateway", "labels"])
def test_messages_that_are_declared_to_be_of_one_sensor_are(tmp_path: Path, kind: str) -> None:
    data = read_messages(tmp_path, of_two(BESIDE[kind]), Source(table={"series": "none"}))
    assert sorted(v.dtype.kind for v in data.values.values()) == ["O", "f"]


def test_a_key_that_is_declared_parts_messages(tmp_path: Path) -> None:
    messages = [{"ts": iso(k), "spot": "ab"[k // 20], "T": 20.0 + k // 20} for k in range(40)]
    assert set(values(read_messages(tmp_path, messages))) == {"spot", "T"}  # a state, for all that one sees
    assert set(values(read_messages(tmp_path, messages, Source(table={"series": ["spot"]})))) == {"a/T", "b/T"}
    with pytest.raises(FormatError, match="nothing is called 'mac'"):
        read_messages(tmp_path, messages, Source(table={"series": ["mac"]}))


def test_what_a_message_says_of_the_machine_parts_nothing(tmp_path: Path) -> None:
    messages = [
        {"ts": iso(k), "program": {"name": f"MPF{k // 20}"}, "mode": "AUTO" if k // 10 % 2 else "JOG", "T": 20 + k / 10}
        for k in range(60)
    ]
    assert set(values(read_messages(tmp_path, messages))) == {"mode", "T"}
    machine = [{"ts": iso(k), "machine": {"name": "M1", "state": "RUN"}, "T": 20 + k / 10} for k in range(60)]
    assert set(values(read_messages(tmp_path, machine))) == {"T"}


MS = 1000 * START_S


def test_tags_of_kepware_s_gateway_are_signals_of_their_own_with_their_quality(tmp_path: Path) -> None:
    def tag(name: str, k: int, value: float) -> dict[str, Any]:
        return {"id": f"Channel1.{name}", "v": value, "q": k != 3, "t": MS + 1000 * k}

    lines = [{"timestamp": MS + 1000 * k, "values": [tag("T", k, 20.5), tag("n", k, 900 + k)]} for k in range(9)]
    data = read_messages(tmp_path, lines)
    assert values(data) == {"Channel1.T": [20.5] * 9, "Channel1.n": [900.0 + k for k in range(9)]}
    assert [int(f) for f in data.flags["nc", "Channel1.T"]] == [0, 0, 0, 128, 0, 0, 0, 0, 0]
    data = read_messages(tmp_path, [{"ts": iso(k), "id": "a", "v": 3.5, "T": 20.0 + k} for k in range(9)])
    assert {"v", "T"} <= set(values(data))


def test_lists_by_device_or_signal_are_no_one_signal(tmp_path: Path) -> None:
    """As ThingsBoard's gateway and its interface write them."""
    lines = [
        {f"Device {d}": [{"ts": MS + 60_000 * k, "values": {"T": 20.0 + 5 * j}}]}
        for k in range(20)
        for j, d in enumerate("AB")
    ]
    got = values(read_messages(tmp_path, lines))
    assert got.keys() == {"Device A/values.T", "Device B/values.T"}
    assert {20.0} == {v for v in got["Device A/values.T"] if v == v}
    alone = [{"Device A": [{"ts": MS + 60_000 * k, "values": {"T": 20.0}}]} for k in range(20)]
    assert values(read_messages(tmp_path, alone)).keys() == {"values.T"}
    whole = {n: [{"ts": MS + 60_000 * k, "value": str(v)} for k in range(20)] for n, v in (("T", 20.5), ("n", 900))}
    got = values(read_messages(tmp_path, [whole]))
    assert got.keys() == {"T/value", "n/value"}
    assert {20.5} == {v for v in got["T/value"] if v == v}


def test_a_pack_of_senml_has_its_bases(tmp_path: Path) -> None:
    pack = [{"bn": "urn:dev:1:", "bt": START_S, "bu": "Cel", "bv": 20, "n": "T1", "v": 0.5}]
    pack += [{"n": "T1", "t": 60 * k, "v": k / 8} for k in range(1, 12)]
    pack += [{"n": "rh", "u": "%RH", "t": 60 * k, "v": 20 + k} for k in range(12)]
    data = read_messages(tmp_path, [pack])
    assert [(s.name, s.unit) for s in data.recording.signals] == [("urn:dev:1:T1", "Cel"), ("urn:dev:1:rh", "%RH")]
    assert data.t_ns["nc"][:2].tolist() == [START_S * 10**9, (START_S + 60) * 10**9]
    got = values(data)["urn:dev:1:T1"]
    assert [20.5, *(20 + k / 8 for k in range(1, 12))] == [v for v in got if v == v][:12]
    packs = [[{"bn": "m:", "bt": START_S + 60 * k, "n": "T", "u": "Cel", "v": 20 + k}] for k in range(9)]
    assert values(read_messages(tmp_path, packs)) == {"m:T": [20.0 + k for k in range(9)]}


@pytest.mark.parametrize(
    "spoilt", [{"t": "NaN"}, {"t": "Infinity"}, {"t": "1e999999999999"}, {"t": [1]}, {"bt": "x"}, {"bt": {"a": 1}}]
)
def test_a_time_that_is_none_costs_its_own_record_of_senml(tmp_path: Path, spoilt: dict[str, Any]) -> None:
    """It was raised while the file was looked at, and no reader took the file."""
    packs = [[{"bn": "m:", "n": "T", "u": "Cel", "t": START_S + 60 * k, "v": 20 + k}] for k in range(40)]
    packs[20][0] = {**packs[20][0], **spoilt}
    assert values(read_messages(tmp_path, packs)) == {"m:T": [20.0 + k for k in range(40) if k != 20]}
    assert Reader().sniff(head(tmp_path / "log.jsonl")) is not None


def test_senml_that_counts_back_from_now_is_not_dated(tmp_path: Path) -> None:
    path = tmp_path / "log.json"
    path.write_text(json.dumps([{"bn": "m:", "n": "T", "t": -10 * k, "v": 20 + k} for k in range(9)]) + "\n")
    assert Reader().sniff(head(path)) is None


def test_an_array_is_read_with_its_brackets_beside_its_objects(tmp_path: Path) -> None:
    path = tmp_path / "log.json"
    objects = [json.dumps({"ts": iso(k), "T": 20.0 + k}) for k in range(9)]
    path.write_text("[" + ",\n".join(objects) + "]\n")
    data = load(Reader(), path, Source())
    assert values(data) == {"T": [20.0 + k for k in range(9)]}
    assert not data.losses
