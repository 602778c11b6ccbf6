"""Answers go into the lines of a campaign file, and nothing else changes."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.channel import calibrate
from thermodata.calibration.static import evaluate_scale
from thermodata.draft.writing.fill_in import filled_in
from thermodata.draft.writing.questions import only_in_file, questions
from thermodata.errors import FormatError, SpecError, UsageError
from thermodata.schema.files.load import parse_campaign

TEXT = """\
# a head that stays
schema: thermodata/campaign/1
id: lab
machine:
  id: unknown   # ? the machine's number
sources:
  nc: {reader: cnc, files: "raw/{test}.csv"}   # ? timezone? local times
channels:
  T06: {source: nc, signal: "Temp, {6}", quantity: temperature, unit: degC}   # ? at: where on the machine?
  dZ: {source: nc, signal: Z, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: jump_Z}
calibrations:
  jump_Z: {kind: jump, axis: Z, source: nc, file: raw/jump.csv, signal: Z, moves: unknown, dwell: 12 s}   # ? moves
tests:   # ? role of each
  - {id: day1, kind: other, role: none}   # ? kind? e.g. spindle
"""
ANSWERS = {
    "machine.id": "M 12",
    "sources.nc.timezone": "Europe/Prague",
    "channels.T06.at": "spindle.bearing.front",
    "calibrations.jump_Z.moves": "100 um, -100 um",
    "tests.0.kind": "spindle",
    "tests.0.role": "calibration",
}


def test_each_question_has_its_place_and_its_choices() -> None:
    found = {q.name: q for q in questions(TEXT)}
    assert list(found) == list(ANSWERS)
    assert found["channels.T06.at"].kind == "place"
    assert "axis.*.nut" in found["channels.T06.at"].choices
    assert found["tests.0.role"].choices == ("calibration", "verification", "locked", "none")
    assert found["tests.0.role"].about == "day1"
    assert all(q.open for q in found.values() if q.name != "tests.0.kind")


def test_answers_change_their_own_lines_only() -> None:
    after = filled_in(TEXT, ANSWERS)
    assert '  id: "M 12"   # answered: the machine\'s number' in after
    assert 'files: "raw/{test}.csv", timezone: Europe/Prague}' in after
    assert 'signal: "Temp, {6}", quantity: temperature, unit: degC, at: spindle.bearing.front}' in after
    assert 'moves: [100 um, "-100 um"], dwell: 12 s}' in after
    assert "- {id: day1, kind: spindle, role: calibration}" in after
    changed = [(a, b) for a, b in zip(TEXT.splitlines(), after.splitlines(), strict=True) if a != b]
    assert len(changed) == 5
    assert not [q for q in questions(after) if q.open]


def test_no_answer_changes_nothing() -> None:
    assert filled_in(TEXT, {}) == TEXT
    assert filled_in(TEXT, {"machine.id": " ", "tests.0.role": "none"}) == TEXT


def test_an_answer_is_a_value_and_never_a_part_of_the_file() -> None:
    after = filled_in(TEXT, {"channels.T06.at": "a}, evil: {b: [c"})
    assert 'at: "a}, evil: {b: [c"}' in after
    assert [q.value for q in questions(after) if q.name == "channels.T06.at"] == ["a}, evil: {b: [c"]
    with pytest.raises(UsageError, match="one line"):
        filled_in(TEXT, {"machine.id": "a\nchannels: {}"})


def test_what_was_not_asked_and_what_does_not_load_is_refused() -> None:
    with pytest.raises(UsageError, match="no question"):
        filled_in(TEXT, {"id": "other"})
    with pytest.raises(SpecError):
        filled_in(TEXT, {"tests.0.role": "favourite"})
    with pytest.raises(SpecError):
        filled_in(TEXT, {"calibrations.jump_Z.moves": "a lot"})


def test_the_axis_of_a_probe_and_a_warm_start_are_answered() -> None:
    probe = "  ch1: {source: nc, signal: c1, quantity: displacement, unit: um, at: tcp}   # ? axis? (name and unit)\n"
    text = TEXT.replace("  dZ: {", f"{probe}  dZ: {{")
    text += "  - {id: day2, kind: mixed, role: none}   # ? start_state: warm? T06 begins 19.0 K further above the air\n"
    asked = {q.name: q for q in questions(text)}
    assert (asked["channels.ch1.axis"].kind, asked["channels.ch1.axis"].value) == ("axis", "")
    assert asked["channels.ch1.axis"].choices == ("X", "Y", "Z", "A", "B", "C")
    assert "channels.dZ.axis" not in asked
    assert asked["tests.1.start_state"].choices == ("balance", "warm", "on standby")
    assert asked["tests.1.start_state"].open
    assert "tests.0.start_state" not in asked
    after = filled_in(text, {"channels.ch1.axis": "Y", "tests.1.start_state": "warm", "tests.1.role": "verification"})
    campaign = parse_campaign(after)
    assert campaign.channels["ch1"].axis == "Y"
    assert (campaign.tests[1].start_state, campaign.tests[1].role) == ("warm", "verification")
    # answered, they can be answered otherwise
    again = {q.name: q for q in questions(after)}
    assert (again["channels.ch1.axis"].value, again["channels.ch1.axis"].open) == ("Y", False)
    assert (again["tests.1.start_state"].value, again["tests.1.start_state"].open) == ("warm", False)
    with pytest.raises(SpecError):
        filled_in(text, {"channels.ch1.axis": "Q"})


def test_the_sign_of_a_displacement_is_one_answer_and_becomes_a_calibration() -> None:
    asked_way = "# ? which way does it count? its sign is unknown until ... (name)"
    channels = [
        f"  Along: {{source: nc, signal: dz, quantity: displacement, unit: mm, axis: Z, at: tcp}}   {asked_way}",
        f"  Across: {{source: nc, signal: dy, quantity: displacement, unit: um, at: tcp}}   {asked_way}",
    ]
    text = TEXT.replace("  dZ: {", "\n".join(channels) + "\n  dZ: {")
    asked = {q.name: q for q in questions(text)}
    assert asked["channels.Along.sign"].choices == ("+Z, gap", "+Z, approach", "-Z, gap", "-Z, approach")
    assert len(asked["channels.Across.sign"].choices) == 12
    assert "channels.dZ.sign" not in asked
    after = filled_in(text, {"channels.Along.sign": "-Z, gap", "channels.Across.sign": "+Y, approach"})
    campaign = parse_campaign(after)
    assert campaign.channels["Along"].calibration == "sign_z"
    assert evaluate_scale("sign_z", campaign.calibrations["sign_z"]).gain == -1.0
    assert evaluate_scale("sign_z", campaign.calibrations["sign_z"]).gain_unit == "um/um"
    assert evaluate_scale("sign_y", campaign.calibrations["sign_y"]).gain == -1.0
    again = {q.name: q for q in questions(after)}
    assert (again["channels.Along.sign"].value, again["channels.Along.sign"].open) == ("-Z, gap", False)
    turned = parse_campaign(filled_in(after, {"channels.Along.sign": "+Z, gap"}))
    assert evaluate_scale("sign_z", turned.calibrations["sign_z"]).gain == 1.0
    assert set(turned.calibrations) == {"jump_Z", "sign_z", "sign_y"}
    with pytest.raises(UsageError, match="way that a displacement counts"):
        filled_in(text, {"channels.Along.sign": "+X, gap"})


def test_a_sign_needs_no_calibrations_before_it() -> None:
    without = "\n".join(x for x in TEXT.splitlines() if "alibration" not in x and "jump_Z" not in x) + "\n"
    line = "  Along: {source: nc, signal: dz, quantity: displacement, unit: um, axis: Z, at: tcp}"
    text = without.replace("channels:\n", f"channels:\n{line}   # ? which way does it count?\n")
    campaign = parse_campaign(filled_in(text, {"channels.Along.sign": "-Z, approach"}))
    assert evaluate_scale("sign_z", campaign.calibrations["sign_z"]).gain == 1.0


def test_what_a_jump_test_turns_already_is_asked_no_more() -> None:
    probe = "  Along: {source: nc, signal: dz, quantity: displacement, unit: um, axis: Z, at: tcp, calibration: jump_Z}"
    text = TEXT.replace("  dZ: {", f"{probe}   # ? which way does it count?\n  dZ: {{")
    assert "channels.Along.sign" not in {q.name for q in questions(text)}


def test_a_name_that_is_taken_is_no_name_for_a_sign() -> None:
    line = "  Along: {source: nc, signal: dz, quantity: displacement, unit: um, axis: Z, at: tcp}"
    taken = "".join(
        f"  {n}: {{kind: scale, axis: Z, gain: 2 um/V, facing: +Z, increases_with: gap}}\n"
        for n in ("sign_z", "sign_Along")
    )
    text = TEXT.replace("  dZ: {", f"{line}   # ? which way does it count?\n  dZ: {{")
    text = text.replace("calibrations:\n", f"calibrations:\n{taken}")
    campaign = parse_campaign(filled_in(text, {"channels.Along.sign": "-Z, gap"}))
    assert campaign.channels["Along"].calibration == "sign_Along_2"


@pytest.mark.parametrize(("unit", "reading", "um"), [("um", 30.0, -30.0), ("mm", 0.03, -30.0), ("mil", 1.0, -25.4)])
def test_a_sign_turns_a_displacement_in_any_length(unit: str, reading: float, um: float) -> None:
    line = f"  Along: {{source: nc, signal: dz, quantity: displacement, unit: {unit}, axis: Z, at: tcp}}"
    text = TEXT.replace("  dZ: {", f"{line}   # ? which way does it count?\n  dZ: {{")
    campaign = parse_campaign(filled_in(text, {"channels.Along.sign": "-Z, gap"}))
    turned = evaluate_scale("sign_z", campaign.calibrations["sign_z"])
    channel = campaign.channels["Along"]
    values, _ = calibrate(np.array([reading]), channel=channel, signal_unit=None, scaling=None, calibrations=[turned])
    assert values[0] == pytest.approx(um)
    assert all(c["passed"] for c in turned.checks)


SEVERAL = TEXT.replace(
    '  nc: {reader: cnc, files: "raw/{test}.csv"}   # ? timezone? local times\n',
    "  nc: {reader: table, files: hall.txt, table: {time: {format: unknown}}}   # ? format of the dates: dmy or mdy? "
    "04/05/2026 may be either; timezone? it logs local times, e.g. timezone: Europe/Prague; one log for many tests?\n",
)


def test_an_answer_ticks_off_its_own_question_and_no_other() -> None:
    after = filled_in(SEVERAL, {"sources.nc.timezone": "Europe/Prague"})
    line = after.splitlines()[6]
    assert "{time: {format: unknown}}, timezone: Europe/Prague}   # ? format of the dates: dmy or mdy? 04/05" in line
    assert line.endswith(
        "one log for many tests?; answered: timezone? it logs local times, e.g. timezone: Europe/Prague"
    )
    asked = {q.name: q for q in questions(after)}
    assert not asked["sources.nc.timezone"].open
    order = asked["sources.nc.table.time.format"]
    assert (order.open, order.value, order.choices) == (True, "", ("dmy", "mdy", "ymd"))
    assert order.hint == "format of the dates: dmy or mdy? 04/05/2026 may be either"
    both = filled_in(after, {"sources.nc.table.time.format": "dmy"}).splitlines()[6]
    assert "table: {time: {format: dmy}}" in both
    assert "# ? one log for many tests?; answered: timezone? it logs" in both


def test_what_no_field_answers_is_told_with_its_line() -> None:
    by_hand = SEVERAL.replace("one log for many tests?", "calibration? a jump test")
    assert [(q.line, q.asks) for q in only_in_file(by_hand)] == [(7, "calibration? a jump test")]
    assert only_in_file(TEXT) == []
    twice = TEXT.replace("kind? e.g. spindle", "kind? e.g. spindle; start: as list.csv says?; a door was open?")
    assert {q.name for q in questions(twice)} - {q.name for q in questions(TEXT)} == {"tests.0.start"}
    assert [q.asks for q in only_in_file(twice)] == ["a door was open?"]


def test_units_are_answered_and_then_the_sign_is_asked() -> None:
    asks = "# ? unit: um, mm, m or V? (values -36 to 1.2), calibration? a jump test, or kind: scale (name)"
    line = "  Along: {source: nc, signal: dz, quantity: displacement, axis: Z, at: tcp}"
    text = TEXT.replace("  dZ: {", f"{line}   {asks}\n  dZ: {{")
    asked = {q.name: q for q in questions(text)}
    assert asked["channels.Along.unit"].choices == ("um", "mm", "m", "V")
    assert "channels.Along.sign" not in asked
    after = filled_in(text, {"channels.Along.unit": "mm"})
    assert parse_campaign(after).channels["Along"].unit == "mm"
    assert "channels.Along.unit" in {q.name for q in questions(after)}, "it can be changed"
    assert {q.name for q in questions(after) if q.open} >= {"channels.Along.sign"}
    turned = filled_in(after, {"channels.Along.sign": "+Z, gap"})
    assert "# answered: unit: um, mm" in turned
    assert only_in_file(turned) == []
    assert "channels.Along.sign" not in {q.name for q in questions(filled_in(text, {"channels.Along.unit": "V"}))}


def test_the_unit_of_a_time_is_answered_and_one_that_is_none_refused() -> None:
    text = TEXT.replace(
        '{reader: cnc, files: "raw/{test}.csv"}   # ? timezone? local times',
        '{reader: table, files: "raw/{test}.csv", table: {time: {column: t, unit: unknown}}}   # ? unit of the time: '
        "s, min, h or ms? 't' runs from 0 in steps of 1",
    )
    assert {q.name: q.kind for q in questions(text)}["sources.nc.table.time.unit"] == "time"
    assert "{column: t, unit: min}}}   # answered: unit" in filled_in(text, {"sources.nc.table.time.unit": "min"})
    with pytest.raises(FormatError, match="unknown unit of time"):
        filled_in(text, {"sources.nc.table.time.unit": "parsecs"})


def test_a_guess_that_is_right_is_ticked_off_as_it_stands() -> None:
    text = TEXT.replace("degC}   # ? at: where on the machine?", "degC, at: rotary.b}   # ? at: rotary.b or table?")
    asked = {q.name: q for q in questions(text)}["channels.T06.at"]
    assert (asked.open, asked.asks, asked.value) == (True, True, "rotary.b")
    after = filled_in(text, {"channels.T06.at": "rotary.b"})
    assert "at: rotary.b}   # answered: at: rotary.b or table?" in after
    assert not {q.name: q for q in questions(after)}["channels.T06.at"].open


@pytest.mark.parametrize(
    "asks",
    [
        "one log for many tests?",
        "one log for many tests, in parts?",
        "each file is of the tests that ran during it?",
    ],
)
def test_whose_a_log_is_is_answered_as_it_stands_or_by_other_files(asks: str) -> None:
    text = SEVERAL.replace("one log for many tests?", asks)
    assert only_in_file(text) == []
    asked = {q.name: q for q in questions(text)}["sources.nc.files"]
    assert (asked.value, asked.open, asked.asks, asked.hint) == ("hall.txt", True, True, asks)
    after = filled_in(text, {"sources.nc.files": "hall.txt"})
    assert f"answered: {asks}" in after
    assert not {q.name: q for q in questions(after)}["sources.nc.files"].open
    assert 'files: "{test}_hall.txt"' in filled_in(text, {"sources.nc.files": "{test}_hall.txt"})


def test_moves_without_a_unit_are_micrometres_and_parts_of_one_are_refused() -> None:
    after = filled_in(TEXT, {"calibrations.jump_Z.moves": "100, -100, +50 um"})
    assert 'moves: [100 um, "-100 um", "+50 um"]' in after
    with pytest.raises(SpecError):
        filled_in(TEXT, {"calibrations.jump_Z.moves": "0.1, -0.1"})


def test_the_hint_to_the_role_of_a_test_names_its_kind() -> None:
    text = TEXT.replace("# ? kind? e.g. spindle", "# kind sure: name and data")
    assert {q.name: q for q in questions(text)}["tests.0.role"].hint == "kind other, sure: name and data"


START = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m}
sources:
  nc: {reader: cnc, files: "raw/{test}.csv", timezone: UTC}
channels:
  dZ: {source: nc, signal: Z, quantity: displacement, unit: um, axis: Z}   # ? at: where on the machine?
  T06: {source: nc, signal: T, quantity: temperature, unit: degC}   # ? at: where on the machine?
  dY: {source: nc, signal: Y, quantity: displacement, unit: um, axis: "Y", relative_to: bed}   # ? at: where?
tests:   # ? role of each
  - {id: day1, kind: other, role: none}   # ? start_state: warm? T begins 4 K above
  - {id: day2, kind: other, role: none, notes: "cold hall"}   # ? start_state: warm? T begins 4 K above
"""


