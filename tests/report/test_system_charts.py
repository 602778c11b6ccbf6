"""A model as a system in charts (report/charts/system.py)."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast
from unittest.mock import MagicMock

import numpy as np
import pytest

from thermodata.chart import effect_styles
from thermodata.report.charts import system, system_png
from thermodata.report.charts.system import path_styles
from thermodata.report.charts.system_png import LABEL_WIDE, folded
from thermodata.report.words.numbers import correlation_text


def test_gains_of_one_effect_have_its_colour_and_a_dash_each() -> None:
    effects = ["bearing", "frame", "screw", "ram", "table", "bed", "nut"]  # the seventh repeats the first's colour
    paths = [SimpleNamespace(effect="bearing", name=f"bearing[{g}]") for g in "ABC"]
    paths += [SimpleNamespace(effect=e, name=e) for e in effects[1:]]
    styles = effect_styles(effects)
    found = path_styles(cast(Any, SimpleNamespace(paths=paths)), styles)
    assert len(set(found.values())) == len(paths)
    assert {found[f"bearing[{g}]"][0] for g in "ABC"} == {styles["bearing"][0]}
    assert found["bearing[A]"] == styles["bearing"]
    assert all(found[e] == styles[e] for e in effects[1:])


def test_a_long_label_of_a_picture_is_folded_and_loses_nothing() -> None:
    name = "ambient_frame: temperature_of_the_spindle_bearing_in_the_front_no_01 after 24 h [K]"
    lines = folded(name, LABEL_WIDE).split("\n")
    assert len(lines) == 2
    assert max(map(len, lines)) <= LABEL_WIDE
    assert " ".join(lines).replace("_ ", "_") == name
    assert folded("T_bed after 5 min [K]", LABEL_WIDE) == "T_bed after 5 min [K]"


@pytest.mark.parametrize(("r", "text"), [(0.0, "0.00"), (-0.004, "0.00"), (0.42, "+0.42"), (-0.07, "-0.07")])
def test_a_correlation_of_nothing_has_no_sign(r: float, text: str) -> None:
    assert correlation_text(r) == text


@pytest.mark.parametrize(("ends_s", "unit", "ends"), [(5340.0, "min", 89.0), (5460.0, "h", 5460 / 3600)])
def test_a_short_response_is_drawn_over_minutes(ends_s: float, unit: str, ends: float) -> None:
    """As times are told in words; and so is how long the residual remembers itself."""
    t_s = np.arange(0.0, ends_s + 1, 60.0)
    path = SimpleNamespace(name="bearing", effect="bearing", unit="um/K", step=(t_s, t_s / ends_s))
    seen = cast(
        Any,
        SimpleNamespace(
            paths=[path], response="dZ", unit="um", step_s=60.0, correlation=t_s / ends_s, count=99, ljung_box=[]
        ),
    )
    for chart in (system._step(seen, {"bearing": ("a", "solid")}), system._memory(seen)):
        assert (chart.axis.unit, chart.x[-1]) == (unit, pytest.approx(ends))
    axes = MagicMock()
    system_png._step(axes, seen, {"bearing": {}})
    assert axes.set.call_args.kwargs["xlabel"] == f"time [{unit}]"
    assert axes.plot.call_args.args[0][-1] == pytest.approx(ends)
    system_png._correlation(axes, seen)
    assert axes.set.call_args.kwargs["xlabel"] == f"lag [{unit}]"
    assert axes.fill_between.call_args.args[0][-1] == pytest.approx(ends)
