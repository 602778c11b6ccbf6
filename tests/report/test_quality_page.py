"""The quality page: what does not count is told and drawn, and nothing else."""

from __future__ import annotations

import dataclasses
import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

from thermodata.chart import Panel
from thermodata.report.quality.data import TestQuality, Trace
from thermodata.report.quality.figure import SEVERITY, draw_test, worst_flag
from thermodata.report.quality.page import headline, render, sentences
from thermodata.schema.flag import Flag

BINS = 60
_FIGURE = re.compile(r'<script type="application/json" id="(\w+)">(.*?)</script>', re.S)


def trace(name: str, quantity: str = "temperature", bad: slice | None = None, flag: Flag = Flag.OFFSET) -> Trace:
    good, low = np.linspace(20, 24, BINS), np.full(BINS, np.nan)
    flags = np.zeros(BINS, np.uint16)
    if bad is not None:
        low[bad], good[bad], flags[bad] = 54.0, np.nan, flag
    return Trace(name, quantity, "degC", good, low, low, flags, 6000, 100 * int(np.isfinite(low).sum()), 0)


@pytest.fixture
def tests() -> list[TestQuality]:
    event = {
        "channel": "T_column",
        "source": "daq",
        "flag": "offset",
        "from_s": 3000.0,
        "to_s": 6000.0,
        "n": 3000,
        "detail": "a step of +30.0 K within one sample",
    }
    gap = {"channel": None, "source": "nc", "flag": "gap", "from_s": 100.0, "to_s": 1600.0, "n": 0, "detail": "1500 s"}
    sound = TestQuality("c", "day1", "spindle", 6000.0, 0.0, 100.0, (trace("T_column"), trace("T_bed")), (), ())
    failed = dataclasses.replace(
        sound,
        test="day2",
        events=(gap, event),
        losses=("raw/day2.tdms, byte 7: cut",),
        traces=(trace("T_column", bad=slice(30, 60)), trace("T_bed")),
    )
    return [sound, failed]


def figures(page: str) -> dict[str, dict]:
    return {key: json.loads(text) for key, text in _FIGURE.findall(page)}


def test_the_page_tells_the_share_the_reason_and_the_loss(tests: list[TestQuality]) -> None:
    assert headline(tests) == "12 % of 24 k samples do not count: offset".replace("24 k", "24\u00a0k")
    assert sentences(tests) == [
        "Data were lost in day2: see below.",
        "1 channel stepped against what came before: T_column (from day2).",
    ]
    page = render(tests)
    if os.environ.get("REPORT_PAGES"):
        (Path(os.environ["REPORT_PAGES"]) / "quality.html").write_text(page, encoding="utf-8")
    body = page[: page.index("<script>")]
    assert "raw/day2.tdms, byte 7: cut" in body
    assert "a step of +30.0 K" in body
    assert not re.search(r"<(script|link|img|iframe)[^>]+(src|href)\s*=", body)
    assert "all of 12\u00a0k samples count" in body
    assert "none of" not in body
    assert headline(tests[:1]) == "All of 12\u00a0k samples in 1 test count"


def test_a_picture_a_test_with_marks_lanes_and_gaps(tests: list[TestQuality]) -> None:
    drawn = figures(render(tests))
    assert set(drawn) == {"test0", "test1"}
    sound, failed = drawn["test0"], drawn["test1"]
    assert [x["name"] for x in sound["panels"][0]["series"]] == ["T_column", "T_bed"]
    assert [x["label"] for x in failed["panels"][0]["series"]] == ["T_bed", "T_column"], "each curve has its name"
    assert [x["colour"] for x in failed["panels"][0]["series"]] == ["quiet", "effect-1"]
    (marks,) = failed["panels"][0]["marks"]
    assert len(marks["x"]) == 30
    assert (marks["reasons"], marks["colours"]) == (["offset"], ["flag-offset"])
    assert [(r["name"], [x[2:] for x in r["runs"]]) for r in failed["rows"]] == [
        ("T_column", [["flag-offset", "offset"]])
    ]
    assert failed["rows"][0]["runs"][0][:2] == pytest.approx([3000 / 3600, 6000 / 3600], abs=1e-5)
    bands = [(round(x["from"] * 3600), round(x["to"] * 3600)) for x in failed["spans"] if x["kind"] == "gap"]
    assert bands == [(100, 1600)]


def test_what_dwarfs_the_panel_is_drawn_at_its_edge_with_its_value(tests: list[TestQuality]) -> None:
    far = trace("T_column", bad=slice(10, 12), flag=Flag.OUT_OF_RANGE)
    far.low[10:12] = 850.0
    made = draw_test(dataclasses.replace(tests[0], traces=(far, trace("T_bed"))))
    (panel,) = made.panels
    assert isinstance(panel, Panel)
    assert panel.range is not None
    assert panel.range[1] < 30
    (mark,) = panel.marks
    assert list(mark.y) == [850.0, 850.0], "what is read is the value; the script draws it at the edge"


def test_the_worst_flag_of_a_bin_gives_its_colour() -> None:
    flags = np.array([0, Flag.GAP, Flag.SPIKE | Flag.GAP, Flag.OFFSET | Flag.SPIKE], np.uint16)
    assert [SEVERITY[i] if i >= 0 else None for i in worst_flag(flags)] == [None, Flag.GAP, Flag.SPIKE, Flag.OFFSET]


def test_names_from_data_can_not_break_the_page(tests: list[TestQuality]) -> None:
    evil = "</script><script>alert(1)</script>"
    named = dataclasses.replace(
        tests[1], test=evil, campaign=evil, losses=(evil,), traces=(dataclasses.replace(tests[1].traces[0], name=evil),)
    )
    assert evil not in render([named])
    assert render([])


