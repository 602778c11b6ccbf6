"""Fits as a store keeps them, for tests that ask for a few of their figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from thermodata.plugin import Float1D
from thermodata.schema.answers.result import FitResult, Score


def score_of(test: str, **figures: Any) -> Score:
    """The errors in a whole test; what is not given is of a middling model."""
    usual = {
        "model": "m", "campaign": "c", "role": "calibration", "response": "dZ", "phase": "all", "fit": 50.0,
        "rmse_um": 1.0, "ptp_um": 9.0, "ptp_residual_um": 3.0, "max_um": 3.0, "n": 60,
    }  # fmt: skip
    return Score(test=test, **{**usual, **figures})


def fit_of(model: str, scores: Sequence[Score], **more: Any) -> FitResult:
    """A fit with these errors, of the campaigns and responses that they are of; without parameters and checks."""
    responses = list(dict.fromkeys(s.response for s in scores))
    usual = {
        "name": model, "parent": None, "campaigns": list(dict.fromkeys(s.campaign for s in scores)),
        "response": responses[0] if len(responses) == 1 else responses, "parameters": {}, "checks": [],
    }  # fmt: skip
    return FitResult(model=model, scores=list(scores), **{**usual, **more})


def predicts_nothing(t_s: Float1D, measured: Float1D, **contributions: Float1D) -> pa.Table:
    """The prediction of a model that leaves all that was measured, shape (n,). contributions: by effect."""
    return pa.table(
        {
            "t_s": t_s,
            "measured": measured,
            "predicted": 0 * t_s,
            "residual": measured,
            "valid": np.ones(len(t_s), bool),
            **{f"c__{effect}": values for effect, values in contributions.items()},
        }
    )
