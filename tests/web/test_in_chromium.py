"""The workbench in a real browser: the story by mouse and by keys, no request elsewhere, no complaint of the page."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from thermodata.store import Store
from thermodata.view.lists.models import model_rows

from ..chromium import Chromium, Page, PageLeftError

PAGES = (
    "/",
    "/test?campaign=small&test=heat1",
    "/test?campaign=small&test=day2",
    "/trace?campaign=small&test=heat1&channel=dZ&at=3600",
    "/missing",
    "/compare?over=spindle_speed",
    "/add?model=baseline&candidate=1",
    "/confirm?model=baseline&candidate=lag:T_hall",
    "/sql?q=select+t_s,+value+from+signal('small','heat1','dZ')",
    "/start",
    "/report",
)


# nothing is wider than the window; charts follow a window that narrows a moment later
FITS = "document.readyState === 'complete' && document.documentElement.scrollWidth <= innerWidth"


@dataclass(frozen=True)
class Served:
    """A workbench in a process of its own, and a tab that it let in."""

    page: Page
    origin: str
    lab: Path
    process: subprocess.Popen[str]

    def go(self, path: str) -> None:
        self.page.go(self.origin + path)

    def press(self, selector: str) -> None:
        self.page.press(selector)


@contextmanager
def workbench(lab: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A process of its own over a lab, and the address that lets a browser in."""
    process = subprocess.Popen(
        [sys.executable, "-m", "thermodata", "workbench", str(lab), "--write", "--no-browser", "--json"],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        text = ""
        while not text.rstrip().endswith("}"):
            text += process.stdout.readline()
        yield process, json.loads(text)["address"]
    finally:
        process.kill()
        process.wait()


@contextmanager
def tab(chromium: Chromium, address: str) -> Iterator[Page]:
    page = chromium.open(address)
    try:
        page.wait("location.pathname === '/' && document.readyState === 'complete'")
        yield page
    finally:
        page.close()


@pytest.fixture
def served(lab: Path, chromium: Chromium) -> Iterator[Served]:
    with workbench(lab) as (process, address), tab(chromium, address) as page:
        yield Served(page, f"http://{urlsplit(address).netloc}", lab, process)


@pytest.fixture(scope="module")
def reading(made_lab: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[Chromium], Served]]:
    """Lets each browser in once, to a workbench over the same lab."""
    lab = tmp_path_factory.mktemp("read") / "lab"
    shutil.copytree(made_lab, lab)
    with ExitStack() as kept:
        made: dict[Chromium, Served] = {}

        def of(chromium: Chromium) -> Served:
            if chromium not in made:
                process, address = kept.enter_context(workbench(lab))
                first = kept.enter_context(tab(chromium, address))
                made[chromium] = Served(first, f"http://{urlsplit(address).netloc}", lab, process)
            return made[chromium]

        yield of


@pytest.fixture
def read(reading: Callable[[Chromium], Served], chromium: Chromium) -> Iterator[Served]:
    """As `served`, over the workbench of all tests that change nothing."""
    shared = reading(chromium)
    with tab(chromium, shared.origin + "/") as page:
        yield replace(shared, page=page)


def looks(lab: Path) -> int:
    row = Store(lab / "thermodata.store").connect().execute("select count(*) from locked_look").fetchone()
    assert row is not None
    return int(row[0])


def test_every_page_wide_narrow_light_and_dark(read: Served) -> None:
    """No complaint, no request elsewhere, nothing wider than the window; looking opens no lock."""
    before = looks(read.lab)
    for path in PAGES:
        for width, dark in ((1280, False), (390, True)):
            read.page.look(width, 900, dark)
            read.go(path)
            read.page.js("document.querySelectorAll('[data-chart]').forEach(b => ThermoChart.of(b))")
            read.page.wait(FITS, timeout_s=60)
    assert read.page.complaints() == []
    assert {urlsplit(u).netloc for u in read.page.requests()} == {urlsplit(read.origin).netloc}
    assert looks(read.lab) == before


