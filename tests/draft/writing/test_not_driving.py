"""A first model says of every logged channel that could drive it and does not, why."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.commands import Say
from thermodata.draft.writing.baseline import left_out_of, model_text_of
from thermodata.schema.files.campaign import Campaign

_TEMPERATURES = {
    "T_front": "spindle.bearing.front",
    "T_rear": "spindle.bearing.rear",
    "T_gearbox": "spindle.gearbox",
    "T_beam_top": "crossbeam.top",
    "T_beam_bottom": "crossbeam.bottom",
    "T_turret": "turret",
    "T_counter": "counter_spindle.bearing.front",
    "T_air": "hall",
    "T_nut_Y": "axis.y.nut",
    "T_odd": "chip.conveyor",
    "T_motor": "spindle.motor",
}


def _campaign() -> Campaign:
    channels: dict[str, Any] = {n: {"quantity": "temperature", "at": at} for n, at in _TEMPERATURES.items()}
    channels["T_where"] = {"quantity": "temperature"}
    channels["P"] = {"quantity": "power", "at": "spindle"}
    channels["door"] = {"quantity": "state", "at": "hall.door"}
    channels["remark"] = {"quantity": "label"}
    channels["dZ"] = {"quantity": "displacement", "axis": "Z", "at": "tcp", "relative_to": "table"}
    return Campaign.model_validate(
        {
            "schema": "thermodata/campaign/1",
            "id": "c",
            "machine": {"id": "m"},
            "sources": {"s": {"reader": "table", "files": "{test}.csv"}},
            "channels": {n: {"source": "s", "signal": n, **c} for n, c in channels.items()},
            "tests": [{"id": "t", "kind": "etve", "role": "calibration"}],
        }
    )


@pytest.mark.parametrize(
    ("channel", "why"),
    [
        ("T_gearbox", "left to thermodata diagnose, which tries spindle_gearbox"),
        ("T_beam_top", "left to thermodata diagnose, which tries crossbeam_bending"),
        ("T_turret", "left to thermodata diagnose, which tries turret_heat"),
        ("P", "left to thermodata diagnose, which tries cutting_power"),
        ("T_counter", "another sensor drives spindle_bearing"),
        ("T_rear", "another sensor drives spindle_bearing"),
        ("T_motor", "the line of spindle_motor above has it"),
        ("T_nut_Y", "on another axis than the response's, Z: thermodata diagnose tries feed_screw"),
        (
            "T_odd",
            "no effect takes temperature at chip.conveyor by its place: write {effect: lag",
        ),
        ("door", "no effect takes state at hall.door"),
        ("T_where", "has no place: answer its 'at'"),
    ],
)
def test_what_drives_nothing_is_said_with_why(channel: str, why: str) -> None:
    (line,) = [x for x in (model_text_of(_campaign()) or "").splitlines() if x.startswith(f"#   {channel}: ")]
    assert why in line


def test_what_drives_an_effect_or_can_drive_none_is_not_told() -> None:
    campaign = _campaign()
    left_out = left_out_of(campaign, "dZ")
    assert set(campaign.channels) - set(left_out) == {"T_front", "T_air", "dZ", "remark"}


def test_the_command_names_them(tmp_path: Path, say: Say) -> None:
    path = tmp_path / "campaign.yaml"
    path.write_text(
        "schema: thermodata/campaign/1\nid: c\nmachine: {id: m}\n"
        'sources: {s: {reader: table, files: "{test}.csv"}}\n'
        "channels:\n"
        "  dZ: {source: s, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp, relative_to: table}\n"
        "  T_air: {source: s, signal: a, quantity: temperature, unit: degC, at: hall}\n"
        "  T_turret: {source: s, signal: t, quantity: temperature, unit: degC, at: turret}\n"
        "tests: [{id: t, kind: etve, role: calibration}]\n",
        encoding="utf-8",
    )
    said = say("first-model", path)
    assert said.code == 0
    assert "logged, and driving nothing in it: T_turret; the end of model.yaml says why" in said.err
    path.write_text(path.read_text("utf-8").replace("at: turret", "at: axis.z.nut"), encoding="utf-8")
    assert "driving nothing" not in say("first-model", path).err
