"""A scale is asked for the side that its probe looks from where a displacement uses it."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.schema.files.campaign import Campaign
from thermodata.store.tidy.values.calibrations import evaluate


@pytest.mark.parametrize(
    ("quantity", "gain", "asked"),
    [("rotational_speed", "1000 rpm/V", False), ("displacement", "100 um/V", True), (None, "100 um/V", True)],
)
def test_only_a_displacement_has_a_side(tmp_path: Path, quantity: str | None, gain: str, asked: bool) -> None:
    channel = {"source": "log", "signal": "a", "quantity": quantity, "unit": "V", "calibration": "k"}
    campaign = Campaign.model_validate(
        {
            "schema": "thermodata/campaign/1",
            "id": "lab",
            "sources": {"log": {"reader": "table", "files": "{test}.csv"}},
            "channels": {"a": channel} if quantity else {},
            "calibrations": {"k": {"kind": "scale", "gain": gain}},
            "tests": [{"id": "t", "kind": "spindle", "role": "none"}],
        }
    )
    results, problems = evaluate(tmp_path, campaign, {})
    assert not problems
    assert [c["name"] for c in results["k"].checks if not c["passed"]] == (["sign_known"] if asked else [])
