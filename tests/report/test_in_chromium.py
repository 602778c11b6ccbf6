"""The saved pages in a real browser: every button is pressed, and nothing is asked of a network, and nothing fails."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from thermodata.report.collected.data import ReportData
from thermodata.report.page.page import render
from thermodata.report.quality.data import TestQuality, Trace
from thermodata.report.quality.page import render as render_quality
from thermodata.schema.flag import Flag

from ..chromium import Chromium, Page

Open = Callable[..., Page]


def quality() -> str:
    bins = 60
    low = np.full(bins, np.nan)
    low[30:] = 54.0
    flags = np.where(np.isfinite(low), int(Flag.OFFSET), 0).astype(np.uint16)
    names = [f"T_{i}" for i in range(18)]
    sound = [
        Trace(n, "temperature", "degC", np.linspace(20, 24 + i, bins), low * np.nan, low * np.nan, flags * 0, 600, 0, 0)
        for i, n in enumerate(names)
    ]
    bad = Trace("T_bad", "temperature", "degC", np.where(flags, np.nan, 21.0), low, low, flags, 600, 300, 0)
    event = {"channel": "T_bad", "source": "daq", "flag": "offset", "from_s": 3e3, "to_s": 6e3, "n": 300, "detail": "x"}
    gap = {"channel": None, "source": "nc", "flag": "gap", "from_s": 100.0, "to_s": 1600.0, "n": 0, "detail": "1500 s"}
    return render_quality([TestQuality("c", "day1", "spindle", 6e3, 0.0, 100.0, (*sound, bad), (gap, event), ())])


@pytest.fixture(params=["after", "before", "unlogged", "quality"])
def page(request: pytest.FixtureRequest, data: ReportData, blind: ReportData, unlogged: ReportData) -> str:
    if request.param == "quality":
        return quality()
    first = dataclasses.replace(data, first=blind.tests)
    return render({"after": first, "before": blind, "unlogged": unlogged}[request.param])


@pytest.fixture
def opened(chromium: Chromium, page: str, tmp_path: Path) -> Iterator[Open]:
    """open(width, height, dark, mobile): the page as it was saved; it may ask for nothing, and nothing may fail."""
    saved = tmp_path / "page.html"
    saved.write_text(page, encoding="utf-8")
    tabs = []

    def open_(**look: object) -> Page:
        tabs.append(chromium.open(saved.as_uri(), **look))  # type: ignore[arg-type]
        return tabs[-1]

    yield open_
    for tab in tabs:
        assert tab.complaints() == []
        assert {url.partition("#")[0] for url in tab.requests()} == {saved.as_uri()}
        tab.close()


PRESS = """(() => {
  document.querySelectorAll('[data-chart]').forEach(b => ThermoChart.of(b));
  const all = [...document.querySelectorAll('button, summary, a, [role=button], input, select')];
  all.forEach(e => { e.focus(); e.click(); });
  document.querySelectorAll('[data-chart]').forEach(b => {
    b.focus();
    ['ArrowRight', '+', 'a', 'ArrowLeft', 'b', '.', ',', '-', '0', 'Enter', 'Escape'].forEach(key =>
      b.dispatchEvent(new KeyboardEvent('keydown', {key: key, bubbles: true})));
    b.querySelectorAll('canvas, .u-over').forEach(c => {
      const r = c.getBoundingClientRect(), at = {bubbles: true, clientX: r.left + r.width / 2, clientY: r.top + 9};
      ['mouseenter', 'mousemove', 'mousedown', 'mouseup', 'click', 'dblclick'].forEach(n =>
        c.dispatchEvent(new MouseEvent(n, at)));
      c.dispatchEvent(new WheelEvent('wheel', {...at, deltaY: -100, cancelable: true}));
    });
  });
  return all.length;
})()"""


def test_every_button_is_pressed_and_nothing_is_asked_or_fails(opened: Open) -> None:
    tab = opened()
    assert tab.js(PRESS) > 10
    assert tab.js(PRESS) > 10, "and once more, from wherever that led"


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_stands_out_of_the_window(opened: Open, width: int, dark: bool) -> None:
    tab = opened(width=width, dark=dark, mobile=width < 500)
    tab.js("document.querySelectorAll('[data-chart]').forEach(b => ThermoChart.of(b))")
    assert tab.js("document.documentElement.scrollWidth") <= width
    wide = (
        "[...document.querySelectorAll('[data-chart] canvas, h1, h2, h3, p, .tc-head, .verdict')].filter(e => "
        f"e.getBoundingClientRect().right > {width} && !e.closest('.scroll')).map(e => e.outerHTML.slice(0, 80))"
    )
    assert tab.js(wide) == []
    ground = tab.js("getComputedStyle(document.body).backgroundColor")
    assert (sum(map(int, ground[4:-1].split(","))) < 200) is dark


# of each table: the contrast (WCAG 2) of the line below a row with what it lies on
ROW_LINES = """[...document.querySelectorAll('section table tbody tr:nth-last-child(2) td:first-child')].map(cell => {
  const light = text => text.match(/[\\d.]+/g).slice(0, 3).map(v => v / 255)
    .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0.05);
  const own = getComputedStyle(cell), on = getComputedStyle(cell.closest('section'));
  const [low, high] = [light(own.borderBottomColor), light(on.backgroundColor)].sort((a, b) => a - b);
  return parseFloat(own.borderBottomWidth) ? high / low : null;
}).filter(c => c !== null)"""


@pytest.mark.parametrize(("dark", "least"), [(False, 1.4), (True, 1.8)])
def test_rows_of_a_table_are_told_apart(opened: Open, dark: bool, least: float) -> None:
    seen = opened(dark=dark).js(ROW_LINES)
    assert seen
    assert min(seen) > least, seen


def test_it_prints_in_light_on_a4_with_every_chart(opened: Open, tmp_path: Path) -> None:
    tab = opened(dark=True)
    tab.js(
        "window.seen = []; window.addEventListener('afterprint', () => "
        "seen.push(document.querySelectorAll('[data-chart].tc').length))"
    )
    tab.pdf(tmp_path / "page.pdf")
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")
    charts = tab.js("document.querySelectorAll('[data-chart]').length")
    assert tab.js("seen") == [charts], "what was never in sight is drawn for paper too"
    tab.js("window.dispatchEvent(new Event('beforeprint'))")
    assert tab.js("document.documentElement.dataset.theme") == "light"
    assert tab.js("Math.max(...[...document.querySelectorAll('[data-chart] .uplot')].map(e => e.offsetWidth))") <= 680
    tab.js("window.dispatchEvent(new Event('afterprint'))")
    assert tab.js("document.documentElement.dataset.theme ?? ''") == ""


def test_everything_that_acts_has_a_name_and_is_reached_by_tab(opened: Open) -> None:
    tab = opened()
    nameless = (
        "[...document.querySelectorAll('button, a, [data-chart].tc')].filter(e => "
        "!(e.getAttribute('aria-label') || e.textContent.trim())).length"
    )
    assert tab.js(nameless) == 0
    reached = set()
    for _ in range(40):
        tab.key("Tab")
        reached.add(tab.js("document.activeElement.className + ' ' + document.activeElement.tagName"))
    assert any("skip" in r for r in reached)
    assert any(r.startswith("tc") for r in reached), reached
    assert any("BUTTON" in r for r in reached)


def test_a_chart_that_was_never_in_sight_is_drawn_where_the_keyboard_comes_to_it(opened: Open) -> None:
    tab = opened()
    tab.js(
        "window.far = document.createElement('div'); far.dataset.chart = document.querySelector('[data-chart]')"
        ".dataset.chart; far.style.marginTop = '9000px'; document.body.append(far); ThermoChart.scan(far.parentNode)"
    )
    assert not tab.js("far.classList.contains('tc')")
    tab.js("far.focus({preventScroll: true})")
    assert tab.js("far.classList.contains('tc') && document.activeElement === far && !!far.getAttribute('aria-label')")


def saved(chromium: Chromium, tmp_path: Path, text: str, **look: object) -> Page:
    path = tmp_path / "one.html"
    path.write_text(text, encoding="utf-8")
    return chromium.open(path.as_uri(), **look)  # type: ignore[arg-type]


@pytest.mark.parametrize("width", [1024, 1400])
def test_candidates_with_long_names_and_their_sentences_are_not_cut(
    chromium: Chromium, blind: ReportData, tmp_path: Path, width: int
) -> None:
    assert blind.diagnosis is not None
    name = "ns_2_s_Chiller_supply_temperature_of_the_second_circuit"
    long = {"id": f"chiller_temperature:{name},{name}2", "drivers": [name, f"{name}2"], "effect": "chiller_temperature"}
    some = [
        c.model_copy(update={**long, "beside": [f"lag:{name}"], "equivalent": [f"lag:{name}{i}" for i in range(9)]})
        for c in blind.diagnosis.candidates
    ]
    told = blind.diagnosis.model_copy(update={"candidates": some})
    tab = saved(chromium, tmp_path, render(dataclasses.replace(blind, diagnosis=told)), width=width)
    widths = "[...document.querySelectorAll('table.candidates')].map(t => [t.offsetWidth, t.parentNode.clientWidth])"
    assert all(own <= room for own, room in tab.js(widths))
    tab.close()


def test_a_weak_spot_leads_to_its_test_zoomed(chromium: Chromium, blind: ReportData, tmp_path: Path) -> None:
    tab = saved(chromium, tmp_path, render(blind))
    tab.js("document.querySelector('[data-show]').click()")
    chart = "ThermoChart.of(document.querySelector('[data-chart=test2]'))"
    low, high = tab.js(f"[{chart}.lo, {chart}.hi]")
    assert (low, high) == pytest.approx((11000 / 3600 - 1.81, 24000 / 3600 + 1.81), abs=0.02)
    tab.wait("document.activeElement.dataset.chart === 'test2'")
    top = tab.wait("document.querySelector('[data-chart=test2]').getBoundingClientRect().top || null")
    assert top < 900
    tab.close()


def test_a_strip_of_the_heat_map_leads_to_its_test(chromium: Chromium, blind: ReportData, tmp_path: Path) -> None:
    tab = saved(chromium, tmp_path, render(blind))
    box = "document.querySelector('[data-chart=overview]')"
    tab.js(f"{box}.scrollIntoView(); ThermoChart.of({box})")
    x, y = tab.js(
        f"(() => {{ const r = {box}.querySelector('canvas').getBoundingClientRect(); return [r.left, r.top] }})()"
    )
    tab.click(x + 600, y + 26 + 10)
    tab.wait("document.activeElement.dataset.chart === 'test1'")
    assert tab.js("ThermoChart.of(document.querySelector('[data-chart=test1]')).at") is not None
    tab.close()


def test_the_policy_lets_nothing_out(chromium: Chromium, data: ReportData, tmp_path: Path) -> None:
    tab = saved(chromium, tmp_path, render(data))
    assert tab.js("fetch('http://127.0.0.1:9/x').then(() => 'sent', e => 'refused')") == "refused"
    tab.js("document.body.append(Object.assign(new Image(), {src: 'http://127.0.0.1:9/x.png'}))")
    tab.js("document.body.append(Object.assign(document.createElement('script'), {text: 'window.ran = 1'}))")
    assert tab.js("window.ran ?? null") is None
    refused = [c for c in tab.complaints() if "Content Security Policy" in c]
    for what in ("Connecting to", "Loading the image", "inline script"):
        assert any(what in c for c in refused), (what, refused)
    tab.close()
