"""sensors.yaml, .json or .csv beside the logs: what it says of signals is guessed by, and is said to be from there."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.make import draft_files

ENTRIES = {
    "T01": {"place": "spindle bearing, front", "quantity": "temperature", "unit": "degC"},
    "T02": {"place": "machine bed", "quantity": "temperature", "unit": "degC"},
}
MAPPING = """\
# measured in 2026
T01: {place: "spindle bearing, front", quantity: temperature, unit: degC}
T02: {place: machine bed, quantity: temperature, unit: degC}
"""
GROUPS = "sensors:\n  temperatures:\n" + "".join(f"    {line}\n" for line in MAPPING.splitlines())
LIST = """\
---
- name: T01
  location: spindle bearing, front
  type: temperature
  units: degC
- name: T02
  location: machine bed
  units: degC
"""
PLAIN = "T01: spindle bearing front [degC]\nT02: machine bed [degC]\n"
GERMAN = """\
Kanäle:
  - {Kanal: T01, Messstelle: Spindellager vorn, Einheit: degC}
  - {Kanal: T02, Messstelle: Maschinenbett, Einheit: degC}
"""
TABLE = "channel,place,quantity,unit\nT01,spindle bearing front,temperature,degC\nT02,machine bed,temperature,degC\n"


def drafted(
    folder: Path, name: str, text: str
) -> tuple[dict[str, DraftChannel], list[tuple[str, str]], tuple[str, ...]]:
    for day in (2, 3):
        rows = [f"2026-03-0{day} 08:{k:02d}:00;{21 + k / 20:.2f};{20 + k / 50:.2f}" for k in range(60)]
        (folder / f"t{day}.csv").write_text("\n".join(["Zeit;T01;T02", *rows, ""]))
    (folder / name).write_text(text, encoding="utf-8")
    draft = draft_files(folder).draft
    return {c.signal: c for c in draft.channels}, list(draft.not_used), draft.notes


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("sensors.yaml", MAPPING),
        ("sensors.yml", GROUPS),
        ("sensors.yaml", LIST),
        ("logger.yaml", PLAIN),
        ("Kanaele.yaml", GERMAN),
        ("sensors.json", json.dumps(ENTRIES)),
        ("channels.json", json.dumps({"sensors": [{"id": k, **v} for k, v in ENTRIES.items()]})),
        ("sensors.json", json.dumps([{"name": k, **v} for k, v in ENTRIES.items()], indent=1)),
        ("sensors.csv", TABLE),
    ],
)
def test_what_it_says_of_signals_is_guessed_by(tmp_path: Path, name: str, text: str) -> None:
    channels, not_used, notes = drafted(tmp_path, name, text)
    assert {s: (c.said.quantity, c.said.at, c.said.unit) for s, c in channels.items()} == {
        "T01": ("temperature", "spindle.bearing.front", "degC"),
        "T02": ("temperature", "bed", "degC"),
    }
    assert all(f"in {name}" in (c.note or "") and not c.said.sure for c in channels.values())
    assert not not_used
    assert any(n.startswith(f"{name} says what signals are: T01 is '") for n in notes)


@pytest.mark.parametrize(
    "text",
    [
        "a: 1\nb: [2, 3]\n",
        "T9: {place: bed, unit: degC}\n",  # of another campaign
        "T01: {place: bed\n",  # broken
        "T01: 4\nT02: 5\n",
        "T01: {serial: A4711, card: 2}\n",
        "a: &a [x, x]\nb: &b [*a, *a]\nT01: *b\n",
        f"{'[' * 5000}",
    ],
)
def test_what_it_does_not_say_or_cannot_be_read_is_told_as_settings(tmp_path: Path, text: str) -> None:
    channels, not_used, _ = drafted(tmp_path, "sensors.yaml", text)
    assert all(c.said.at is None for c in channels.values())
    assert [path for path, why in not_used if "settings, which nothing reads" in why] == ["sensors.yaml"]


@pytest.mark.parametrize("axis", ["+", "XY", "north"])
def test_what_is_no_letter_of_an_axis_names_none(tmp_path: Path, axis: str) -> None:
    text = f"T02: {{label: eddy probe at the tool, unit: um, axis: '{axis}'}}\n"
    channels, _, _ = drafted(tmp_path, "sensors.yaml", text)
    assert channels["T02"].said.axis is None


def test_a_displacement_has_its_axis_and_two_entries_of_one_name_say_nothing(tmp_path: Path) -> None:
    text = "daq/T01: {place: bed}\nnc/T01: {place: column}\nT02: {label: eddy probe at the tool, unit: um, axis: +Z}\n"
    channels, _, _ = drafted(tmp_path, "sensors.yaml", text)
    assert channels["T01"].said.at is None
    assert (channels["T02"].said.quantity, channels["T02"].said.axis) == ("displacement", "Z")
