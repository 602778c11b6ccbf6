from __future__ import annotations

import dataclasses
import json
import os
import re
from pathlib import Path

from thermodata.report.data import ReportData
from thermodata.report.page import headline, render

_FIGURE = re.compile(r'<script type="application/json" id="(\w+)">(.*?)</script>', re.S)


def body(page: str) -> str:
    """The page without plotly.js."""
    return page[: page.index("<script>")]


def _keep(page: str, name: str) -> None:
    # for looking at: REPORT_PAGES=folder pytest tests/report
    if os.environ.get("REPORT_PAGES"):
        (Path(os.environ["REPORT_PAGES"]) / f"{name}.html").write_text(page, encoding="utf-8")


def test_a_page_holds_everything_and_asks_the_network_for_nothing(data: ReportData) -> None:
    page = render(data)
    _keep(page, "after")
    assert not re.search(r"<(script|link|img|iframe)[^>]+(src|href)\s*=", body(page))
    assert not re.search(r"url\(\s*['\"]?http", body(page))
    assert len(page) < 8_000_000
    figures = {key: json.loads(text) for key, text in _FIGURE.findall(page)}
    assert set(figures) == {"overview", "waterfall", "test0", "test1", "test2"}
    for text in ("With feed_screw", "day2 1 time", "jump_z", "µm/K", "collinear", "feed_motor:T_motor_Z"):
        assert text in body(page)


def test_the_headline_says_what_the_added_effect_did(data: ReportData) -> None:
    assert headline(data) == "With feed_screw the error of dZ falls from 4.24 to 0.942 um (-78 %)"


def test_without_a_parent_the_headline_is_the_verdict(blind: ReportData) -> None:
    _keep(render(blind), "before")
    assert headline(blind) == "dZ misses feed_screw (T_nut_Z)"


def test_weak_spots_are_shaded_in_their_own_test_only(blind: ReportData) -> None:
    page = render(blind)
    figures = {key: json.loads(text) for key, text in _FIGURE.findall(page)}
    shaded = {
        key: [s for s in f["layout"]["shapes"] if s["type"] == "rect" and s["yref"] == "y2 domain"]
        for key, f in figures.items()
        if key.startswith("test")
    }
    assert [len(shaded[k]) for k in ("test0", "test1", "test2")] == [1, 0, 1]
    assert shaded["test2"][0]["x0"] == 11000 / 3600


def test_texts_from_data_can_not_break_the_page(data: ReportData) -> None:
    evil = "</script><script>alert(1)</script>"
    tests = (dataclasses.replace(data.tests[0], test=evil, conditions={evil: evil}), *data.tests[1:])
    page = render(dataclasses.replace(data, tests=tests, name=evil, machine=evil, responses=(evil,)))
    assert evil not in page
    assert "alert(1)" in page


def test_a_model_without_tests_or_diagnosis_still_has_a_page(data: ReportData) -> None:
    bare = dataclasses.replace(data, tests=(), scores=[], before=[], versions=(), reason=None, calibrations=())
    assert "No predictions are stored" in render(bare)
