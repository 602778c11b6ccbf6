"""Recordings of SINUMERIK Edge in JSON: rows of the cycle, values on change, and damage within one long line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.sinumerik import capture_parts

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.times.zone import NO_ZONE
from thermodata.testing.reader import load, reader_checks

START_NS = int(np.datetime64("2026-03-02T08:00:00.125", "ns").astype(np.int64))
ADDRESS = "/Channel/State/actFeedRateIpo[u1]"


def signal(name: str, axis: str = "Cycle", number: int | None = None) -> dict[str, str]:
    address = name if number is None else f"{name}|{number}"
    return {"Name": name, "Type": "DOUBLE", "Axis": axis, "Address": address}


def document(messages: int = 12, **header: Any) -> dict[str, Any]:
    """A message of ten rows, one of a stamp and one of a value on change, each so often."""
    payload: list[dict[str, Any]] = []
    for k in range(messages):
        first = 1000 + 10 * k
        payload.append({"HFTimestamp": {"Time": "2026-03-02T08:00:00.125Z", "HFProbeCounter": first}})
        payload.append({"HFData": [[first + i, k + i / 10, -k, 0.5] for i in range(10)]})
        changed = {"address": ADDRESS, "timestamp": f"2026-03-02T08:00:{k:02d}.5Z", "HfProbeCounter": first}
        payload.append({"LFData": [changed | {"value": k * 1.5}]})
    listed = [signal("CYCLE"), signal("CURRENT", "X", 1), signal("CURRENT", "Y", 2), signal("CMD_SPEED", "SP1", 6)]
    initial = {"Time": "2026-03-02T08:00:00.125Z", "HFProbeCounter": 1000}
    head = {"Initial": initial, "CycleTimeMs": "2", "SignalListHFData": listed} | header
    return {"Header": {k: v for k, v in head.items() if v is not None}, "Payload": payload, "Footer": {"End": 1}}


def written(folder: Path, text: str, name: str = "edge.json") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("indent", [None, 1])
@pytest.mark.parametrize("piece", [97, 1 << 20])
def test_rows_of_the_cycle_and_values_on_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, indent: int | None, piece: int
) -> None:
    monkeypatch.setattr(capture_parts, "PIECE", piece)
    data = load(Reader(), written(tmp_path, json.dumps(document(), indent=indent)), Source())
    assert [(s.stream, s.name, s.held) for s in data.recording.signals] == [
        ("hf", "CURRENT/X", False),
        ("hf", "CURRENT/Y", False),
        ("hf", "CMD_SPEED", False),
        ("nc", ADDRESS, True),
    ]
    assert data.recording.signals[0].properties == {"Axis": "X", "Address": "CURRENT|1", "Type": "DOUBLE"}
    assert data.t_ns["hf"].tolist() == [START_NS + 2_000_000 * k for k in range(120)]
    assert data.values["hf", "CURRENT/X"].tolist()[:3] == [0.0, 0.1, 0.2]
    assert data.values["hf", "CURRENT/Y"][-1] == -11.0
    assert data.values["nc", ADDRESS].tolist() == [k * 1.5 for k in range(12)]
    assert not data.losses
    assert Reader().locate(tmp_path / "edge.json", Source(), "hf", 15) == "cycle 1015"


def test_the_first_stamp_dates_cycles_where_the_header_does_not(tmp_path: Path) -> None:
    data = load(Reader(), written(tmp_path, json.dumps(document(Initial=None))), Source())
    assert data.t_ns["hf"][0] == START_NS


@pytest.mark.parametrize(
    "header", [{"CycleTimeMs": None}, {"CycleTimeMs": "0"}, {"Initial": {"Time": "yesterday", "HFProbeCounter": 1}}]
)
def test_a_recording_whose_cycles_nothing_dates_is_refused(tmp_path: Path, header: dict[str, Any]) -> None:
    path = written(tmp_path, json.dumps(document(**header)))
    with pytest.raises(FormatError, match="nothing says when a cycle was"):
        load(Reader(), path, Source())


def test_a_file_that_is_cut_gives_what_stands_before(tmp_path: Path) -> None:
    text = json.dumps(document())
    data = load(Reader(), written(tmp_path, text[: text.index('"HFData"', len(text) // 2) + 40]), Source())
    assert 40 < len(data.t_ns["hf"]) < 80
    assert len(data.losses) == 1


def test_reading_goes_on_behind_a_message_that_is_damaged(tmp_path: Path) -> None:
    text = json.dumps(document())
    at = text.index('{"HFData"', len(text) // 2)
    data = load(Reader(), written(tmp_path, f"{text[: at + 20]}]#@{text[at + 26 :]}"), Source())
    assert len(data.t_ns["hf"]) == 110
    assert len(data.values["nc", ADDRESS]) == 12
    (loss,) = data.losses
    assert "letters that are no message" in loss.reason


def test_rows_of_another_width_and_unknown_messages_are_told(tmp_path: Path) -> None:
    made = document()
    made["Payload"][1]["HFData"][3] = [1003, 1.0]
    made["Payload"][1]["HFData"][4][0] = "x"
    made["Payload"].append({"ExternalData": [1, 2]})
    data = load(Reader(), written(tmp_path, json.dumps(made)), Source())
    assert len(data.t_ns["hf"]) == 118
    assert [loss.reason.split(" ")[0] for loss in data.losses] == ["2", "messages"]


@pytest.mark.parametrize(
    "header",
    [
        {"SignalListHFData": 7},
        {"SignalListHFData": [signal("A", "X", 1)] * 2},
        {"SignalListHFData": [signal(f"A{k}") for k in range(3000)]},
        {"Initial": [1], "CycleTimeMs": 1e300},
    ],
)
def test_a_hostile_header_is_refused_or_told(tmp_path: Path, header: dict[str, Any]) -> None:
    path = written(tmp_path, json.dumps(document(**header)))
    try:
        data = load(Reader(), path, Source())
    except FormatError:
        return
    assert data.losses


def test_brackets_without_end_are_no_message(tmp_path: Path) -> None:
    text = json.dumps(document())
    at = text.index('{"HFData"', len(text) // 2)
    data = load(Reader(), written(tmp_path, text[:at] + "[" * 50_000 + text[at:]), Source())
    assert len(data.t_ns["hf"]) == 120
    assert len(data.losses) == 1


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
def test_kit(tmp_path: Path, number: int) -> None:
    reader_checks(Reader, [(written(tmp_path, json.dumps(document(40)) + "\n"), Source())])[number]()


@pytest.mark.parametrize("changes", [True, False])
@pytest.mark.parametrize(
    ("start", "zone", "open_"),
    [
        ("2026-03-02T09:00:00.125", None, True),
        ("2026-03-02 09:00:00,125", None, True),
        ("2026-03-02T09:00:00.125", "Europe/Prague", False),
        ("2026-03-02T08:00:00.125Z", None, False),
        ("2026-03-02T09:00:00.125+01:00", None, False),
    ],
)
def test_a_start_without_a_zone_says_so(
    tmp_path: Path, start: str, zone: str | None, open_: bool, changes: bool
) -> None:
    """Whether values on change say theirs or there are none: the rows of the cycle count from this start."""
    told = document(Initial={"Time": start, "HFProbeCounter": 1000})
    if not changes:
        told["Payload"] = [m for m in told["Payload"] if "LFData" not in m]
    recording = Reader().describe(written(tmp_path, json.dumps(told)), Source(timezone=zone))
    assert any(NO_ZONE in note for note in recording.notes) == open_
    expected = START_NS + (3600 * 10**9 if open_ else 0)
    assert recording.start_ns == expected


def test_a_first_stamp_without_a_zone_says_so_where_the_header_says_no_start(tmp_path: Path) -> None:
    text = json.dumps(document(Initial=None)).replace("08:00:00.125Z", "08:00:00.125")
    recording = Reader().describe(written(tmp_path, text), Source())
    assert any(NO_ZONE in note for note in recording.notes)
