"""Curves over time: what a model gives in its own tests, effect by effect, and in other logs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.chart import Axis, Chart, Panel, Series, effect_styles
from thermodata.notebook.figure import Plot
from thermodata.notebook.shown import Shown, html_table
from thermodata.plugin import Float1D
from thermodata.report.charts.figures import TIME
from thermodata.report.text.table import table
from thermodata.report.words.numbers import duration
from thermodata.view.query.rows import with_units

if TYPE_CHECKING:
    import pandas as pd

    from thermodata.modelling.predictions.predict import Predicted
    from thermodata.view.curves.predictions import Prediction


NOTHING = "no test can be predicted"


class Contributions(Shown):
    """What each effect gives to one response in one test, as it was stored with the fit. unit: of all of it."""

    def __init__(self, model: str, found: Prediction, unit: str) -> None:
        self.model, self.unit, self._found = model, unit, found
        self.campaign, self.test, self.response = found.campaign, found.test, found.response

    def __getitem__(self, effect: str) -> Float1D:
        """shape (n,); KeyError where the model has no such effect."""
        return self._found.contributions[effect]

    def __iter__(self) -> Any:
        return iter(self._found.contributions)

    @property
    def t_s(self) -> Float1D:
        """From the test's start [s], shape (n,)."""
        return self._found.t_s

    def to_arrow_table(self) -> Any:
        """t_s, measured, predicted, residual, valid and a column an effect; fields say their unit."""
        import pyarrow as pa

        f = self._found
        columns = {"t_s": f.t_s, "measured": f.measured, "predicted": f.predicted, "residual": f.residual}
        units = dict.fromkeys((*columns, *f.contributions), self.unit) | {"t_s": "s"}
        return with_units(pa.table({**columns, "valid": f.valid, **f.contributions}), units)

    def df(self) -> pd.DataFrame:
        """The same as pandas."""
        frame: pd.DataFrame = self.to_arrow_table().to_pandas()
        return frame

    def _rows(self) -> list[dict[str, Any]]:
        return [
            {"effect": name, "low": _lowest(y), "high": _highest(y), "end": float(y[-1]) if len(y) else None}
            for name, y in self._found.contributions.items()
        ]

    def _columns(self) -> list[tuple[str, str]]:
        ends = (("low", "lowest"), ("high", "highest"), ("end", "at the end"))
        return [("effect", "effect"), *((key, f"{text} [{self.unit}]") for key, text in ends)]

    @property
    def _title(self) -> str:
        return f"contributions to {self.response} in {self.campaign}/{self.test}"

    def summary(self) -> str:
        return f"{self._title}\n\n{table(self._rows(), self._columns())}"

    def html(self) -> str:
        return html_table(self._rows(), self._columns(), self._title)

    def plot(self) -> Plot:
        """All effects over time."""
        styles = effect_styles(self._found.contributions)
        curves = [
            Series(n, self.unit, y, styles[n][0], dash=styles[n][1]) for n, y in self._found.contributions.items()
        ]
        panel = Panel(f"contributions to {self.response}", self.unit, curves, height=260, zero=True)
        chart = Chart(f"What each effect gives in {self.test}", Axis(TIME, "h"), self.t_s / 3600, [panel])
        return Plot(self._title, {self._title: chart})


class Predictions(Shown, Sequence["Predicted"]):
    """A model on other logs. left_out: why tests are not among them."""

    def __init__(self, model: str, made: Sequence[Predicted], left_out: Sequence[str]) -> None:
        self.model, self.made, self.left_out = model, list(made), list(left_out)

    def __getitem__(self, index: Any) -> Any:
        return self.made[index]

    def __len__(self) -> int:
        return len(self.made)

    def to_arrow_table(self) -> Any:
        """A row a test, response and time: predicted, measured, known, and c__EFFECT; fields say their unit where all
        tests have one."""
        from thermodata.export.series import as_table

        return as_table(self.made)

    def df(self) -> pd.DataFrame:
        """The same as pandas."""
        frame: pd.DataFrame = self.to_arrow_table().to_pandas()
        return frame

    def _rows(self) -> list[Mapping[str, Any]]:
        return [
            {
                "test": f"{p.campaign}/{p.test}",
                "response": p.response,
                "length": duration(float(p.t_s[-1] - p.t_s[0]) if len(p.t_s) else None),
                "low": _lowest(p.predicted[p.known]),
                "high": _highest(p.predicted[p.known]),
                "unit": p.unit,
                "rmse": p.rmse,
            }
            for p in self.made
        ]

    _COLUMNS = (
        ("test", "test"),
        ("response", "response"),
        ("length", "length"),
        ("low", "lowest"),
        ("high", "highest"),
        ("unit", "unit"),
        ("rmse", "RMSE, where measured"),
    )

    def summary(self) -> str:
        left = "".join(f"\nleft out: {why}" for why in self.left_out)
        return f"{table(self._rows(), self._COLUMNS) if self.made else NOTHING}{left}"

    def html(self) -> str:
        left = "".join(f"<li>left out: {escape(why)}</li>" for why in self.left_out)
        made = (
            html_table(self._rows(), self._COLUMNS, f"predictions of {self.model}")
            if self.made
            else f"<p>{NOTHING}</p>"
        )
        return made + (f"<ul>{left}</ul>" if left else "")

    def plot(self) -> Plot:
        """A chart a test: the prediction, and the measurement where there is one."""
        charts = {}
        for p in self.made:
            curves = [] if p.measured is None else [Series("measured", p.unit, p.measured, "measured", width=1.4)]
            known = np.where(p.known, p.predicted, np.nan)
            panel = Panel(p.response, p.unit, [*curves, Series("model", p.unit, known, "model")], height=200)
            about = f"{p.response} of test {p.test} as the model predicts it"
            charts[f"{p.campaign}/{p.test}, {p.response}"] = Chart(about, Axis(TIME, "h"), p.t_s / 3600, [panel])
        return Plot(f"predictions of {self.model}", charts)


def _lowest(y: Float1D) -> float | None:
    return float(np.nanmin(y)) if np.isfinite(y).any() else None


def _highest(y: Float1D) -> float | None:
    return float(np.nanmax(y)) if np.isfinite(y).any() else None
