"""A model as a system, as charts of the page: step responses, Bode, autocorrelation, residual against each state."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from thermodata.chart import Axis, Band, Chart, Limit, Panel, Series
from thermodata.chart.colour import DASHES
from thermodata.modelling.seen.as_system import SeenResponse
from thermodata.modelling.seen.residual_tests import Against
from thermodata.report.words.numbers import time_unit
from thermodata.schema.agreed.certainty import Z95


def system_charts(seen: SeenResponse, styles: Mapping[str, tuple[str, str]]) -> dict[str, Chart]:
    """'step', 'bode', 'memory', and 'state0', ... . styles: effect -> (colour, dash)."""
    made: dict[str, Chart] = {}
    styles = path_styles(seen, styles)
    if seen.paths:
        made["step"] = _step(seen, styles)
        made["bode"] = _bode(seen, styles)
    made["memory"] = _memory(seen)
    return made | {f"state{i}": _against(state, seen.unit) for i, state in enumerate(seen.states)}


def path_styles(seen: SeenResponse, styles: Mapping[str, tuple[str, str]]) -> dict[str, tuple[str, str]]:
    """Path -> (colour, dash): the colour of its effect, and of several gains of one effect a dash each."""
    taken, found = set(styles.values()), dict[str, tuple[str, str]]()
    for p in seen.paths:
        own = styles[p.effect]
        if own in found.values():
            own = next(((own[0], dash) for dash in DASHES if (own[0], dash) not in taken), own)
            taken.add(own)
        found[p.name] = own
    return found


def _step(seen: SeenResponse, styles: Mapping[str, tuple[str, str]]) -> Chart:
    longest = max(p.step[0][-1] for p in seen.paths)
    size, unit = time_unit(longest)
    series = [
        Series(
            p.name,
            p.unit,
            np.append(p.step[1], p.step[1][-1]),
            styles[p.name][0],
            x=np.append(p.step[0], longest) / size,
            dash=styles[p.name][1],
        )
        for p in seen.paths
    ]
    panel = Panel("response to a unit of each drive", seen.unit, series, height=230, zero=True)
    return Chart(f"Step responses of {seen.response}", Axis("time", unit), np.array([0.0, longest / size]), [panel])


def _bode(seen: SeenResponse, styles: Mapping[str, tuple[str, str]]) -> Chart:
    def curves(of: int) -> list[Series]:
        return [
            Series(
                p.name,
                "deg" if of == 2 else p.unit,
                p.bode[of][::-1],
                styles[p.name][0],
                dash=styles[p.name][1],
                label="",
            )
            for p in seen.paths
        ]

    periods = 1.0 / seen.paths[0].bode[0][::-1] / 60.0  # the same of all paths; x runs upward
    panels = [
        Panel("size", f"{seen.unit} a unit", curves(1), height=150, scale="log"),
        Panel("phase", "deg", curves(2), height=110),
    ]
    return Chart(
        f"Bode diagram of {seen.response}, over the period", Axis("period", "min", scale="log"), periods, panels
    )


def _memory(seen: SeenResponse) -> Chart:
    lags_s = np.arange(len(seen.correlation), dtype=np.float64) * np.float64(seen.step_s)
    size, unit = time_unit(float(lags_s[-1]) if len(lags_s) else 0.0)
    band = Z95 / math.sqrt(max(seen.count, 1))
    limits = [Limit(band, "white within"), Limit(-band, "")]
    series = Series("autocorrelation", "1", seen.correlation, "residual", style="area", label="")
    panel = Panel(
        "autocorrelation of the residual", "1", [series], height=150, range=(-1.0, 1.0), limits=limits, zero=True
    )
    return Chart(
        f"How long the residual of {seen.response} remembers itself",
        Axis("lag", unit),
        lags_s / size,
        [panel],
    )


def _against(state: Against, unit: str) -> Chart:
    band = Band(state.means - state.sds, state.means + state.sds, "one standard deviation")
    series = Series("residual", unit, state.means, "residual", band=band, label="")
    panel = Panel("residual", unit, [series], height=120, zero=True)
    over = "" if state.unit in ("1", "") else state.unit
    return Chart(f"Residual against {state.state}", Axis("from its mean", over), state.centres, [panel])
