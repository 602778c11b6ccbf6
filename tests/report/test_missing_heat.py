"""The estimated missing heat on the page and in the terminal."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.report.charts.heat import heat_charts
from thermodata.report.collected.data import ReportData
from thermodata.report.page.page import render
from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.words.numbers import heat_lines

from .conftest import missing_heat
from .test_page import _FIGURE, _keep, body


def values(packed: dict[str, Any]) -> np.ndarray:
    codes = np.frombuffer(base64.b64decode(packed["u2"]), "<u2")
    return np.where(codes == 65535, np.nan, packed["low"] + packed["step"] * codes)


def test_each_test_has_its_course_on_the_page(unlogged: ReportData) -> None:
    page = render(unlogged)
    _keep(page, "unlogged")
    figures = {key: json.loads(text) for key, text in _FIGURE.findall(page)}
    assert [k for k in figures if k.startswith("heat")] == ["heat0", "heat1", "heat2"]
    above, below = figures["heat2"]["panels"]
    (residual, estimated), (source,) = above["series"], below["series"]
    assert values(source["y"])[2:7] == pytest.approx([8.0] * 5)
    assert np.isnan(values(residual["y"])[0]), "a hole is no zero"
    assert values(estimated["y"])[6] == pytest.approx(3.5, abs=1e-3)
    x = figures["heat2"]["x"]
    assert (x["start"], x["step"]) == pytest.approx((1 / 12, 1 / 6)), "a step's value stands in its middle"


def test_the_page_says_what_is_known_of_it_and_escapes_it(unlogged: ReportData) -> None:
    text = body(render(unlogged))
    assert "A body near &lt;coolant&gt;." in text
    assert "coolant_on" in text
    assert re.search(r"day1 <span[^>]*>strong", text)
    assert re.search(r"etve <span[^>]*>absent", text)


def ranges(one_way: bool, courses: list[Any]) -> list[tuple[Any, Any]]:
    return [(c.panels[0].range, c.panels[1].range) for c in heat_charts(courses, "um", one_way)]  # type: ignore[union-attr]


def test_all_tests_have_the_same_scales() -> None:
    found = ranges(True, missing_heat().courses)
    assert len(set(found)) == 1
    (reach, (low, high)) = found[0]
    assert low == 0
    assert 8.0 < high < 10.0
    assert reach[0] < -4.0


def test_a_source_that_goes_both_ways_is_drawn_below_zero_too() -> None:
    courses = [c.model_copy(update={"source_um": [-x for x in c.source_um]}) for c in missing_heat().courses]
    assert ranges(False, courses)[0][1][0] < -8.0


def test_a_page_without_a_missing_heat_has_no_figure_of_it(blind: ReportData) -> None:
    page = render(blind)
    assert "missing heat" not in body(page)
    assert not any(key.startswith("heat") for key, _ in _FIGURE.findall(page))


def test_the_terminal_says_the_same(unlogged: ReportData) -> None:
    assert unlogged.diagnosis is not None
    text = diagnosis_text(unlogged.diagnosis)
    assert "the missing heat, estimated\n  A body near <coolant>" in text
    assert "time constant: 40 min (at most 1.5 h over tests drawn anew)" in text
    assert "direction: to plus when heated (93 % of the draws agree)" in text
    assert (
        "explains: 91 % of the squared residual in parts of the tests that were left out in turn "
        "(over 99 % of what it is drawn through, as any free course does)"
    ) in text
    assert "goes with: coolant_on (on in 96 % while it runs, 4 % else)" in text
    assert "not with: T_0 (0 % alike)" in text
    assert "and 2 more" in text


def test_hours_at_which_the_residual_stands_out_are_not_those_of_the_source(unlogged: ReportData) -> None:
    """The source is on before the displacement is."""
    assert unlogged.diagnosis is not None
    unknown = unlogged.diagnosis.unknown
    assert unknown is not None
    assert unknown.heat is not None
    heat = unknown.heat.model_copy(update={"hours_of_day": [8.0, 9.0]})
    told = unlogged.diagnosis.model_copy(
        update={"unknown": unknown.model_copy(update={"hours_of_day": [10.0], "heat": heat})}
    )
    text = diagnosis_text(told)
    assert "\n  hours of the day (UTC) at which the residual stands out: 10.0" in text
    assert "\n  its source is on at (UTC): 8 h, 9 h" in text
    page = body(render(replace(unlogged, diagnosis=told)))
    assert "hours of the day (UTC) at which the residual stands out 10" in page


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [(0.4, 1.0, "24 min to 60 min"), (0.4, None, "at least 24 min"), (None, None, "not bounded by these tests")],
)
def test_a_time_constant_is_told_with_its_spread(low: float | None, high: float | None, words: str) -> None:
    heat = missing_heat().model_copy(update={"time_constant_low_h": low, "time_constant_high_h": high})
    assert words in dict(heat_lines(heat))["time constant"]


def test_what_goes_both_ways_has_no_direction_and_what_does_not_apply_is_left_out() -> None:
    heat = missing_heat(None).model_copy(update={"goes_with": [], "hours_of_day": []})
    lines = dict(heat_lines(heat))
    assert lines["direction"] == "both ways"
    assert not {"goes with", "its source is on at (UTC)"} & set(lines)
