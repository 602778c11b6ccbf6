"""The script draws every kind of specification in a real browser, under a policy without anything inline."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.chart import (
    Axis,
    Band,
    Chart,
    HeatMap,
    Limit,
    Marks,
    Panel,
    Row,
    Series,
    Span,
    Strip,
    script,
    script_json,
    style,
)

from ..chromium import Chromium, Page

HOURS = np.arange(1000) / 100  # 0 to 9.99 h


def specs() -> dict[str, dict[str, Any]]:
    y = np.sin(HOURS)
    holed = np.where((HOURS > 4) & (HOURS < 5), np.nan, 10 * HOURS)
    chart = Chart(
        "Test one",
        Axis("time from the start of the test", "h"),
        HOURS,
        [
            Panel(
                "dZ",
                "um",
                [
                    Series("measured", "um", holed, "measured", style="points"),
                    Series("model", "um", y, "model", band=Band(y - 1, y + 1, "95 %"), dash="dashed"),
                    Series("slow", "um", np.array([0.0, 5.0]), "effect-1", x=np.array([1.0, 8.005])),
                ],
                marks=[Marks("dZ", "um", np.array([2.0]), np.array([1e4]), ["flag-spike"], ["spike: far off"])],
                limits=[Limit(0.5, "noise")],
            ),
            Strip(Series("speed", "rpm", np.where(HOURS > 5, 9000.0, 0.0), "lane", style="area"), "speed"),
        ],
        spans=[Span(3, 4, "weak", "6 um", "feed on", 1), Span(6, 7, "gap", "no data"), Span(0, 5, "phase", "warm")],
        rows=[Row("T_front", [(1.0, 2.0, "flag-held", "held")])],
        group="g",
    )
    other = Chart("Test two", chart.axis, HOURS, [Panel("dX", "um", [Series("dX", "um", y, "measured")])], group="g")
    log = Chart(
        "Spectrum",
        Axis("frequency", "Hz", scale="log"),
        np.logspace(-4, 0, 100),
        [Panel("density", "um2/Hz", [Series("density", "um2/Hz", np.logspace(3, -3, 100), "model")], scale="log")],
    )
    dated = Chart(
        "By the clock",
        Axis("UTC", "", time=True),
        1.77e9 + np.arange(100.0),
        [Panel("dZ", "um", [Series("dZ", "um", np.arange(100.0), "measured")])],
    )
    empty = Chart(
        "Empty", Axis("time", "h"), np.empty(0), [Panel("dZ", "um", [Series("dZ", "um", np.empty(0), "model")])]
    )
    short = Chart(
        "Five minutes",
        Axis("time", "h", range=(0.0, 300 / 3600)),
        np.arange(301) / 3600,
        [Panel("dZ", "um", [Series("dZ", "um", np.arange(301.0), "measured")])],
    )
    values = np.vstack([8 * np.ones(50), np.full(50, np.nan)])
    heat = HeatMap("Where", Axis("time", "h"), "um", ["a", "b"], values, [50, 30], 0.0, 0.2, 16.0, targets=["one", ""])
    return {
        "one": chart.as_json(coarse=True),
        "two": other.as_json(),
        "log": log.as_json(),
        "dated": dated.as_json(),
        "empty": empty.as_json(),
        "short": short.as_json(),
        "heat": heat.as_json(),
    }


def page(charts: dict[str, dict[str, Any]]) -> str:
    js, css = script(), style()
    allowed = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in (js, css)]
    policy = f"default-src 'none'; script-src 'sha256-{allowed[0]}'; style-src 'sha256-{allowed[1]}'"
    boxes = "".join(f'<div data-chart="{key}" data-height="300"></div>' for key in charts)
    data = "".join(
        f'<script type="application/json" id="{key}">{script_json(spec)}</script>' for key, spec in charts.items()
    )
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>charts</title>'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}"><style>{css}</style></head>'
        f"<body>{boxes}{data}<script>{js}</script></body></html>"
    )


CHART = "ThermoChart.of(document.querySelector('[data-chart={}]'))"
ONE, TWO, HEAT = CHART.format("one"), CHART.format("two"), CHART.format("heat")


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    path: Path = tmp_path_factory.mktemp("charts") / "page.html"
    path.write_text(page(specs()), encoding="utf-8")
    return path.as_uri()


@pytest.fixture
def tab(chromium: Chromium, address: str) -> Iterator[Page]:
    """The page; whatever a test does with it, nothing may be asked of a network, and nothing may go wrong."""
    made = chromium.open(address)
    made.js("document.querySelectorAll('[data-chart]').forEach(b => ThermoChart.of(b))")
    yield made
    assert made.complaints() == []
    assert set(made.requests()) == {address}
    made.close()


def over(tab: Page, x: float) -> tuple[float, float]:
    """Where hour x of the first panel of chart one is in the window."""
    tab.js("document.querySelector('[data-chart=one]').scrollIntoView()")
    place = tab.js(
        f"(() => {{ const u = {ONE}.panels[0].plot, b = u.over.getBoundingClientRect();"
        f" return [b.left + u.valToPos({x}, 'x'), b.top + b.height / 2]; }})()"
    )
    return place[0], place[1]


def shown(tab: Page, chart: str = ONE) -> list[float]:
    return list(tab.js(f"[{chart}.lo, {chart}.hi]"))


def test_each_kind_is_drawn(tab: Page) -> None:
    assert tab.js("document.querySelectorAll('.uplot').length") == 3 + 5
    inked = (
        "[...document.querySelectorAll('canvas')].map(c => c.width && c.height && "
        "c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some(v => v))"
    )
    assert all(tab.js(inked))


def test_the_cursor_says_values_with_units_holes_and_reasons(tab: Page) -> None:
    tab.mouse("mouseMoved", *over(tab, 2.0))
    text = tab.js("document.querySelector('[data-chart=one]').innerText")
    assert "h (1:59:" in text or "h (2:00:" in text
    tab.js(f"{ONE}.point(2.0)")
    text = tab.js("document.querySelector('[data-chart=one]').innerText")
    assert "20.00\u00a0µm" in text
    assert "0.9093\u00a0µm (−0.09" in text, "a band is said with its value"
    assert "spike: far off" in text
    assert "warm" in text
    tab.js(f"{ONE}.point(4.5)")
    assert "no data" in tab.js("document.querySelector('[data-chart=one]').innerText"), "a gap is no zero"
    tab.js(f"{ONE}.point(3.5)")
    assert "weak spot 1: 6 um: feed on" in tab.js("document.querySelector('[data-chart=one] .tc-at').innerText")
    tab.js(f"{ONE}.point(1.5)")
    assert "T_front: held" in tab.js("document.querySelector('[data-chart=one]').innerText")
    assert tab.js(f"{TWO}.at") == 1.5, "charts of one group share the cursor"


def test_a_test_of_minutes_is_told_in_minutes(tab: Page) -> None:
    short = CHART.format("short")
    axis = f"{short}.panels[0].plot.axes[0]"
    assert tab.js(f"{axis}.label") == "time [min]"
    assert tab.js(f"{axis}._values") == [str(round(x / 2, 1)).removesuffix(".0") for x in range(11)]
    tab.js(f"{short}.point(100 / 3600)")
    assert "1.667\u00a0min (0:01:40)" in tab.js("document.querySelector('[data-chart=short] .tc-at').innerText")
    tab.js(f"{short}.zoom(60 / 3600, 120 / 3600)")
    assert shown(tab, short) == pytest.approx([60 / 3600, 120 / 3600]), "places stay in hours"
    tab.js(f"{short}.point(null)")
    told = tab.js("document.querySelector('[data-chart=short] .tc-at').innerText")
    assert told == "1.000 … 2.000\u00a0min of 5.000\u00a0min"
    assert tab.js(f"{CHART.format('one')}.panels.at(-1).plot.axes[0].label").endswith("[h]")


def test_a_gap_of_the_data_is_a_gap_of_the_line_and_a_hole_of_the_join_is_none(tab: Page) -> None:
    data = tab.js(f"{ONE}.panels[0].data.map(c => c.map(v => v === undefined ? 'hole' : v))")
    x = data[0]
    assert data[1][x.index(4.5)] is None
    slow = data[-1]
    assert 8.005 in x
    assert slow[x.index(8.005)] == 5.0
    assert slow[x.index(4.5)] == "hole"


def test_zoom_by_drag_wheel_keys_and_buttons(tab: Page) -> None:
    (x0, y), (x1, _) = over(tab, 2.0), over(tab, 6.0)
    tab.drag(x0, x1, y)
    low, high = shown(tab)
    assert (low, high) == pytest.approx((2.0, 6.0), abs=0.05)
    assert shown(tab, TWO) == [low, high], "charts of one group share the zoom"
    tab.mouse("mouseWheel", *over(tab, 4.0), deltaX=0, deltaY=-100)
    assert shown(tab)[1] - shown(tab)[0] == pytest.approx(0.8 * (high - low), rel=0.01)
    tab.key("0")
    assert shown(tab) == [0, 9.99]
    tab.key("+")
    assert shown(tab)[1] - shown(tab)[0] == pytest.approx(9.99 / 2)
    tab.key(",")
    tab.key(".")
    tab.key("-")
    tab.js("document.querySelector('[data-chart=one] .tc-tools button').click()")
    assert shown(tab)[1] - shown(tab)[0] == pytest.approx(9.99 / 2, rel=0.3)
    tab.js("[...document.querySelectorAll('[data-chart=one] .tc-tools button')][2].click()")
    assert shown(tab) == [0, 9.99]


def test_a_wheel_over_a_chart_that_nobody_clicked_scrolls_the_page(tab: Page) -> None:
    at = over(tab, 4.0)
    tab.js("document.activeElement.blur()")
    tab.mouse("mouseWheel", *at, deltaX=0, deltaY=-100)
    assert shown(tab) == [0, 9.99]


def test_two_cursors_give_the_difference(tab: Page) -> None:
    tab.js("document.querySelector('[data-chart=one]').focus()")
    tab.js(f"{ONE}.point(1.0)")
    tab.key("a")
    tab.js(f"{ONE}.point(3.0)")
    tab.key("b")
    text = tab.js("document.querySelector('[data-chart=one] .tc-diff').innerText")
    assert "2.000\u00a0h" in text
    assert "+20.00\u00a0µm" in text
    x, y = over(tab, 3.0)
    tab.drag(x, over(tab, 7.0)[0], y)
    assert tab.js(f"{ONE}.b") == pytest.approx(7.0, abs=0.05), "a cursor is dragged, and nothing is zoomed"
    assert shown(tab) == [0, 9.99]
    tab.key("Escape")
    assert tab.js("document.querySelector('[data-chart=one] .tc-diff').hidden")


def test_events_for_the_page_around(tab: Page) -> None:
    tab.js(
        "window.told = []; ['tc:zoom', 'tc:range', 'tc:pick'].forEach(n => "
        "document.addEventListener(n, e => told.push([n, e.detail])))"
    )
    tab.click(*over(tab, 3.0))
    name, detail = tab.js("told.pop()")
    assert name == "tc:pick"
    assert detail["x"] == pytest.approx(3.0, abs=0.05)
    tab.js(f"{ONE}.options.drag = 'range'")
    (x0, y), (x1, _) = over(tab, 2.0), over(tab, 6.0)
    tab.drag(x0, x1, y)
    name, detail = tab.js("told.pop()")
    assert name == "tc:range"
    assert (detail["from"], detail["to"]) == pytest.approx((2.0, 6.0), abs=0.05)
    assert shown(tab) == [0, 9.99], "a stretch that is chosen is no zoom"


def test_a_heat_map_is_read_by_mouse_and_keys_and_says_where_to_go(tab: Page) -> None:
    tab.js("window.told = []; document.addEventListener('tc:pick', e => told.push(e.detail))")
    tab.js("document.querySelector('[data-chart=heat]').focus()")
    tab.key("ArrowDown")
    assert "a, 0.100\u00a0h: +8.000\u00a0µm" in tab.js("document.querySelector('[data-chart=heat] .tc-at').innerText")
    tab.key("Enter")
    assert tab.js("told.pop()")["target"] == "one"
    tab.key("ArrowDown")
    assert "not measured" in tab.js("document.querySelector('[data-chart=heat] .tc-at').innerText")
    assert tab.js(f"{HEAT}.colour(0)") != tab.js(f"{HEAT}.colour(8)")
    assert tab.js(f"{HEAT}.colour(16)") == tab.js(f"{HEAT}.colour(99)"), "the scale does not follow the values"


def test_more_data_for_a_window_keeps_zoom_and_hidden_curves(tab: Page) -> None:
    tab.js(f"{ONE}.zoom(2, 6)")
    tab.js("document.querySelector('[data-chart=one] .tc-key').click()")
    finer = specs()["one"]
    finer["axis"]["range"] = [0, 9.99]
    tab.js(f"{ONE}.update({json.dumps(finer)})")
    assert shown(tab) == [2, 6]
    assert not tab.js(f"{ONE}.panels[0].plot.series[1].show")
    tab.js(f"{ONE}.update({json.dumps(specs()['two'])})")
    assert tab.js("document.querySelectorAll('[data-chart=one] .uplot').length") == 1, "other panels are built anew"


def test_both_looks_and_paper(tab: Page) -> None:
    lit = tab.js("ThermoChart.colour('paper')")
    tab.look(1200, 900, dark=True)
    assert tab.wait(f"ThermoChart.colour('paper') !== '{lit}'")
    tab.js("window.dispatchEvent(new Event('beforeprint'))")
    assert tab.js("ThermoChart.colour('paper')") == lit
    assert tab.js(f"{ONE}.panels[0].plot.width") == 680
    tab.js("window.dispatchEvent(new Event('afterprint'))")
    assert tab.js("ThermoChart.colour('paper')") != lit
    assert tab.js(f"{ONE}.panels[0].plot.width") > 1000


def test_a_phone_has_numbers_at_the_line_ends_and_nothing_beside_the_page(tab: Page) -> None:
    tab.look(390, 844, mobile=True)
    tab.wait(f"{ONE}.narrow")
    assert "1 measured" in tab.js("document.querySelector('[data-chart=one]').innerText")
    assert tab.js("document.documentElement.scrollWidth <= 390")


def test_a_strip_says_what_it_goes_over_in_its_unit(tab: Page) -> None:
    head = "document.querySelector('[data-chart=one] .tc-strip .tc-head').innerText.replace(/\\s+/g, ' ')"
    assert tab.wait(f"{head} === 'speed [rpm] 0 … 9000'")
    tab.js(f"{ONE}.zoom(6, 8)")
    assert tab.wait(f"{head} === 'speed [rpm] 9000'"), "of what is in sight"


def test_long_names_differ_where_they_are_cut(tab: Page) -> None:
    ends = tab.js("['front', 'rear'].map(end => ThermoChart.short('temperature_of_the_bearing_' + end, 18))")
    assert ends == ["temperatu…ng_front", "temperatu…ing_rear"]
    assert tab.js("ThermoChart.short('T_front', 18)") == "T_front"


def test_what_left_the_page_is_let_go_and_what_came_is_drawn(tab: Page) -> None:
    tab.js("document.querySelector('[data-chart=two]').remove(); ThermoChart.scan(document)")
    tab.js(f"{ONE}.zoom(2, 6)")
    tab.js(
        "const box = document.createElement('div'); box.dataset.chart = 'two'; document.body.prepend(box);"
        "ThermoChart.scan(document); ThermoChart.of(box)"
    )
    assert tab.js("document.querySelectorAll('[data-chart=two] .uplot').length") == 1
