"""Predictions as tables: what was measured, what was predicted, and what each effect gave to it."""

from __future__ import annotations

from typing import Any

import numpy as np

from thermodata.modelling.predictions.bands import bands
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Array
from thermodata.store.base.arrow import to_arrow
from thermodata.view.grid.dataset import Dataset, TestData

CONTRIBUTION = "c__"
DEVIATION = "sd__"
"""Of what follows: 'predicted', or an effect's contribution."""


def prediction_columns(response: FittedResponse, test: TestData) -> dict[str, Array]:
    """t_s, measured, predicted (with the offset), residual, valid, and c__<effect> (without); shapes (n,).

    Where the fit knows its uncertainty, sd__predicted and sd__<effect>: standard deviations by that of the parameters.

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
        **_deviations(response, test),
    }
    return {name: values[test.in_window] for name, values in columns.items()}


def _deviations(response: FittedResponse, test: TestData) -> dict[str, Array]:
    found = bands(response, test)
    named = {} if found.predicted is None else {"predicted": found.predicted}
    # half the digits do for a band
    return {f"{DEVIATION}{name}": sd.astype(np.float32) for name, sd in (named | dict(found.contributions)).items()}


def prediction_tables(fitted: FittedModel, data: Dataset) -> dict[tuple[str, str, str], Any]:
    """(campaign, test, response) -> pyarrow table; locked tests stay closed."""
    import pyarrow as pa

    def table(columns: dict[str, Array]) -> pa.Table:
        return pa.table({name: to_arrow(values) for name, values in columns.items()})

    return {
        (test.campaign, test.test, response.name): table(prediction_columns(response, test))
        for test in fitted.tests(data)
        for response in fitted.responses
        if response.can_predict(test)
    }
