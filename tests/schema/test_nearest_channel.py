"""Which other channel a refusal offers: one whose name was misspelt, and never another sensor."""

from __future__ import annotations

import pytest

from thermodata.errors import nearest_of_same_words, unknown_channel

NAMES = ["T04_Staender_vorn", "T05_Staender_hinten", "T_nut_Z", "spindle_speed", "T_bearing_front"]


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("T04_Staendr_vorn", "T04_Staender_vorn"),
        ("spindle_sped", "spindle_speed"),
        ("SpindleSpeed", "spindle_speed"),
        ("T_nut", "T_nut_Z"),
        ("T_bearing_frnt", "T_bearing_front"),
    ],
)
def test_a_slip_is_offered_what_it_was_a_slip_of(word: str, meant: str) -> None:
    assert nearest_of_same_words(word, NAMES) == meant


@pytest.mark.parametrize(
    ("word", "there"),
    [
        ("T04_Staender_vorn", "T05_Staender_hinten"),
        ("T04_Bett", "T05_Bett"),
        ("T_nut_Y", "T_nut_Z"),
        ("T_bearing_rear", "T_bearing_front"),
    ],
)
def test_another_place_or_number_is_another_sensor(word: str, there: str) -> None:
    assert nearest_of_same_words(word, [there]) is None
    assert "did you mean" not in str(unknown_channel(word, [there]))