def test_a_displacement_of_the_tool_is_read_against_the_table() -> None:
    text = filled_in(START, {"channels.dZ.at": "tcp", "channels.T06.at": "tcp", "channels.dY.at": "tcp"})
    channels = parse_campaign(text).channels
    assert (channels["dZ"].at, channels["dZ"].relative_to) == ("tcp", "table")
    assert channels["T06"].relative_to is None
    assert channels["dY"].relative_to == "bed"
    assert parse_campaign(filled_in(START, {"channels.dZ.at": "stator"})).channels["dZ"].relative_to is None


def test_on_standby_is_a_balance_of_which_the_notes_tell() -> None:
    asked = next(q for q in questions(START) if q.name == "tests.0.start_state")
    assert asked.choices == ("balance", "warm", "on standby")
    said = {f"tests.{k}.start_state": "on standby" for k in (0, 1)}
    text = filled_in(START, said)
    first, second = parse_campaign(text).tests
    assert (first.start_state, second.start_state) == ("balance", "balance")
    assert first.notes == "began on standby: control and hydraulics on, axes still"
    assert second.notes == "cold hall; began on standby: control and hydraulics on, axes still"
    assert "# answered: start_state" in text
    assert filled_in(text, {"tests.0.start_state": "on standby"}) == text
    warm = parse_campaign(filled_in(START, {"tests.0.start_state": "warm"})).tests[0]
    assert (warm.start_state, warm.notes) == ("warm", "")
