"""Values and keys of a campaign file that are no good: what is wrong, where, and what would be right."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.load import parse_campaign, parse_model

TEXT = """schema: thermodata/campaign/1
id: full
machine: {id: m, spindle: SP1, axes: {Y: {feedback: scale}}}
sources:
  daq: {reader: table, files: "raw/{test}.csv"}
  nc: {reader: table, files: "raw/{test}_nc.csv", clock: {offset: -37 s}}
channels:
  dZ: {source: daq, signal: Z, quantity: displacement, unit: V, axis: Z, at: tcp, relative_to: table, calibration: jump,
       sensor: {serial: "4", range: [0 V, 20 V], colour: red}}
  n: {schedule: [[0 h, conditions.speed], [4 h, 0 rpm]], quantity: rotational_speed}
calibrations:
  jump: {kind: jump, axis: Z, source: daq, file: j.csv, signal: Z, moves: [100 um, -100 um]}
  t03: {kind: linear, gain: 1, offset: -0.12 K}
tests:
  - {id: a, kind: spindle, conditions: {speed: 3000 rpm}, pose: {x: 100 mm, door: open}, zero: {over: 10 min}}
  - {id: b, kind: etve, phases: {idle: [0 h, 6 h]}, tool: {id: T1, length: 120 mm, length_2: 3 K, flutes: 4}}
  - {id: c, kind: etve, window: [0 h, 5 h], repeat_of: a, machine: {spindle: SP2, motor: M}, notes: a night}