def test_long_names_leave_the_error_and_the_residual_in_sight(read: Served) -> None:
    for width in (1400, 1100):
        read.page.look(width, 900)
        read.go("/")
        read.page.js(
            "document.querySelectorAll('td.name a').forEach(a => { a.textContent = 'warm_up_'.repeat(6); });"
            "document.querySelectorAll('[data-th=conditions]').forEach(c => { c.textContent = 'speed 9, '.repeat(6); })"
        )
        assert read.page.js("(t => t.scrollWidth <= t.clientWidth)(document.querySelector('#tests > .scroll'))")


def test_long_names_of_views_stay_in_their_panel(read: Served) -> None:
    read.page.look(1400, 900)
    read.page.go(read.origin + "/sql")
    read.page.js(
        "(s => { s.textContent = 'wide_' + 'a_campaign_with_a_long_name_'.repeat(3); })"
        "(document.querySelector('.views summary'))"
    )
    assert read.page.js("(v => v.scrollWidth <= v.clientWidth)(document.querySelector('.views'))")


def test_the_keys_of_a_chart_are_as_low_as_their_text(read: Served) -> None:
    """Rows of many keys stood two lines apart: the page's buttons are higher."""
    read.go("/test?campaign=small&test=heat1")
    read.page.js("ThermoChart.of(document.getElementById('plot'))")
    assert read.page.js("document.querySelector('.tc-key').getBoundingClientRect().height") < 20


# pairs of texts or charts that lie over each other, and what stands out of the paper; none is good
OVERLAPS = """(() => {
  const found = [], boxes = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const text = walk.currentNode.textContent.trim(), own = walk.currentNode.parentElement;
    if (!text || !own.checkVisibility() || own.closest('svg, script, [data-chart], option, .skip')) continue;
    const range = document.createRange(); range.selectNodeContents(walk.currentNode);
    for (const r of range.getClientRects()) if (r.width > 1 && r.height > 1) boxes.push([text.slice(0, 40), r]);
  }
  for (const e of document.querySelectorAll('[data-chart]'))
    if (e.checkVisibility()) boxes.push(['chart ' + e.dataset.chart, e.getBoundingClientRect()]);
  boxes.sort((a, b) => a[1].top - b[1].top);
  for (let i = 0; i < boxes.length; i++) {
    const [name, a] = boxes[i];
    if (a.right > innerWidth + 1) found.push(name + ' stands out of the paper');
    for (let k = i + 1; k < boxes.length && boxes[k][1].top < a.bottom - 3; k++) {
      const b = boxes[k][1];
      if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 3 && Math.min(a.bottom, b.bottom) - b.top > 3)
        found.push(name + ' over ' + boxes[k][0]);
    }
  }
  return found;
})()"""


def test_pages_print_without_overlaps(read: Served, tmp_path: Path) -> None:
    for i, path in enumerate(("/", "/test?campaign=small&test=heat1", "/missing", "/compare")):
        read.go(path)
        read.page.wait("document.readyState === 'complete'")
        read.page.paper()
        assert read.page.js(OVERLAPS) == [], path
        read.page.paper(False)
        read.page.pdf(tmp_path / f"{i}.pdf")
        assert (tmp_path / f"{i}.pdf").read_bytes().startswith(b"%PDF")
    assert read.page.complaints() == []


# texts whose contrast with what they lie on (WCAG 2, fading included) is under 4.5
PALE = """(() => {
  const numbers = text => text.match(/[\\d.]+/g).map(Number);
  const light = c => c.slice(0, 3).map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0.05);
  const over = (top, share, below) => top.slice(0, 3).map((v, i) => v * share + below[i] * (1 - share));
  const ground = e => {
    const layers = [];
    for (; e; e = e.parentElement) {
      const c = numbers(getComputedStyle(e).backgroundColor), share = c.length > 3 ? c[3] : 1;
      if (share) layers.push([c, share]);
      if (share === 1) break;
    }
    return layers.reverse().reduce((below, [c, share]) => over(c, share, below), [255, 255, 255]);
  };
  const found = new Set(), walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const own = walk.currentNode.parentElement, text = walk.currentNode.textContent.trim();
    if (!text || !own.checkVisibility() || own.closest('svg, script, option, .skip, [disabled]')) continue;
    let share = 1;
    for (let e = own; e; e = e.parentElement) share *= Number(getComputedStyle(e).opacity);
    const below = ground(own), ink = over(numbers(getComputedStyle(own).color), share, below);
    const [low, high] = [light(ink), light(below)].sort((a, b) => a - b);
    if (high / low < 4.5) found.add(`${own.tagName} ${own.className}: ${text.slice(0, 30)} ${(high / low).toFixed(1)}`);
  }
  return [...found];
})()"""


