"""Numbers that nothing of a machine has, and responses that say too little, are refused with what would be right."""

from __future__ import annotations

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import parse_campaign, parse_model
from thermodata.schema.strict.declared import STORED

TEXT = """
schema: thermodata/campaign/1
id: c
machine: {id: m, ATTRIBUTE}
sources: {log: {reader: table, files: a.csv}}
channels:
  dZ: {source: log, signal: z, quantity: displacement, unit: um, axis: Z, sensor: {resolution: RESOLUTION}}
calibrations:
  j: {kind: jump, axis: Z, source: log, file: j.csv, signal: z, moves: [10 um], dwell: DWELL, move_uncertainty: UNSURE}
tests:
  - {id: a, conditions: {speed: SPEED}, tool: {length: LENGTH, diameter: 10 mm}, zero: {over: ZERO},
     measuring: {when: dZ > 0, settle: SETTLE}}
"""
RIGHT = {
    "ATTRIBUTE": "mass: 4.5",
    "RESOLUTION": "0.1 um",
    "DWELL": "10 s",
    "UNSURE": "0 um",
    "SPEED": "9000 rpm",
    "LENGTH": "120 mm",
    "ZERO": "1 s",
    "SETTLE": "0 s",
}


def campaign(**other: str) -> Campaign:
    text = TEXT
    for word, value in {**RIGHT, **other}.items():
        text = text.replace(word, value)
    return parse_campaign(text, "c.yaml")


@pytest.mark.parametrize("number", [".nan", ".inf", "-.inf", "1.0e+999"])
@pytest.mark.parametrize(("word", "place"), [("SPEED", "tests.0.conditions.speed"), ("ATTRIBUTE", "machine.mass")])
def test_what_is_no_number_is_refused_where_it_stands(word: str, place: str, number: str) -> None:
    with pytest.raises(SpecError, match="not a number that a machine can have") as told:
        campaign(**{word: number if word == "SPEED" else f"mass: {number}"})
    assert place in told.value.what
    assert told.value.got == number
    assert str(told.value.where).startswith("c.yaml:")


@pytest.mark.parametrize(
    ("word", "wrong", "right"),
    [
        ("LENGTH", "-120 mm", "0 mm"),
        ("LENGTH", "-120", "0"),
        ("ZERO", "0 min", "0.1 s"),
        ("ZERO", "-1 s", "0.1 s"),
        ("DWELL", "0 s", "0.1 s"),
        ("UNSURE", "-1 um", "0 um"),
        ("RESOLUTION", "-0.1 um", "0 um"),
        ("SETTLE", "-1 s", "0 s"),
    ],
)
def test_a_size_that_cannot_be_is_refused(word: str, wrong: str, right: str) -> None:
    with pytest.raises(SpecError, match="a number that can't be") as told:
        campaign(**{word: wrong})
    assert told.value.expected in ("0 or more", "more than 0")
    campaign(**{word: right})


def test_what_a_store_holds_already_is_read() -> None:
    """A store of an earlier version may hold what is refused now."""
    stored = (
        campaign().model_dump_json(by_alias=True).replace('"120 mm"', '"-120 mm"').replace('"over":1.0', '"over":0.0')
    )
    assert '"over":0.0' in stored
    assert Campaign.model_validate_json(stored, context=STORED).tests[0].zero.over == 0.0


def model(response: str) -> object:
    return parse_model(
        f"schema: thermodata/model/1\nname: m\ncampaign: c\nresponse: {response}\neffects: []\n"
    ).response


@pytest.mark.parametrize(
    ("response", "meant"),
    [
        ("dZ", "response: {channel: dZ}"),
        ("[dZ, dX]", "response: [{channel: dZ}, {channel: dX}]"),
        ("[{axis: Z, at: tcp}, dX]", "response: [{axis: Z, at: tcp}, {channel: dX}]"),
    ],
)
def test_a_response_by_a_name_alone_is_answered_with_the_right_form(response: str, meant: str) -> None:
    with pytest.raises(SpecError) as told:
        model(response)
    assert told.value.hint == meant
    assert told.value.expected == "{axis: Z, at: tcp} or {channel: name}, or a list of such"
    assert model(meant.removeprefix("response: "))


@pytest.mark.parametrize("response", ["[dZ, 5]", "[dZ, null]", "[dZ, [dX]]", "5"])
def test_what_is_no_response_at_all_is_refused_beside_a_name_too(response: str) -> None:
    with pytest.raises(SpecError, match="no mapping"):
        model(response)


@pytest.mark.parametrize("name", ["T", "t", "Test", "T_S"])
def test_a_reserved_name_is_refused_in_any_case_and_the_answer_says_so(name: str) -> None:
    with pytest.raises(SpecError, match=f"no name for a channel: '{name}'") as told:
        campaign(**{"  dZ:": f"  {name}:"})
    assert "in capital letters or small" in str(told.value.expected)
