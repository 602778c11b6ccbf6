"""A model as a system in charts (report/charts/system.py)."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

from thermodata.chart import effect_styles
from thermodata.report.charts.system import path_styles


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
