"""Units that messages say of their fields, and that channels of one topic declare: never two in one signal."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import Writer

T0, STEP = 1_772_434_800_000_000_000, 10 * 10**9
N = 90
UM = [round(0.5 * k, 3) for k in range(N)]


def _z(k: int) -> tuple[float, str]:
    return (UM[k], "um") if k < N // 2 else (UM[k] / 1000, "mm")


def _value(k: int) -> dict[str, Any]:
    return {"value": _z(k)[0], "unit": _z(k)[1]}


@pytest.mark.parametrize(
    ("message", "name", "unit"),
    [
        (_value, "/dz.value", "/dz.unit"),
        (lambda k: {"dZ": _z(k)[0], "unit": _z(k)[1], "T_front_degC": 20.0 + k, "seq": k}, "/dz.dZ", "/dz.unit"),
        (lambda k: {"z": _value(k), "t": {"value": 20.0, "unit": "degC"}}, "/dz.z.value", "/dz.z.unit"),
        (lambda k: {"dZ": _z(k)[0], "dZ_unit": _z(k)[1], "T": 20.5, "T_unit": "degC"}, "/dz.dZ", "/dz.dZ_unit"),
    ],
)
def test_messages_in_another_unit_are_converted_and_told(
    tmp_path: Path, write: Any, read: Any, message: Any, name: str, unit: str
) -> None:
    path = write(tmp_path / "a.mcap", [("/dz", T0 + k * STEP, message(k)) for k in range(N)])
    recording, _, values, _, losses = read(path)
    assert not losses
    assert {s.name: s.unit for s in recording.signals}[name] == "um"
    assert any(f"'{unit}' says the unit of '{name}'" in n and "'mm' is converted" in n for n in recording.notes)
    np.testing.assert_allclose(values[name], UM)


def test_a_unit_that_does_not_convert_leaves_the_other_values_of_its_messages(
    tmp_path: Path, write: Any, read: Any
) -> None:
    # beyond the first look at the file
    unit = ["degC" if k == 61_234 else "um" for k in range(90_000)]
    messages = [("/dz", T0 + k * STEP, {"dZ": 1.5, "unit": u, "T_degC": 0.5 * k}) for k, u in enumerate(unit)]
    path = write(tmp_path / "a.mcap", ((t, at, {**m, "text": "a" * 200}) for t, at, m in messages))
    _, _, values, _, losses = read(path)
    assert len(values["/dz.T_degC"]) == 90_000
    assert ["1 rows in another unit than 'um'" in x.reason for x in losses] == [True]


def test_several_units_of_what_may_be_several_fields_are_told_and_not_taken(
    tmp_path: Path, write: Any, read: Any
) -> None:
    messages = [("/d", T0 + k * STEP, {"dZ": _z(k)[0], "dX": 1.0, "unit": _z(k)[1]}) for k in range(N)]
    recording, _, values, _, _ = read(write(tmp_path / "a.mcap", messages))
    assert values["/d.dZ"] == [_z(k)[0] for k in range(N)]
    assert all(s.unit is None for s in recording.signals)
    assert any("'/d.unit' says several units (um, mm)" in n for n in recording.notes)


@pytest.mark.parametrize("word", ["138", "B", "running"])
def test_what_is_no_unit_stays_a_word_and_is_not_told(tmp_path: Path, write: Any, read: Any, word: str) -> None:
    messages = [("/d", T0 + k * STEP, {"dZ": UM[k], "T": 1.0, "unit": word}) for k in range(N)]
    recording, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert (values["/d.dZ"], losses) == (UM, [])
    assert all(s.unit is None for s in recording.signals)
    assert not any("unit" in n for n in recording.notes)


def _channels(path: Path, units: list[str], how: str) -> Path:
    """One topic whose recorder was started anew with other units, as its schemas or its channels' metadata say."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channels = []
        for unit in units:
            field = {"type": "number"} | ({how: unit} if how != "metadata" else {})
            said = json.dumps({"type": "object", "properties": {"dZ": field}}).encode()
            schema = writer.register_schema("s", "jsonschema", said)
            metadata = {"unit.dZ": unit} if how == "metadata" else {}
            channels.append(writer.register_channel("/daq", "json", schema, metadata=metadata))
        for k in range(N):
            late = k >= N // 2
            value = UM[k] / 1000 if late and units[1] == "mm" else UM[k]
            at = T0 + k * STEP
            writer.add_message(channels[late], at, json.dumps({"dZ": value}).encode(), at)
        writer.finish()
    return path