@pytest.mark.parametrize("dark", [False, True])
def test_every_text_stands_out_of_what_it_lies_on(read: Served, dark: bool) -> None:
    read.page.look(1280, 900, dark)
    for path in PAGES:
        read.go(path)
        read.page.js("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        read.page.js("document.querySelectorAll('table.bars tbody tr').forEach(row => row.classList.add('rests'))")
        assert read.page.js(PALE) == [], path


def test_the_search_for_overlaps_finds_one(chromium: Chromium) -> None:
    page = chromium.open("data:text/html,<p>one</p><p style='margin-top:-1.7em'>two</p><p>three</p>")
    try:
        assert page.js(OVERLAPS) == ["one over two"]
    finally:
        page.close()


@pytest.mark.parametrize("after_ms", [0, 20, 40, 60, 100])
def test_a_page_that_is_left_while_it_is_asked(chromium: Chromium, tmp_path: Path, after_ms: int) -> None:
    """A click has reached the page that it leaves, and who waits waits for the next one; who asks is told."""
    (tmp_path / "there.html").write_text("<p id=there>there</p>")
    leave = f"setTimeout(() => location.assign('there.html?' + Math.random()), {after_ms})"
    (tmp_path / "here.html").write_text(f'<button onclick="{leave}">go</button>')
    page = chromium.open((tmp_path / "here.html").as_uri())
    try:
        page.press("button")
        page.wait("document.querySelector('#there')")
        with pytest.raises(PageLeftError):
            page.js(f"{leave}; new Promise(() => 0)")  # in one: a page that was left already would be asked for ever
    finally:
        page.close()


def test_two_tabs_at_once(served: Served, chromium: Chromium) -> None:
    """Each has its own state in its address; what one adds the other sees at its next look, and a second add waits."""
    other = chromium.open(served.origin + "/missing")
    try:
        other.wait("document.querySelector('h1')")
        served.go("/add?model=baseline&candidate=1")
        other.go(served.origin + "/add?model=baseline&candidate=1")
        served.press("form[hx-post='/task/add'] button")
        served.page.wait("document.querySelector('.task') || location.pathname === '/compare'")
        other.js("document.querySelector(\"form[hx-post='/task/add'] button\").click()")
        other.wait("document.querySelector('.task, [role=alert]') || location.pathname === '/compare'")
        served.page.wait("location.pathname === '/compare'")
        models = model_rows(Store(served.lab / "thermodata.store"))
        assert [m.version for m in models] == [2, 1]  # the same addition twice is one version
        other.go(served.origin + "/compare")
        assert "beside" in other.wait("document.querySelector('h1').textContent")
        served.go("/test?campaign=small&test=heat1&from=3600&to=7200")
        assert other.js("location.pathname") == "/compare"
    finally:
        other.close()


def test_axe_finds_no_violation(read: Served) -> None:
    named = os.environ.get("THERMODATA_AXE")
    if not named:
        pytest.skip("no axe-core: name its axe.min.js in THERMODATA_AXE; .ci/run fetches it")
    rules = Path(named).read_text(encoding="utf-8")
    for path in PAGES:
        read.go(path)
        read.page.js(rules + "; 0")
        found = read.page.js(
            "axe.run().then(r => r.violations.map(v => v.id + ': ' + v.nodes.map(n => n.target.join(' ')).join(', ')))"
        )
        assert found == [], path


def test_the_story_by_mouse(served: Served) -> None:
    first = model_rows(Store(served.lab / "thermodata.store"))[0]
    served.press("table.tests td.name a")
    served.page.wait("location.pathname === '/test' && !!document.querySelector('#plot canvas')")
    served.go("/missing")
    assert "issing" in served.page.js("document.querySelector('h1').textContent")
    served.press("a[href^='/add']")
    served.page.wait("location.pathname === '/add'")
    served.press("form[hx-post='/task/add'] button")
    served.page.wait("location.pathname === '/compare'")
    models = model_rows(Store(served.lab / "thermodata.store"))
    assert [m.version for m in models] == [2, 1]
    assert "beside" in served.page.wait("document.querySelector('h1').textContent")
    served.page.look(390, 900)
    served.page.wait(FITS, timeout_s=60)  # two versions beside each other
    cut = "[...document.querySelectorAll('.scroll:has(.stack)')].filter(t => t.scrollWidth > t.clientWidth).length"
    assert served.page.js(cut) == 0, "each figure behind the head of its column, none beyond the edge"
    served.page.look(1200, 900)
    # undo: the version before, and both are still there
    served.press("a.quiet[href*='model=" + first.model + "']")
    served.page.wait(f"location.search.includes('{first.model}')")
    assert len(model_rows(Store(served.lab / "thermodata.store"))) == 2
    assert served.page.complaints() == []


def test_the_way_by_keyboard_alone(read: Served) -> None:
    page = read.page
    page.js("document.querySelector('table.tests td.name a').focus()")
    page.key("Enter")
    page.wait("location.pathname === '/test' && !!document.querySelector('#plot canvas')")
    page.js("document.getElementById('plot').focus()")
    page.key("+")
    page.wait("new URLSearchParams(location.search).has('from')")  # the zoom is in the address
    page.wait("document.getElementById('plot').dataset.refined")
    before = page.js("location.search")
    page.key("0")
    page.wait(f"location.search !== {json.dumps(before)}")
    page.key("Enter")  # back to the file of the point under the cursor
    assert page.complaints() == []


def test_a_zoom_in_the_address_is_shown_again(read: Served) -> None:
    read.go("/test?campaign=small&test=heat1&from=3600&to=7200")
    read.page.wait("ThermoChart.of(document.getElementById('plot')).lo === 1")
    assert read.page.js("ThermoChart.of(document.getElementById('plot')).hi") == 2


def test_a_jump_test_is_drawn_in_the_form(served: Served) -> None:
    folder, t = served.lab, [i / 10 for i in range(600)]
    rows = "".join(f"{x},{5 + (10 <= x < 30) + 0.5 * (20 <= x < 40)}\n" for x in t)
    (folder / "raw" / "jump_Z.csv").write_text(f"time [s],Eddy Z [V]\n{rows}")
    path = folder / "campaign.yaml"
    line = '  jump_Z: {kind: jump, axis: Z, source: log, file: raw/jump_Z.csv, signal: "Eddy Z", moves: unknown}'
    path.write_text(path.read_text().replace("calibrations:\n", f"calibrations:\n{line}\n"))
    served.go("/start")
    served.page.wait("document.querySelectorAll('.steps input').length === 4")
    served.page.wait("document.querySelector('.question.wide [data-chart] canvas')")
    for i, move in enumerate(("100 um", "50 um", "-100 um", "-50 um")):
        served.page.js(f"document.querySelectorAll('.steps input')[{i}].value = {json.dumps(move)}")
    served.press("#answers button[type=submit]")
    served.page.wait("document.querySelector('#diff .diff')?.textContent.includes('-100 um')")
    assert served.page.complaints() == []


def test_what_is_written_renews_the_questions_above(served: Served) -> None:
    path = served.lab / "campaign.yaml"
    path.write_text(path.read_text().replace("role: verification", "role: none", 1))
    served.go("/start")
    assert served.page.js("document.getElementById('asks').textContent") == "1 question that only you can answer"
    field = (
        "[...document.querySelectorAll('#answers select')].find(s => s.name.endsWith('.role') && s.value === 'none')"
    )
    served.page.js(f"{field}.value = 'verification'")
    served.press("#answers button[type=submit]")
    served.page.wait("document.querySelector('#diff .diff')?.textContent.includes('verification')")
    served.press("#diff button[type=submit]")
    served.page.wait("document.getElementById('asks').textContent === 'Every question is answered'")
    assert served.page.js("document.querySelectorAll('#asks, #answers, #model').length") == 3
    assert served.page.js(f"{field} === undefined"), "the form as well"
    assert served.page.complaints() == []


def test_a_dragged_stretch_is_told(read: Served) -> None:
    read.go("/test?campaign=small&test=heat1")
    read.page.wait("document.querySelector('#plot canvas')")
    read.press("#choose")
    x, y, width = read.page.js(
        "(() => { const r = document.querySelector('#plot .u-over').getBoundingClientRect(); "
        "return [r.left, r.top + 20, r.width]; })()"
    )
    read.page.js(
        "new MutationObserver(() => { window.said ||= document.getElementById('range').textContent; })"
        ".observe(document.getElementById('range'), {childList: true})"
    )
    read.page.drag(x + 0.2 * width, x + 0.4 * width, y)
    read.page.wait("document.querySelector('#stretch')")
    assert read.page.js("window.said") == "Reading the stretch …", "while it is worked out, which may take seconds"
    told = read.page.js("document.querySelector('#stretch').textContent")
    assert "samples that count" in told
    assert "window: [" in told
    assert read.page.complaints() == []


def test_searching_narrows_the_list_without_a_reload(read: Served) -> None:
    read.page.js("window.kept = 1; document.getElementById('find').focus()")
    for letter in "day1":
        read.page.key(letter)
    read.page.wait("document.querySelectorAll('table.tests tbody tr').length === 1")
    assert read.page.js("window.kept") == 1
    assert read.page.js("location.search.includes('find=day1')")


def test_a_page_of_another_origin_gets_nothing(read: Served, chromium: Chromium) -> None:
    stranger = chromium.open("data:text/html,<title>elsewhere</title>")
    try:
        assert (
            stranger.js(f"fetch('{read.origin}/', {{credentials: 'include'}}).then(r => 'read', () => 'refused')")
            == "refused"
        )
        assert stranger.js(
            f"fetch('{read.origin}/task/add', {{method: 'POST', credentials: 'include', mode: 'no-cors', "
            "body: 'model=baseline&candidate=1'}).then(r => r.type, () => 'refused')"
        ) in ("opaque", "refused")
    finally:
        stranger.close()
    assert len(model_rows(Store(read.lab / "thermodata.store"))) == 1


def test_the_server_killed_during_an_add_leaves_the_store_whole(served: Served) -> None:
    from thermodata.store.keep.check import check_store

    served.go("/add?model=baseline&candidate=1")
    served.press("form[hx-post='/task/add'] button")
    served.page.wait("document.querySelector('.task') || location.pathname === '/compare'")
    served.process.kill()
    served.process.wait()
    store = Store(served.lab / "thermodata.store")
    assert not check_store(store).damaged
    assert len(model_rows(store)) in (1, 2)


def test_a_line_that_a_stretch_proposes_is_put_into_the_campaign_file(served: Served) -> None:
    served.go("/test?campaign=small&test=heat1")
    served.page.wait("document.querySelector('#plot canvas')")
    served.press("#choose")
    x, y, width = served.page.js(
        "(() => { const r = document.querySelector('#plot .u-over').getBoundingClientRect(); "
        "return [r.left, r.top + 20, r.width]; })()"
    )
    served.page.drag(x + 0.2 * width, x + 0.4 * width, y)
    served.press("#range button[aria-label*='window:']")
    served.page.wait("document.querySelector('#diff .diff')?.textContent.includes('window:')")
    served.press("#diff form[hx-post='/rule/write'] button")
    served.page.wait("document.querySelector('#diff h2')?.textContent.includes('is written')")
    assert "window:" in (served.lab / "campaign.yaml").read_text()
    assert served.page.complaints() == []


def test_work_that_is_done_leads_to_its_result_once(served: Served) -> None:
    """A page that is slow to come is not asked for again and again meanwhile."""
    served.go("/missing")
    before = len(served.page.requests())
    served.go("/add?model=baseline&candidate=1")
    served.press("form[hx-post='/task/add'] button")
    served.page.wait("location.pathname === '/compare' && document.readyState === 'complete'", timeout_s=240)
    asked = [u for u in served.page.requests()[before:] if urlsplit(u).path == "/compare"]
    assert len(asked) == 1


# counts what is asked of the server, and how much of it at once; DELAY [ms] holds each answer back
COUNTED = """(() => {
  const own = window.fetch;
  window.asked = []; window.atOnce = 0; window.most = 0;
  window.fetch = async (...given) => {
    window.asked.push(String(given[0])); window.most = Math.max(window.most, ++window.atOnce);
    try {
      const answer = await own(...given);
      await new Promise(done => setTimeout(done, DELAY));
      return answer;
    } finally { window.atOnce--; }
  };
  window.chart = ThermoChart.of(document.getElementById('plot'));
  // the window [h] that the points of the displacement span; a model's are always sent whole
  window.drawn = () => { const x = chart.panels.find(p => p.title === 'dZ').data[0]; return [x[0], x[x.length - 1]]; };
})()"""


def counted(served: Served, delay_ms: int) -> None:
    served.go("/test?campaign=small&test=heat1")
    served.page.wait("document.querySelector('#plot canvas')")
    served.page.js(COUNTED.replace("DELAY", str(delay_ms)))


def test_a_zoom_is_asked_for_at_once_and_the_newest_wins(read: Served) -> None:
    counted(read, 150)
    page = read.page
    assert page.js("(chart.zoom(1, 2), asked.length)") == 1  # no waiting time before the first
    page.js("for (let i = 1; i <= 20; i++) chart.zoom(1 + i / 50, 3 + i / 50)")
    page.wait("document.getElementById('plot').dataset.refined && atOnce === 0")
    page.wait("asked.length === 2", 30)  # the first and the newest: none between
    assert page.js("asked[1]").endswith("from=5040&to=12240")
    assert page.js("most") == 1
    low, high = page.wait("drawn()[1] < 4 && drawn()", 30)
    assert 1.3 < low < 1.5
    assert 3.3 < high < 3.5
    assert page.complaints() == []


def test_keys_zoom_without_waiting_too(read: Served) -> None:
    counted(read, 100)
    page = read.page
    page.js("document.getElementById('plot').focus()")
    for key in "+++.,":
        page.key(key)
    page.wait("document.getElementById('plot').dataset.refined && atOnce === 0")
    assert page.js("most") == 1
    assert page.js("asked.length") <= 5
    from_h, to_h = page.js("['from', 'to'].map(k => Number(new URLSearchParams(location.search).get(k)) / 3600)")
    assert page.js("[chart.lo, chart.hi]") == pytest.approx([from_h, to_h], abs=1e-3)
    page.wait("drawn()[0] >= chart.lo - 0.02 && drawn()[1] <= chart.hi + 0.02", 30)


def test_what_was_not_loaded_yet_is_never_blank(read: Served) -> None:
    counted(read, 300)
    page = read.page
    page.js("chart.zoom(2, 2.5)")
    page.wait("drawn()[0] > 1.9", 30)
    low, high = page.js("(chart.whole(), drawn())")  # before any answer
    assert low == 0
    assert high > 5.5
    page.wait("asked.length === 2 && atOnce === 0")


def test_a_zoom_that_failed_is_asked_again_by_the_next(read: Served) -> None:
    counted(read, 0)
    page = read.page
    page.js("window.kept = window.fetch; window.fetch = () => Promise.reject(new TypeError('gone'))")
    page.js("chart.zoom(1, 2)")
    page.js("new Promise(done => setTimeout(done, 50))")
    page.js("window.fetch = window.kept; chart.zoom(1.2, 1.8)")
    page.wait("document.getElementById('plot').dataset.refined")
    assert page.js("asked.length") == 1
