"""A fitted response as the problem that a diagnosis asks of, in so many rows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.question.known_effects import otherwise, remembered
from thermodata.diagnosis.question.problem import Base, Explained, Problem, build_problem
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.rms import rms_about_means
from thermodata.view.grid.dataset import Dataset, TestData

# rows of all tests in which candidates are weighed: the covariance of a test costs the cube of its rows
WEIGHED_ROWS = 2400


def compressed(
    fitted: FittedResponse, data: Dataset, tests: Sequence[TestData], rows: int, base: Base | None = None
) -> Problem:
    """rows: of all tests together, at most. base: the model's columns, where they are made."""
    explained = Explained(
        fitted.name,
        data.channels[fitted.name].unit,
        measured=fitted.measured,
        residual=fitted.residual,
        mask=fitted.mask,
        base=remembered(fitted) if base is None else base,
        slack=lambda test: otherwise(fitted, test),
    )
    return build_problem(explained, tests, data.step_s, rows)


def error_of(fitted: FittedResponse, tests: Sequence[TestData]) -> float:
    """RMS residual over what counts, a free offset for each test."""
    parts = [fitted.residual(t)[fitted.mask(t)] for t in tests]
    return rms_about_means([p for p in parts if len(p)] or [np.zeros(1)])
