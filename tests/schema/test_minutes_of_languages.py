"""Feeds and flows whose minute is written in another language, as a control of that country exports them."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess
from thermodata.reader.text import split_unit
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import is_unit


@pytest.mark.parametrize(
    ("written", "target", "factor"),
    [
        ("mm/dk", "mm/min", 1.0),
        ("m/dk", "mm/min", 1000.0),
        ("l/dk.", "l/min", 1.0),
        ("mm/perc", "mm/min", 1.0),
        ("mm/мин", "mm/min", 1.0),
        ("µm/dk", "mm/min", 1e-3),
    ],
)
def test_a_minute_of_another_language_is_one(written: str, target: str, factor: float) -> None:
    assert linear_conversion(written, target) == pytest.approx((factor, 0.0))
    assert split_unit(f"Kanal 7 ({written})") == ("Kanal 7", written)


@pytest.mark.parametrize("written", ["mm/dkk", "dk/mm", "g/dk", "kdk"])
def test_what_only_looks_like_one_is_none(written: str) -> None:
    assert not is_unit(written)


def test_a_turkish_feed_needs_no_question() -> None:
    found = guess(*split_unit("X ilerleme (mm/dk)"))
    assert (found.quantity, found.unit, found.at, found.questions) == ("feed", "mm/dk", "axis.x", ())
