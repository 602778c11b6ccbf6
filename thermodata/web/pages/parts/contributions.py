"""The contributions of models beside each other as one chart: a panel a model on one scale, and what differs below."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.chart.band import SHADED, band_95
from thermodata.chart.colour import effect_styles
from thermodata.chart.parts import Axis, Band, Panel, Series
from thermodata.chart.spec import Chart
from thermodata.plugin import Float1D
from thermodata.view.curves.contributions import Contributions, Effect

_HOUR = 3600.0
_ROOM = 0.05  # of what is drawn, above and below


def contribution_chart(
    found: Contributions, labels: Mapping[str, str], unit: str, order: Sequence[str], driven: Mapping[str, str]
) -> Chart:
    """labels: model -> its name on the page. order: all effects that have a colour, in their order. driven: an effect
    -> its name with what drives it."""
    x = found.t_s / _HOUR
    styles = effect_styles([*order, *(e.effect for e in found.effects)])
    scale = _scale(found.effects)

    def series(name: str, y: Float1D, band: Band | None) -> Series:
        own = driven.get(name, name)
        return Series(own, unit, y, styles[name][0], dash=styles[name][1], label=name, band=band)

    panels = []
    for i, model in enumerate(found.models):
        curves = [
            series(e.effect, y, None if (sd := e.deviations[i]) is None else band_95(y, sd))
            for e in found.effects
            if (y := e.curves[i]) is not None
        ]
        shaded = f", {SHADED}" if any(s.band for s in curves) else ""
        panels.append(Panel(f"{labels[model]}: contributions{shaded}", unit, curves, range=scale, zero=True))
    for i, model in enumerate(found.models[1:]):
        curves = [
            series(e.effect, a.curve, None if a.reach is None else Band(a.curve - a.reach, a.curve + a.reach, "95 %"))
            for e in found.effects
            if e.differs
            for a in (e.apart[i],)
        ]
        if curves:
            title = f"{labels[model]} − {labels[found.models[0]]}: what differs, on its own scale"
            panels.append(Panel(title, unit, curves, zero=True))
    names = " and ".join(labels[m] for m in found.models)
    about = f"What each effect gives to {found.response} in test {found.test}, by {names}, on one scale"
    return Chart(about, Axis("time", "h"), x, panels)


def _scale(effects: Sequence[Effect]) -> tuple[float, float] | None:
    """Of all curves with their bands and zero; None where nothing is drawn."""
    low, high = 0.0, 0.0
    for effect in effects:
        for y, sd in zip(effect.curves, effect.deviations, strict=True):
            if y is None or not np.isfinite(y).any():
                continue
            band = band_95(y, np.zeros(len(y)) if sd is None else sd)
            low, high = min(low, float(np.nanmin(band.low))), max(high, float(np.nanmax(band.high)))
    room = _ROOM * (high - low)
    return (low - room, high + room) if high > low else None
