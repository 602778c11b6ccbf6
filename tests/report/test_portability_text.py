"""Tests that a model was fitted to are none that it carries over to, and each says so."""

from __future__ import annotations

from typing import Any

from thermodata.modelling.compare.portability import Portability
from thermodata.report.text.portability import portability_text


def row(test: str, role: str, campaign: str = "own", g: float = 1.0) -> dict[str, Any]:
    return Portability(campaign, test, "m", role, "dZ", g, 1.0, 95.0, 95.0, 40.0, 3.0, 3.0, "portable").to_json()


def said_of(text: str) -> dict[str, list[str]]:
    return {line.split()[0]: line.split() for line in text.splitlines() if line.startswith(("heat", "day"))}


def test_what_was_fitted_is_named() -> None:
    rows = [row("heat", "calibration"), row("day1", "verification (in-sample)"), row("day3", "verification")]
    text = portability_text(rows, ["own"])
    said = said_of(text)
    assert [said[name][1:3] for name in ("heat", "day1", "day3")] == [
        ["calibration", "yes"],
        ["verification", "yes"],
        ["verification", "no"],
    ]
    assert "fitted: the model was fitted to the test, so what it does there says nothing" in " ".join(text.split())


def test_tests_of_another_campaign_have_its_roles_and_were_not_fitted() -> None:
    text = portability_text([row("heat", "calibration", "other"), row("day", "locked", "other")], ["own"])
    assert "says nothing" not in text
    assert "yes" not in text
