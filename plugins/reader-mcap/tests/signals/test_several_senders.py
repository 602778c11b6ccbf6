"""Topics on which several sensors send."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_mcap import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source

T0, STEP = 1_772_434_800_000_000_000, 10 * 10**9
SENSORS = ("bearing", "column", "hall")


def sent(field: str, n: int = 50, apart_ns: int = 200_000_000) -> list[tuple[str, int, Any]]:
    def message(name: str, k: int, j: int) -> dict[str, Any]:
        named = {"header": {"frame_id": name, "stamp": k}} if field == "header" else {field: name}
        return {**named, "value": 20.0 + 5 * j + k / 8}

    return [
        ("/temps", T0 + k * STEP + j * apart_ns, message(name, k, j))
        for k in range(n)
        for j, name in enumerate(SENSORS)
    ]


@pytest.mark.parametrize("field", ["sensor", "name", "id", "header"])
@pytest.mark.parametrize("apart_ns", [0, 200_000_000])
def test_each_sender_is_a_stream(tmp_path: Path, write: Any, read: Any, field: str, apart_ns: int) -> None:
    path = write(tmp_path / "a.mcap", sent(field, apart_ns=apart_ns))
    recording, times, values, _, losses = read(path)
    assert not losses
    for j, name in enumerate(SENSORS):
        assert values[f"/temps/{name}.value"] == [20.0 + 5 * j + k / 8 for k in range(50)]
        assert np.diff(times[f"/temps/{name}"]).tolist() == [STEP] * 49
    assert not any(s.name == "/temps.value" for s in recording.signals)
    assert any("3 series" in note and "bearing" in note for note in recording.notes)


def test_a_stamp_in_the_messages_is_the_time_of_each_sender(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [(t, at + 1000, {**m, "stamp": at}) for t, at, m in sent("sensor")]
    path = write(tmp_path / "a.mcap", messages)
    source = Source(options={"time": "stamp", "time_unit": "ns"})
    _, times, values, _, losses = read(path, source)
    assert not losses
    assert times["/temps/column"][0] == T0 + 200_000_000
    assert values["/temps/column.log_time"][0] == T0 + 200_000_000 + 1000


def test_a_row_of_a_sender_is_found_in_its_file(tmp_path: Path, write: Any) -> None:
    path = write(tmp_path / "a.mcap", sent("sensor"))
    where = Reader().locate(path, Source(), "/temps/column", 4)
    assert where is not None
    assert where.startswith("message 14,")
    assert where.endswith(str(T0 + 4 * STEP + 200_000_000))


def test_a_sender_that_comes_later_than_the_first_look_is_a_loss(tmp_path: Path, write: Any, read: Any) -> None:
    messages = sent("sensor", 3000)
    topic, at, _ = messages[4000]
    messages[4000] = (topic, at, {"sensor": "door", "value": 3.0})
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert [loss.reason for loss in losses] == ["1 row of 'door', which the first look at the file did not meet"]
    assert sum(len(v) for v in values.values()) == 8999


@pytest.mark.parametrize(
    "word",
    [
        lambda k: f"MPF{k // 40}",
        lambda k: ("idle", "run")[k % 2],
        lambda k: ("roughing", "finishing")[k // 7 % 2],
        lambda k: "",
        lambda k: "base_link",
    ],
)
@pytest.mark.parametrize("field", ["mode", "name", "axis"])
def test_what_the_machine_did_is_no_sender(tmp_path: Path, write: Any, read: Any, word: Any, field: str) -> None:
    messages = [("/axis", T0 + k * STEP, {field: word(k), "T": 20 + k / 8}) for k in range(200)]
    recording, times, _, _, _ = read(write(tmp_path / "a.mcap", messages))
    assert set(times) == {"/axis"}
    assert {s.name for s in recording.signals} == {f"/axis.{field}", "/axis.T"}


def test_blocks_of_a_program_are_no_senders_and_may_be_declared_so(tmp_path: Path, write: Any, read: Any) -> None:
    rng = np.random.default_rng(0)
    at = np.cumsum(rng.uniform(0.07, 0.14, 400) * 1e9).astype(np.int64)
    names = rng.choice(["G0", "G1", "M6"], 400).tolist()
    messages = [
        ("/nc", T0 + int(t), {"block": {"name": name}, "pos": k / 8})
        for k, (t, name) in enumerate(zip(at, names, strict=True))
    ]
    path = write(tmp_path / "a.mcap", messages)
    recording, times, _, _, _ = read(path)
    assert set(times) == {"/nc"}
    assert any("options: {series: [/nc.block.name]}" in note for note in recording.notes)
    _, times, _, _, _ = read(path, Source(options={"series": ["block.name"]}))
    assert set(times) == {"/nc/G0", "/nc/G1", "/nc/M6"}


def test_senders_are_not_taken_apart_where_it_is_declared(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(tmp_path / "a.mcap", sent("sensor"))
    assert set(read(path, Source(options={"series": "none"}))[1]) == {"/temps"}
    with pytest.raises(FormatError, match="nothing is called 'host'"):
        read(path, Source(options={"series": ["host"]}))
    recording, times, _, _, _ = read(path)
    assert len(times) == 3
    assert any("options: {series: none}" in note for note in recording.notes)


@pytest.mark.parametrize("field", ["ch", "sensor", "slave"])
def test_a_sender_may_be_a_number(tmp_path: Path, write: Any, read: Any, field: str) -> None:
    messages = [
        ("/temps", T0 + k * STEP + j * 3 * 10**9, {field: j + 1, "value": 20.0 + 5 * j + k / 8})
        for k in range(50)
        for j in range(2)
    ]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert not losses
    for j in range(2):
        assert values[f"/temps/{field} {j + 1}.value"] == [20.0 + 5 * j + k / 8 for k in range(50)]


def test_a_counter_beside_a_value_is_no_sender(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/temps", T0 + k * STEP, {"seq": k % 2, "value": 20.0 + 5 * (k % 2) + k / 8}) for k in range(100)]
    _, _, values, _, _ = read(write(tmp_path / "a.mcap", messages))
    assert set(values) == {"/temps.seq", "/temps.value"}