@pytest.mark.parametrize("how", ["unit", "description", "metadata"])
@pytest.mark.parametrize("units", [["um", "mm"], ["um", "um"], ["um", "degC"]])
def test_channels_of_one_topic_that_declare_other_units_are_brought_to_the_first_ones(
    tmp_path: Path, read: Any, how: str, units: list[str]
) -> None:
    recording, _, values, _, losses = read(_channels(tmp_path / "a.mcap", units, how))
    (signal,) = recording.signals
    assert signal.unit == "um"
    assert any("comes in several units" in n for n in recording.notes) is (units[1] == "mm")
    if units[1] == "degC":  # no reading in um
        assert np.isnan(values["/daq.dZ"][N // 2 :]).all()
        assert any("expected values in 'um', got such in 'degC'" in x.reason for x in losses)
    else:
        np.testing.assert_allclose(values["/daq.dZ"], UM)
        assert not losses


@pytest.mark.parametrize("how", ["unit", "metadata"])
def test_what_channel_and_message_say_alike_is_converted_once(tmp_path: Path, read: Any, how: str) -> None:
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        for late, unit in enumerate(("um", "mm")):
            field = {"type": "number"} | ({"unit": unit} if how == "unit" else {})
            said = json.dumps({"type": "object", "properties": {"value": field, "unit": {"type": "string"}}}).encode()
            metadata = {"unit.value": unit} if how == "metadata" else {}
            channel = writer.register_channel(
                "/daq", "json", writer.register_schema("s", "jsonschema", said), metadata=metadata
            )
            for k in range(late * N // 2, (1 + late) * N // 2):
                message = {"value": UM[k] / 1000 if late else UM[k], "unit": unit}
                writer.add_message(channel, T0 + k * STEP, json.dumps(message).encode(), T0 + k * STEP)
        writer.finish()
    recording, _, values, _, losses = read(path)
    assert not losses
    np.testing.assert_allclose(values["/daq.value"], UM)
    assert sum("is converted" in n for n in recording.notes) == 1


@pytest.mark.parametrize(("late", "read_as"), [("degF", "converted"), ("bar", "lost")])
def test_a_unit_that_changes_within_what_a_sensor_sends_is_of_that_sensor_alone(
    tmp_path: Path, write: Any, read: Any, late: str, read_as: str
) -> None:
    """One topic, whose messages name their sensor and their unit; one of them is set otherwise halfway."""
    sent = [
        ("/meas", T0 + 5_000_000_000 * k + d, {"name": name, "value": value, "unit": unit})
        for k in range(120)
        for d, (name, value, unit) in enumerate(
            [
                ("T_front", 20 + k / 8, "degC") if k < 80 else ("T_front", (20 + k / 8) * 1.8 + 32, late),
                ("disp_z", k / 1000, "mm"),
            ]
        )
    ]
    recording, _, values, _, losses = read(write(tmp_path / "a.mcap", sent))
    units = {s.name: s.unit for s in recording.signals if s.dtype != "str"}
    assert units == {"/meas/T_front.value": "degC", "/meas/disp_z.value": "mm"}
    assert values["/meas/disp_z.value"] == [k / 1000 for k in range(120)]
    many = 120 if read_as == "converted" else 80
    np.testing.assert_allclose(values["/meas/T_front.value"], [20 + k / 8 for k in range(many)])
    if read_as == "converted":
        assert not losses
        assert any("'degF' is converted to 'degC'" in n for n in recording.notes)
    else:
        assert ["40 rows of 'T_front' in another unit than 'degC': bar" in loss.reason for loss in losses] == [True]


@pytest.mark.parametrize(
    "said",
    [
        {"unit": "degC"},
        {"engineeringUnit": "degC"},
        {"description": "bearing, front [degC]"},
        {"description": "Temperature in degC."},
        {"title": "S1 (degC)"},
        {"$ref": "#/$defs/celsius"},
    ],
)
def test_a_schema_says_a_unit_in_more_than_one_way(tmp_path: Path, write: Any, read: Any, said: dict[str, str]) -> None:
    schema = {
        "type": "object",
        "properties": {"S1": said if "$ref" in said else {"type": "number", **said}, "S2": {"description": "in use"}},
        "$defs": {"celsius": {"type": "number", "unit": "degC"}},
    }
    messages = [("/ai", T0 + k * STEP, {"S1": 20.0 + k, "S2": 1.5}) for k in range(9)]
    recording = read(write(tmp_path / "a.mcap", messages, schema=schema))[0]
    assert {s.name: s.unit for s in recording.signals if "S" in s.name} == {"/ai.S1": "degC", "/ai.S2": None}


def test_a_schema_that_refers_to_itself_is_read(tmp_path: Path, write: Any, read: Any) -> None:
    schema = {"properties": {"S1": {"$ref": "#/$defs/a"}}, "$defs": {"a": {"$ref": "#/$defs/a"}}}
    recording = read(
        write(tmp_path / "a.mcap", [("/ai", T0 + k * STEP, {"S1": 20.0 + k}) for k in range(9)], schema=schema)
    )[0]
    assert {s.name: s.unit for s in recording.signals if "S1" in s.name} == {"/ai.S1": None}
