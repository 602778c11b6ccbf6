"""Residuals as a model left them: over all tests as a map, against what the machine did, and against themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thermodata.errors import unknown_channel
from thermodata.plugin import Float1D
from thermodata.store.base.connection import quoted
from thermodata.view.curves.predictions import Prediction, predictions
from thermodata.view.grid.floats import floats

if TYPE_CHECKING:
    from thermodata.store import Store

Key = tuple[str, str]
_MOST_POINTS = 4_000


@dataclass(frozen=True, slots=True)
class Against:
    """The residual over a channel: shape (n,) each, at most 4,000 samples of all tests. unit: of the channel. means:
    (value of the channel, mean residual) in bins of equal numbers of samples, shape (bins,) each."""

    channel: str
    unit: str
    value: Float1D
    residual: Float1D
    bins: Float1D
    means: Float1D


def predicted_tests(store: Store, model: str) -> list[Key]:
    """(campaign, test) that hold a prediction, in the campaign's order."""
    with store.reader() as con:
        rows = con.execute(
            "select distinct p.campaign, p.test, t.rowid as place from prediction p join test t "
            "on (t.campaign, t.test) = (p.campaign, p.test) where p.model = ? order by place",
            [model],
        ).fetchall()
    return [(campaign, test) for campaign, test, _ in rows]


def residuals(store: Store, model: str, keys: Sequence[Key], response: str) -> list[Prediction]:
    """Of the tests in which the response was predicted."""
    found = [p for campaign, test in keys for p in predictions(store, model, campaign, test)]
    return [p for p in found if p.response == response]


def against(store: Store, parts: Sequence[Prediction], channel: str, bins: int = 12) -> Against:
    """The residual of each sample over the channel at its time. UsageError for a channel that the tests have not."""
    value, residual, unit = [], [], ""
    with store.reader() as con:
        for p in parts:
            row = con.execute(
                "select unit from channel where campaign = ? and test = ? and channel = ? and quantity <> 'label'",
                [p.campaign, p.test, channel],
            ).fetchone()
            if row is None or len(p.t_s) < 2:
                continue
            unit = row[0]
            got = con.execute(
                f"select t_s, {quoted(channel)} as v from binned(?, ?, ?) where {quoted(channel)} is not null",
                [p.campaign, p.test, f"{float(np.median(np.diff(p.t_s))):g} s"],
            ).fetchnumpy()
            t_s, v = (floats(got[n]) for n in ("t_s", "v"))
            if not len(t_s):
                continue
            counts = p.valid & np.isfinite(p.residual)
            at = np.clip(np.searchsorted(t_s, p.t_s[counts] + 1e-6) - 1, 0, len(t_s) - 1)
            value.append(v[at])
            residual.append(p.residual[counts])
        if not value:
            known = con.execute("select distinct channel from channel order by 1").fetchall()
            raise unknown_channel(channel, [name for (name,) in known])
    x, y = np.concatenate(value), np.concatenate(residual)
    order = np.argsort(x, kind="stable")
    parts_of = np.array_split(order, min(bins, len(order)))
    thin = order[:: -(-len(order) // _MOST_POINTS)]
    return Against(
        channel,
        unit,
        x[thin],
        y[thin],
        np.array([x[i].mean() for i in parts_of]),
        np.array([y[i].mean() for i in parts_of]),
    )
