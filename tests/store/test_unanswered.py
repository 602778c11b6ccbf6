"""What a campaign file leaves open is told with every ingest."""

from __future__ import annotations

import pytest

from thermodata.schema.load import parse_campaign
from thermodata.store.ingest.unanswered import unanswered

TEXT = """schema: thermodata/campaign/1
id: c
sources: {daq: {reader: table, files: "{test}.csv"}}
channels: {dX: {source: daq, signal: X, quantity: displacement, axis: X, calibration: s}}
calibrations: {s: {kind: scale, axis: X, gain: 250 um/V%s}}
tests: [{id: a, role: calibration}]
"""


@pytest.mark.parametrize(
    ("keys", "told"),
    [(", facing: -X", True), (", facing: -X, increases_with: gap", False), ("", False)],
)
def test_a_sign_that_hangs_on_what_nobody_says(keys: str, told: bool) -> None:
    said = [s for s in unanswered(parse_campaign(TEXT % keys)) if "increases_with is not said" in s]
    assert len(said) == told
    assert all("s; the reading is taken to grow with the gap" in s for s in said)
