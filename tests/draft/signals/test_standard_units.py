"""MTConnect writes no units; its standard has them, and other files keep their questions."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.values import values_of
from thermodata.plugin import Signal

FEED = values_of(np.abs(12.0 + 12.0 * np.sin(np.arange(300.0))))


@pytest.mark.parametrize(
    ("name", "unit", "properties", "known"),
    [
        ("Fact", None, {"type": "PathFeedrate", "dataItemId": "f1", "subType": "ACTUAL"}, "mm/s"),
        ("Fact", None, {"type": "PathFeedrateTimeSeries", "dataItemId": "f1"}, "mm/s"),
        ("Fact", "mm/min", {"type": "PathFeedrate", "dataItemId": "f1"}, "mm/min"),
        ("Fact", None, {"type": "PathFeedrate", "dataItemId": "f1", "subType": "OVERRIDE"}, None),
        ("Fact", None, {"type": "PathFeedrate"}, None),  # no data item
        ("Fact", None, {}, None),
    ],
)
def test_the_unit_of_a_feed(name: str, unit: str | None, properties: dict[str, str], known: str | None) -> None:
    found = guess_of(Signal(name, "s", unit, properties=properties), FEED)
    assert (found.quantity, found.unit) == ("feed", known)
    standard = [q for q in found.questions if q.startswith("unit: mm/s, as MTConnect")]
    assert len(standard) == (known == "mm/s")
    assert any("m/min or mm/min?" in q for q in found.questions) == (known is None)


def test_what_an_adapter_sends_is_asked_with_the_unit_of_the_standard() -> None:
    found = guess_of(Signal("path_feedrate", "s", None, properties={"protocol": "SHDR"}), FEED)
    assert found.unit is None
    (asked,) = [q for q in found.questions if q.startswith("unit: ")]
    assert asked.startswith("unit: m/min or mm/min, or mm/s? an adapter may send another than MTConnect's: nativeUnits")
    assert asked.endswith("to 24)")
