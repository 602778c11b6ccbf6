"""Predictions as tables: what was measured, what was predicted, and what each effect gave to it."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermodata.modelling.fitted import FittedModel
from thermodata.modelling.fitted_response import FittedResponse
from thermodata.plugin import Array
from thermodata.view.dataset import Dataset, TestData

CONTRIBUTION = "c__"


def prediction_columns(response: FittedResponse, test: TestData) -> dict[str, Array]:
    """t_s, measured, predicted (with the offset), residual, valid, and c__<effect> (without); shapes (n,).

    Only the test's window: the history before it is there for the lags.
    """
    parts = {f"{CONTRIBUTION}{term.id}": term.contribution(test) for term in response.terms}
    predicted = np.sum(list(parts.values()), axis=0) if parts else np.zeros(len(test.t_s))
    measured = response.measured(test)
    predicted = predicted + response.offset(test)
    columns: dict[str, Array] = {
        "t_s": test.t_s,
        "measured": measured,
        "predicted": predicted,
        "residual": measured - predicted,
        "valid": response.mask(test),
        **parts,
    }
    return {name: values[test.in_window] for name, values in columns.items()}


def prediction_tables(fitted: FittedModel, data: Dataset) -> dict[tuple[str, str, str], Any]:
    """(campaign, test, response) -> pyarrow table; locked tests stay closed."""
    import pyarrow as pa

    return {
        (test.campaign, test.test, response.name): pa.table(prediction_columns(response, test))
        for test in fitted.tests(data)
        for response in fitted.responses
        if response.can_predict(test)
    }
