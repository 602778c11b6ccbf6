"""Lines of JSON of several sensors: what says whose a message is."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

START_S = 1_772_438_400  # 2026-03-02T08:00:00Z


def iso(k: int) -> str:
    return str(np.datetime64(START_S + k, "s")) + "Z"


def read(folder: Path, messages: list[Any], source: Source | None = None) -> Data:
    path = folder / "log.jsonl"
    path.write_text("".join(json.dumps(m) + "\n" for m in messages), encoding="utf-8")
    return load(Reader(), path, source or Source())


def values(data: Data) -> dict[str, list[Any]]:
    return {name: v.tolist() for (_, name), v in data.values.items()}


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
    data = read(tmp_path, of_two(BESIDE[kind]))
    found = [v[-1] for (_, name), v in data.values.items() if v.dtype.kind == "f" and name.endswith("T")]
    assert found == [20.39, 30.39]
    assert not data.losses


@pytest.mark.parametrize("kind", ["mac", "gateway", "labels"])
def test_messages_that_are_declared_to_be_of_one_sensor_are(tmp_path: Path, kind: str) -> None:
    data = read(tmp_path, of_two(BESIDE[kind]), Source(table={"series": "none"}))
    assert sorted(v.dtype.kind for v in data.values.values()) == ["O", "f"]


def test_a_key_that_is_declared_parts_messages(tmp_path: Path) -> None:
    messages = [{"ts": iso(k), "spot": "ab"[k // 20], "T": 20.0 + k // 20} for k in range(40)]
    assert set(values(read(tmp_path, messages))) == {"spot", "T"}  # a state, for all that one sees
    assert set(values(read(tmp_path, messages, Source(table={"series": ["spot"]})))) == {"a/T", "b/T"}
    with pytest.raises(FormatError, match="nothing is called 'mac'"):
        read(tmp_path, messages, Source(table={"series": ["mac"]}))


def test_what_a_message_says_of_the_machine_parts_nothing(tmp_path: Path) -> None:
    messages = [
        {"ts": iso(k), "program": {"name": f"MPF{k // 20}"}, "mode": "AUTO" if k // 10 % 2 else "JOG", "T": 20 + k / 10}
        for k in range(60)
    ]
    assert set(values(read(tmp_path, messages))) == {"mode", "T"}
    machine = [{"ts": iso(k), "machine": {"name": "M1", "state": "RUN"}, "T": 20 + k / 10} for k in range(60)]
    assert set(values(read(tmp_path, machine))) == {"T"}
