"""The residual of a response on the page Compare: over every test, against a channel, and how long it remembers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thermodata.chart.colour import EFFECTS
from thermodata.chart.parts import Axis, Limit, Panel, Series
from thermodata.chart.spec import Chart, HeatMap
from thermodata.modelling.seen.residual_tests import autocorrelation, lags_told
from thermodata.plugin import Float1D
from thermodata.report.words.numbers import number, typeset
from thermodata.store import Store
from thermodata.view.curves.predictions import Prediction, residual_strips
from thermodata.view.curves.residuals import Key, against
from thermodata.view.lists.models import ModelRow
from thermodata.web.pages.parts.strip import FULL_COLOUR

BINS = 240
"""Columns of the longest test; a shorter one has as many as its time is worth."""
_FINE = 4  # stretches that are read for each of them
_MOST_LAG_S = 6 * 3600.0


def maps(
    store: Store,
    models: list[ModelRow],
    names: Mapping[Key, str],
    response: str,
    unit: str,
    errors: Mapping[str, Mapping[Key, float]],
) -> list[tuple[ModelRow, HeatMap]]:
    """A map of each model on the scale of the pinned one: a fall must be seen. names: of the tests, in their order.
    unit: of errors. errors: model -> of each test, which stand behind its row."""
    made, limit, keys = [], 0.0, list(names)
    hours = _hours(store, keys)
    step = max(hours, default=0.0) / BINS or 1.0
    lengths = [max(1, min(BINS, round(each / step))) for each in hours]
    for model in models:
        strips = residual_strips(store, model.model, keys, response, _FINE * BINS)
        if not strips:
            continue
        rows = [_row(strips.get(key), n) for key, n in zip(keys, lengths, strict=True)]
        values = np.vstack(rows)
        limit = limit or float(np.nanquantile(np.abs(values), FULL_COLOUR)) or 1.0
        own = errors.get(model.model, {})
        heat = HeatMap(
            f"Residual of {response} by {model.label} over every test",
            Axis("time from the start of the test", "h"),
            unit,
            list(names.values()),
            values,
            lengths,
            0.0,
            step,
            limit,
            figures=[typeset(number(own.get(key))) for key in keys],
            figures_title=typeset(f"error [{unit}]"),
        )
        made.append((model, heat))
    return made


def _hours(store: Store, keys: Sequence[Key]) -> list[float]:
    """How long each test is."""
    with store.reader() as con:
        rows = con.execute("select campaign, test, duration_s from test").fetchall()
    known = {(campaign, test): (length or 0.0) / 3600 for campaign, test, length in rows}
    return [known.get(key, 0.0) for key in keys]


def _row(fine: Float1D | None, n: int) -> Float1D:
    """Shape (BINS,): the means of n even stretches of a test, NaN behind them and where nothing was measured. fine:
    shape (k,), in more stretches."""
    row = np.full(BINS, np.nan)
    if fine is None:
        return row
    place = np.arange(len(fine)) * n // len(fine)
    there = np.isfinite(fine)
    count = np.bincount(place[there], minlength=n)
    total = np.bincount(place[there], weights=fine[there], minlength=n)
    row[:n] = np.divide(total, count, out=np.full(n, np.nan), where=count > 0)
    return row


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
