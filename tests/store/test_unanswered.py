"""What a campaign file leaves open is told with every ingest."""

from __future__ import annotations

import pytest

from thermodata.schema.files.load import parse_campaign
from thermodata.store.ingest.told.declared.unanswered import unanswered

TEXT = """schema: thermodata/campaign/1
id: c
sources: {daq: {reader: table, files: "{test}.csv"}}
channels: {dX: {source: daq, signal: X, quantity: displacement, axis: X, calibration: s}}
calibrations: {s: {kind: scale, axis: X, gain: 250 um/V%s}}
tests: [{id: a, role: calibration}]
"""


@pytest.mark.parametrize(
    ("at", "meant"),
    [
        ("hall.air", "hall"),
        ("hall.dor", "hall.door"),
        ("hal.door", "hall.door"),
        ("spindle.bearing.frnt", "spindle.bearing.front"),
        ("counter_spindle.bearing.frnt", "counter_spindle.bearing.front"),
        ("hydraulics.tank", "hydraulics"),
        ("axis.z.nutt", "axis.z.nut"),
        ("axis.z.cover", "axis.z"),
        ("axs.y.nut", "axis.y.nut"),
        ("rotary.c.motr", "rotary.c.motor"),
        # not 'spindle', whose temperature stands in for that of a bearing
        ("spindle.housing", "headstock"),
        ("Spindle.head", "headstock"),
        ("spindle_housing", "headstock"),
    ],
)
def test_a_place_with_an_unknown_part_is_meant_as_a_whole_unless_a_part_is_spelt_alike(at: str, meant: str) -> None:
    text = (TEXT % "").replace(
        "channels: {", f"channels: {{T_1: {{source: daq, signal: T, quantity: temperature, at: {at}}}, "
    )
    assert [s for s in unanswered(parse_campaign(text)) if "is known" in s] == [
        f"channel 'T_1': no place '{at}' is known; did you mean '{meant}'?"
    ]


@pytest.mark.parametrize(
    ("keys", "told"),
    [(", facing: -X", True), (", facing: -X, increases_with: gap", False), ("", False)],
)
def test_a_sign_that_hangs_on_what_nobody_says(keys: str, told: bool) -> None:
    said = [s for s in unanswered(parse_campaign(TEXT % keys)) if "increases_with is not said" in s]
    assert len(said) == told
    assert all("s; the reading is taken to grow with the gap" in s for s in said)


@pytest.mark.parametrize("at", ["axis.w.screw", "axis.nut"])
def test_no_other_axis_is_proposed_than_was_named(at: str) -> None:
    text = (TEXT % "").replace(
        "channels: {", f"channels: {{T_1: {{source: daq, signal: T, quantity: temperature, at: {at}}}, "
    )
    assert not [s for s in unanswered(parse_campaign(text)) if "is known" in s]


def test_the_sign_that_is_proposed_is_of_the_axis_of_the_probe() -> None:
    text = (TEXT % "").replace(", calibration: s", "")
    (told,) = (s for s in unanswered(parse_campaign(text)) if s.startswith("sign unknown"))
    assert "{sign_x: {kind: scale, axis: X, gain: 1 um/um, facing: ?, increases_with: ?}} (+X or -X; gap" in told
    text = text.replace("channels: {", "channels: {dY: {source: daq, signal: Y, quantity: displacement, axis: Y}, ")
    (told,) = (s for s in unanswered(parse_campaign(text)) if s.startswith("sign unknown"))
    assert "{sign_y: {kind: scale, axis: Y," in told
    assert "and sign_x with axis: X" in told


def test_a_probe_in_volts_is_offered_a_gain_in_um_per_volt() -> None:
    text = (TEXT % "").replace(", calibration: s", ", unit: V")
    said = unanswered(parse_campaign(text))
    (told,) = (s for s in said if s.startswith("no length before a calibration: dX"))
    assert "{sign_x: {kind: scale, axis: X, gain: ? um/V, facing: ?, increases_with: ?}}" in told
    assert not [s for s in said if s.startswith("sign unknown")]
    in_um = unanswered(parse_campaign(text.replace("unit: V", "unit: mm")))
    assert [s for s in in_um if s.startswith("sign unknown")]


@pytest.mark.parametrize(("gain", "told"), [("-250", True), ("250", False)])
def test_a_gain_below_0_turns_a_channel_whose_sign_nobody_says(gain: str, told: bool) -> None:
    (said,) = [s for s in unanswered(parse_campaign((TEXT % "").replace("250", gain))) if s.startswith("sign unknown")]
    assert ("but for dX, turned by the gain below 0 of their calibration" in said) == told
