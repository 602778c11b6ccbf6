"""Candidates and diagnoses as answers hold them, with figures of which a test says nothing unless it gives its own."""

from __future__ import annotations

from typing import Any

from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis


def candidate(name: str, **more: Any) -> Candidate:
    """name: its id, effect:driver."""
    effect, _, driver = name.partition(":")
    given: dict[str, Any] = {
        "rank": 1,
        "id": name,
        "effect": effect,
        "family": effect,
        "drivers": [driver],
        "claimed": False,
        "p_value": 0.01,
        "rmse_um_before": 5.0,
        "rmse_um_after": 3.0,
        "fit_before": 50.0,
        "fit_after": 70.0,
    }
    return Candidate(**{**given, **more})


def diagnosis(*candidates: Candidate, **more: Any) -> Diagnosis:
    """verdict: that an effect is missing, unless another is given."""
    given: dict[str, Any] = {
        "model": "m",
        "response": "dZ",
        "verdict": "effect",
        "noise_um": 0.3,
        "rmse_um": 5.0,
        "explainable": 0.9,
        "weak_spots": [],
        "candidates": list(candidates),
        "artefacts": [],
    }
    return Diagnosis(**{**given, **more})