"""


def refused(right: str, wrong: str) -> SpecError:
    assert right in TEXT
    with pytest.raises(SpecError) as caught:
        parse_campaign(TEXT.replace(right, wrong, 1), "c.yaml")
    return caught.value


def test_what_is_right_is_taken() -> None:
    campaign = parse_campaign(TEXT)
    assert campaign.tests[1].tool is not None
    assert campaign.tests[1].tool.model_extra == {"length_2": "3 K", "flutes": 4}


@pytest.mark.parametrize(
    ("right", "wrong", "where", "expected", "said"),
    [
        ("offset: -0.12 K", "offset: abc K", "calibrations.t03.offset", "10 s", "abc K"),
        ("offset: -0.12 K", "offset: nan K", "calibrations.t03.offset", "10 s", "nan K"),
        ("kind: jump", "kind: jmp", "calibrations.jump.kind", "jump, scale, linear", "did you mean 'jump'"),
        ("kind: linear, ", "", "calibrations.t03", "calibrations.t03.kind: ...", "'kind' is missing"),
        ("conditions: {speed: 3000 rpm}", "conditions: 9 rpm", "tests[0].conditions", "{key: value}", "no mapping"),
        ("pose: {x: 100 mm, door: open}", "pose: hello", "tests[0].pose", "{key: value}", "no mapping"),
        ("zero: {over: 10 min}", "zero: 10 min", "tests[0].zero", "{over: ...}", "no mapping"),
        ("machine: {spindle: SP2, motor: M}", "machine: SP2", "tests[2].machine", "{key: value}", "no mapping"),
        ("notes: a night", "notes: [1]", "tests[2].notes", "a text", "[1]"),
        ("offset: -37 s", "offset: -37", "sources.nc.clock.offset", "of the kind of s", "write '-37 s'"),
        ("offset: -37 s", "offset: -37 um", "sources.nc.clock.offset", "same kind as s", "write '-37 s'"),
        ("over: 10 min", "over: 10", "tests[0].zero.over", "of the kind of s", "write '10 s'"),
        ("moves: [100 um", "moves: [100 K", "calibrations.jump.moves[0]", "same kind as um", "write '100 um'"),
        ("idle: [0 h, 6 h]", "idle: [0 h]", "tests[1].phases.idle", "2 values", "too few"),
        ("idle: [0 h, 6 h]", "idle: []", "tests[1].phases.idle", "2 values", "too few"),
        ("idle: [0 h, 6 h]", "idle: [0 h, 1 h, 2 h]", "tests[1].phases.idle", "2 values", "too many values"),
        ("notes: a night", "notes: [1]", "tests[2].notes", "a text", "'notes': no text"),
        ("clock: {offset: -37 s}", "clock: {align_to: nc}", "sources.nc.clock.align_to", "daq", "itself"),
        ("id: full", "id: full 2026/x", "id", "letters, digits", "full 2026/x"),
        ("id: a,", "id: a/b,", "tests[0].id", "without /", "a/b"),
        # what was taken without a word
        ("length: 120 mm", "lenght: 120 mm", "tests[1].tool.lenght", "length", "did you mean 'length'"),
        ("length: 120 mm", "length: 120 K", "tests[1].tool.length", "mm", "120 K"),
        ("length: 120 mm", "length: long", "tests[1].tool.length", "10 s", "long"),
        ("range: [0", "rnage: [0", "channels.dZ.sensor.rnage", "range", "did you mean 'range'"),
        ('serial: "4"', 'seriall: "4"', "channels.dZ.sensor.seriall", "serial", "did you mean 'serial'"),
        ("range: [0 V, 20 V]", "range: [20 V, 0 V]", "channels.dZ.sensor.range", "low < high", "[20 V, 0 V]"),
        ("range: [0 V, 20 V]", "range: [0 K, 20 K]", "channels.dZ.sensor.range", "V or um", "0 K"),
        ("feedback:", "feedbak:", "machine.axes.Y.feedbak", "feedback", "did you mean 'feedback'"),
        ("spindle: SP2", "spindel: SP2", "tests[2].machine.spindel", "spindle", "did you mean 'spindle'"),
        ("x: 100 mm", "x: 100 kg", "tests[0].pose.x", "mm or deg", "100 kg"),
        ("idle: [0 h, 6 h]", "idle: [6 h, 0 h]", "tests[1].phases.idle", "from < to", "21600"),
        ("[[0 h, conditions.speed], [4 h, 0 rpm]]", "[]", "channels.n.schedule", "[[0 h", "without a value"),
        ("[4 h, 0 rpm]", "[0 h, 0 rpm]", "channels.n.schedule[1]", "increase", "0 h"),
        ("[4 h, 0 rpm]", "[4 K, 0 rpm]", "channels.n.schedule[1]", "kind as s", "4 K"),
        ("repeat_of: a", "repeat_of: c", "tests[2].repeat_of", "a, b", "c"),
        ("repeat_of: a", "zero: {over: 6 h}", "tests[2].zero.over", "18000 s", "21600 s"),
        ("at: tcp", "at: 17", "channels.dZ.at", "dotted place", "17"),
        ("relative_to: table", "relative_to: 5", "channels.dZ.relative_to", "dotted place", "5"),
        ('files: "raw/{test}.csv"', "files: 17", "sources.daq.files", "a path", "17"),
        ('files: "raw/{test}.csv"', 'files: "raw/{tset}.csv"', "sources.daq.files", "{test}", "{tset}"),
    ],
)
def test_what_is_wrong_is_refused_with_what_would_be_right(
    right: str, wrong: str, where: str, expected: str, said: str
) -> None:
    error = refused(right, wrong)
    assert (error.where or "").startswith("c.yaml:")
    assert f"({where})" in (error.where or "")
    assert expected in (error.expected or "")
    assert said in str(error)
    assert error.got or "missing" in error.what
    assert "Input" not in str(error), "not in the words of the library that reads it"
    assert "declare the channel" not in str(error)


def test_braces_that_stand_in_a_name_of_a_file_are_no_field(tmp_path: Path) -> None:
    from thermodata.schema.files.load import load_campaign

    path = tmp_path / "c.yaml"
    path.write_text(TEXT.replace("raw/{test}.csv", "log_{A}.csv"))
    with pytest.raises(SpecError, match="nothing fills"):
        load_campaign(path)
    (tmp_path / "log_{A}.csv").touch()
    load_campaign(path)


@pytest.mark.parametrize(
    ("wrong", "where", "expected"),
    [
        ("effects:", "effects", "a list"),
        ("effects: [{effect: transfer_function, orders: [2]}]", "effects[0].orders", "2 values"),
        ("step: 30", "step", "of the kind of s"),
        ("campaigns: []", "campaigns", "campaigns: [ID, ID]"),
        ("campaign: [a, b]", "campaign", "campaigns: [ID, ID]"),
        ("response: {axis: Z, channel: dZ}", "response", "{axis: Z, at: tcp} or {channel: name}"),
        ("response: []", "response", "{axis: Z, at: tcp}"),
    ],
)
def test_a_model_file_says_what_it_expects(wrong: str, where: str, expected: str) -> None:
    lines = {
        "schema": "schema: thermodata/model/1",
        "name": "name: m",
        "campaign": "campaign: c",
        "response": "response: {axis: Z, at: tcp}",
        "effects": "effects: []",
        wrong.partition(":")[0]: wrong,
    }
    if "campaigns" in lines:
        del lines["campaign"]
    with pytest.raises(SpecError) as caught:
        parse_model("\n".join(lines.values()) + "\n", "m.yaml")
    assert f"({where})" in (caught.value.where or "")
    assert expected in (caught.value.expected or "")


@pytest.mark.parametrize(
    ("more", "written_by_the_program"),
    [("in_sampl: true", {"in_sample", "taken_back"}), ("effects: [{x: 1}]", {"inside"})],
)
def test_keys_that_only_the_program_writes_are_read_and_never_offered(
    more: str, written_by_the_program: set[str]
) -> None:
    model = "schema: thermodata/model/1\nname: m\ncampaign: c\nresponse: {axis: Z, at: tcp}\n"
    with pytest.raises(SpecError) as caught:
        parse_model(model + more)
    offered = str(caught.value.expected).removeprefix("one of ").split(", ")
    assert {"effect", "effects"} & set(offered)
    assert not written_by_the_program & {*offered, *str(caught.value.hint).split("'")}
    assert parse_model(f"{model}in_sample: true\ntaken_back: abc\neffects: [{{effect: model, inside: {{}}}}]").in_sample
