"""What the residual of a model still tells: how long it remembers itself, and whether it goes with a state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from thermodata.chart import effect_styles
from thermodata.modelling.seen.as_system import SeenResponse
from thermodata.modelling.seen.residual_tests import WHY_BY_THE_FIT, Against, LjungBox
from thermodata.notebook.figure import Plot
from thermodata.notebook.shown import Shown, html_table
from thermodata.plugin import Float1D
from thermodata.report.charts.system import system_charts
from thermodata.report.text.table import table


class ResidualTests(Shown):
    """Over the calibration tests; of the first response, and of each in `responses`."""

    def __init__(self, model: str, seen: Sequence[SeenResponse]) -> None:
        self.model, self.responses = model, {s.response: s for s in seen}
        self._first = seen[0]

    @property
    def autocorrelation(self) -> Float1D:
        """r_0 ... at lags of the model's step, shape (lags + 1,)."""
        return self._first.correlation

    @property
    def ljung_box(self) -> tuple[LjungBox, ...]:
        """Q and its p-value, where the residual were white, over several numbers of lags."""
        return self._first.ljung_box

    @property
    def states(self) -> tuple[Against, ...]:
        """The residual against each state of the model."""
        return self._first.states

    def _tables(self) -> list[tuple[str, list[dict[str, Any]], list[tuple[str, str]]]]:
        made = list[tuple[str, list[dict[str, Any]], list[tuple[str, str]]]]()
        for name, seen in self.responses.items():
            box: list[dict[str, Any]] = [{"lags": b.lags, "q": b.q, "p": b.p_value} for b in seen.ljung_box]
            made.append((f"{name}: Ljung-Box", box, [("lags", "lags"), ("q", "Q"), ("p", "p")]))
            states: list[dict[str, Any]] = [
                {"state": a.state, "r": a.correlation, "slope": a.slope, "unit": f"{seen.unit}/{a.unit}"}
                for a in seen.states
            ]
            heads = [("state", "residual against"), ("r", "correlation"), ("slope", "slope"), ("unit", "unit")]
            by_the_fit = any(round(a.correlation, 2) == 0.0 for a in seen.states)
            made.append((f"{name}: states" + (f" ({WHY_BY_THE_FIT})" if by_the_fit else ""), states, heads))
        return [(title, rows, heads) for title, rows, heads in made if rows]

    def summary(self) -> str:
        return "\n\n".join(f"{title}\n{table(rows, heads)}" for title, rows, heads in self._tables())

    def html(self) -> str:
        return "".join(html_table(rows, heads, title) for title, rows, heads in self._tables())

    def plot(self) -> Plot:
        """Autocorrelation with the band of white noise, and the residual against each state."""
        charts = {}
        for name, seen in self.responses.items():
            styles = effect_styles(p.effect for p in seen.paths)
            for key, chart in system_charts(seen, styles).items():
                if key == "memory" or key.startswith("state"):
                    charts[f"{name}: {chart.about}"] = chart
        return Plot("what the residual still tells", charts)