def test_what_is_overruled_is_told_with_its_reason_and_not_counted(tests: list[TestQuality]) -> None:
    event = {**tests[1].events[1], "detail": "overruled: the bed's heater was on (was: a step of +30.0 K)"}
    both = [dataclasses.replace(t, test=t.test + x, events=(event,)) for t, x in ((tests[0], "a"), (tests[0], "b"))]
    assert sentences(both) == ["2 overruled by the campaign file: T_column (day1a, offset): the bed's heater was on."]
    assert headline(both) == "All of 24\u00a0k samples in 2 tests count"
    body = render(both)
    assert "heater was on" in body


def test_losses_of_one_cause_are_one_line(tests: list[TestQuality]) -> None:
    lost = dataclasses.replace(tests[1], losses=tuple(f"raw/day2.tdms, byte {i}: cut" for i in range(40)))
    body = render([lost])
    assert "40 times: raw/day2.tdms, byte 0: cut" in body
    assert "byte 7: cut" not in body


def test_drifts_are_drawn_from_their_first_valid_value_and_told_apart() -> None:
    bins = 50
    none, flags = np.full(bins, np.nan), np.zeros(bins, np.uint16)
    drift = np.linspace(0.0, 5.0, bins)
    late = np.where(np.arange(bins) < 3, np.nan, drift)
    traces = (
        Trace("dX", "displacement", "um", drift, none, none, flags, 500, 0, 0),
        Trace("dY", "displacement", "um", 550.0 + late, none, none, flags, 500, 0, 0),
        Trace("T_air", "temperature", "degC", 20.0 + drift, none, none, flags, 500, 0, 0),
    )
    chart = draw_test(TestQuality("c", "day1", "spindle", 6e3, 0.0, 100.0, traces, (), ()))
    shifted, absolute = (p for p in chart.panels if isinstance(p, Panel))
    assert shifted.title == "displacement, from the first valid value"
    assert shifted.range is not None
    assert shifted.range[1] < 6.0
    assert {s.name: float(np.nanmax(s.y)) for s in shifted.series} == pytest.approx({"dX": 5.0, "dY": 5.0 - drift[3]})
    assert len({(s.colour, s.dash) for s in shifted.series}) == 2
    assert absolute.title == "temperature"
    assert float(absolute.series[0].y[0]) == 20.0


def test_a_channel_of_fewer_samples_than_bins_is_a_line_and_its_gap_is_none() -> None:
    """A minute's log of a test of half an hour would be dots; a pause in it is a pause."""
    bins = 480
    at = np.array([i for i in range(0, bins, 16) if not 160 <= i < 320])
    good = np.full(bins, np.nan)
    good[at] = 20.0 + at / 100
    none, flags = np.full(bins, np.nan), np.zeros(bins, np.uint16)
    slow = Trace("T_air", "temperature", "degC", good, none, none, flags, len(at), 0, 0)
    chart = draw_test(TestQuality("c", "day1", "spindle", 1800.0, 0.0, 1800.0 / bins, (slow,), (), ()))
    (panel,) = (p for p in chart.panels if isinstance(p, Panel))
    (series,) = panel.series
    assert series.x is not None
    assert np.isnan(series.y).sum() == 1
    (gap,) = np.flatnonzero(np.isnan(series.y))
    assert series.y[gap - 1] == pytest.approx(20.0 + 144 / 100)
    assert series.y[gap + 1] == pytest.approx(20.0 + 320 / 100)
    assert np.all(np.diff(series.x) >= 0)


def test_what_ran_while_the_test_did_not_measure_does_not_count_and_is_no_fault(tests: list[TestQuality]) -> None:
    """The share that the page tells is that of `valid(flag)`, as in the workbench's list of tests."""
    resting = dataclasses.replace(trace("dZ", "displacement"), idle=1500)
    saturated = {
        "channel": "dZ",
        "source": "daq",
        "flag": "saturated",
        "from_s": 0.0,
        "to_s": 900.0,
        "n": 900,
        "detail": "only while not measuring",
    }
    idle = dataclasses.replace(tests[0], traces=(resting, trace("T_bed")), events=(saturated,))
    assert headline([idle]) == "12 % of 12\u00a0k samples do not count: not measuring"
    assert "12 % of 12\u00a0k samples do not count, all of them while not measuring" in render([idle])
    both = dataclasses.replace(idle, traces=(resting, trace("T_column", bad=slice(30, 60))))
    assert "38 % of 12\u00a0k samples do not count, 12 % while not measuring" in render([both])


def test_events_that_are_alike_are_a_row_with_each_below_it(tests: list[TestQuality]) -> None:
    strokes = tuple(
        {"channel": "dX", "source": "daq", "flag": "saturated", "from_s": 300.0 * i, "to_s": 300.0 * i + 60, "n": 12,
         "detail": "the end of its range"}
        for i in range(109)
    )  # fmt: skip
    page = render([dataclasses.replace(tests[1], events=(*tests[1].events, *strokes))])
    assert "111 events in 3 rows of what is alike" in page
    row = re.search(r'<tr class="on">(.*?)</tr>', page, re.S)[1]
    cells = re.findall(r"<td[^>]*>(.*?)</td>", row, re.S)
    assert cells[1:] == ["dX", "109", "0 s – 9.0 h", "1.8 h", "1.31\u00a0k", "the end of its range"]
    each = re.findall(r"<li>(.*?) <span", page)
    assert len(each) == 109, "none is left out"
    assert each[1] == "0:05:00 to 0:06:00"
