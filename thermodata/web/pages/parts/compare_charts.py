"""The residual of a response on the page Compare: over every test, against a channel, and how long it remembers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from thermodata.chart.colour import EFFECTS
from thermodata.chart.parts import Axis, Limit, Panel, Series
from thermodata.chart.spec import Chart, HeatMap
from thermodata.modelling.seen.residual_tests import autocorrelation, lags_told
from thermodata.plugin import Float1D
from thermodata.store import Store
from thermodata.view.curves.predictions import Prediction, residual_strips
from thermodata.view.curves.residuals import Key, against
from thermodata.view.lists.models import ModelRow
from thermodata.web.pages.parts.strip import FULL_COLOUR

BINS = 120
_MOST_LAG_S = 6 * 3600.0


def maps(
    store: Store, models: list[ModelRow], names: Mapping[Key, str], response: str, unit: str
) -> list[tuple[ModelRow, HeatMap]]:
    """A map of each model on the scale of the pinned one: a fall must be seen. names: of the tests, in their order.
    unit: of errors."""
    made, limit, keys = [], 0.0, list(names)
    for model in models:
        strips = residual_strips(store, model.model, keys, response, BINS)
        if not strips:
            continue
        values = np.vstack([strips.get(k, np.full(BINS, np.nan)) for k in keys])
        limit = limit or float(np.nanquantile(np.abs(values), FULL_COLOUR)) or 1.0
        heat = HeatMap(
            f"Residual of {response} by {model.label} over every test",
            Axis("share of the test", "%"),
            unit,
            list(names.values()),
            values,
            [BINS] * len(keys),
            0.0,
            100 / BINS,
            limit,
        )
        made.append((model, heat))
    return made


def correlated(parts: list[Prediction]) -> Chart:
    """The autocorrelation of the residual of all tests together."""
    left = [np.where(p.valid, p.residual, np.nan) for p in parts]
    steps = np.concatenate([np.diff(p.t_s) for p in parts])
    step_s = float(np.median(steps)) if len(steps) else 1.0
    correlation = autocorrelation(left, lags_told(left, step_s, _MOST_LAG_S))
    lag_s = step_s * np.arange(len(correlation))
    near = [Limit(1 / np.e, "1/e")]
    panel = Panel(
        "autocorrelation of the residual",
        "",
        [Series("autocorrelation", "", correlation, "residual", style="line")],
        height=140,
        zero=True,
        limits=near,
    )
    return Chart("How long the residual remembers", Axis("lag", "h"), lag_s / 3600, [panel], tools=False)


def over_channel(store: Store, parts: list[Any], channel: str, unit: str) -> Chart:
    """The residual of all tests against a channel; unit: of errors."""
    found = against(store, parts, channel)
    span = _wide(found.value)
    panel = Panel(
        f"residual over {channel}",
        unit,
        [
            Series("residual", unit, found.residual, "residual", x=found.value, style="points", label=""),
            Series("mean", unit, found.means, EFFECTS[0], x=found.bins, width=2.4, label=""),
        ],
        height=220,
        zero=True,
    )
    axis = Axis(channel, found.unit, range=span)
    return Chart(f"Residual over {channel}", axis, np.empty(0), [panel], tools=False)


def _wide(values: Float1D) -> tuple[float, float]:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return (low, high) if high > low else (low - 0.5, high + 0.5)
