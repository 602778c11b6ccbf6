"""A model as a system in charts (report/charts/system.py)."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from thermodata.chart import effect_styles
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
