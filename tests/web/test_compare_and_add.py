"""Models side by side, an effect added with its progress, cancelled, and what is left when a server dies."""

from __future__ import annotations

import html
import json
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from thermodata.cli import main
from thermodata.errors import UsageError
from thermodata.modelling.comparing import transfer
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.remove import remove
from thermodata.modelling.run import fit
from thermodata.modelling.seen.residual_tests import autocorrelation
from thermodata.report.text.fit import check_text
from thermodata.report.words.glossary import IN_SAMPLE
from thermodata.report.words.numbers import number, typeset
from thermodata.store import Store
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.check import check_store
from thermodata.view.curves.predictions import Prediction
from thermodata.view.curves.residuals import against, predicted_tests, residuals
from thermodata.view.lists.models import model_rows
from thermodata.web.pages.parts.compare_charts import BINS, _row, correlated
from thermodata.web.work import Work

from .client import Client
from .conftest import client_of


def finished(client: Client, text: str, seconds: float = 300.0) -> tuple[str, str | None]:
    """The last fragment of a piece of work, and where the browser is sent."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        at = re.search(r'hx-get="(/task/[^"]+)"', text)
        if at is None:
            onward = re.search(r'data-onward="([^"]+)"', text)
            return text, html.unescape(onward[1]) if onward else None
        answer = client.get(at[1])
        text = answer.text
        # a header would send the browser on again at every look, and away from a page that is slow to come
        assert answer.header("hx-redirect") is None
        time.sleep(0.1)
    raise AssertionError(f"still at work: {text}")


def test_adding_makes_a_version_on_the_same_scale_and_the_one_before_stays(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    first = model_rows(store)[0]
    offer = writer.get(f"/add?model={first.model}&candidate=1").text
    assert re.search(r"<title>Add \w+:\w+ · thermodata</title>", offer), "a tab is found by what it adds, not by a rank"
    assert "Add it</button>" in offer
    assert "fitted to all its open tests" in offer
    answer = writer.post("/task/add", {"model": first.model, "candidate": "1"})
    assert answer.status == 200
    _, onward = finished(writer, answer.text)
    assert onward is not None
    assert onward.startswith("/compare?model=")
    assert [m.version for m in model_rows(store)] == [2, 1]
    added = find_model(store, model_rows(store)[0].model).result
    assert "verification (in-sample)" in {s.role for s in added.scores}  # as the offer said
    carried = {row.test: row.role for row in transfer(store, added.model)}
    assert carried["day1"] == "verification (in-sample)", "nor is it a test of how the model carries over"
    text = writer.get(onward).text
    limits = [json.loads(m)["limit"] for m in re.findall(r'id="heat\d">(.*?)</script>', text)]
    assert len(limits) == 2
    assert limits[0] == limits[1]
    maps = [json.loads(m) for m in re.findall(r'id="heat\d">(.*?)</script>', text)]
    assert {m["axis"]["unit"] for m in maps} == {"h"}, "a stretch is found again on the page of its test"
    assert maps[0]["step"] * max(maps[0]["lengths"]) == pytest.approx(6.0, rel=0.02)
    for one, model in zip(maps, (first.model, model_rows(store)[0].model), strict=True):
        errors = {s.test: s.rmse_um for s in find_model(store, model).result.scores if s.phase == "all"}
        assert one["figures"] == [typeset(number(errors[name])) for name in one["rows"]]
    assert maps[0]["figures_title"] == "error [µm]"
    assert "How the error fell" in text
    assert f'href="/compare?model={first.model}">Back to baseline 1</a>' in text
    assert "where no model is named, pages and commands take the one that was fitted last, baseline 2." in text
    again = re.search(r"which makes it the last: <code>(.*?)</code>", text)[1]
    assert again.endswith(f"fit {first.model}")
    # day1 was kept out of the first version's fit, and helped to choose the effect of the second
    rows = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in re.findall(r"<tr>(.*?)</tr>", text)]
    cells = {re.sub("<[^>]+>", "", row[0]): row[2:4] for row in rows if len(row) > 4 and "/test?" in row[0]}
    assert {test: ["fitted too" in cell for cell in each] for test, each in cells.items()} == {
        "heat1": [False, False],
        "heat2": [False, False],
        "day1": [False, True],
    }
    assert re.search(r"verification [\d.]+ → [\d.]+ µm \(fitted too\) ", text)
    assert f"Fitted too (in-sample): {IN_SAMPLE}" in html.unescape(text)
    # what the fit to more tests does is no merit of what was added
    assert text.count("Fitted to the same tests, the version before leaves") == 1
    day1 = next(row for row in re.findall(r"<tr>(.*?)</tr>", text) if "test=day1" in row and "fitted too" in row)
    assert '<span class="badge">verification, fitted too</span>' in day1, "in no colour of a verification"
    assert not re.search('class="(good|bad)"', day1)
    assert "In neither: tests to which one model was fitted and the other was not" in text
    assert re.search(
        r"in verification \(fitted too\)</p>", writer.get(f"/missing?model={model_rows(store)[0].model}").text
    )
    # and so say the list of tests and the page of the test
    newest = model_rows(store)[0].model
    listed = re.findall(
        r"<tr>\s*<td class=\"name\"><a[^>]*>(\w+)</a></td>\s*<td data-th=\"role\">(.*?)</td>", writer.get("/").text
    )
    assert {test: "verification, fitted too" in role for test, role in listed if test != "day2"} == {
        "heat1": False,
        "heat2": False,
        "day1": True,
    }
    assert f"Fitted too (in-sample): {IN_SAMPLE}" in html.unescape(writer.get("/").text)
    for model, said in ((newest, True), (first.model, False)):
        page = writer.get(f"/test?campaign=small&test=day1&model={model}").text
        assert ("verification, fitted too" in page) == said
        assert f"compare {model}" in html.unescape(writer.get(f"/?model={model}").text)
    # going back only leaves it: both versions are there, until the first is fitted again, as the page says
    assert "fitted too" not in writer.get(f"/compare?model={first.model}").text
    assert f"compare {newest}" in html.unescape(writer.get("/").text)
    assert main(["--store", str(lab / "thermodata.store"), "fit", first.model, "--json"]) == 0
    assert f"compare {first.model}" in html.unescape(writer.get("/").text)


def test_several_are_added_in_one_version(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    first = model_rows(store)[0]
    answer = writer.post("/task/add", {"model": first.model, "candidate": "1\r\nlag:T_hall"})  # as a browser sends it
    assert "Adding 1 and lag:T_hall" in answer.text
    _, onward = finished(writer, answer.text)
    assert onward is not None
    newest = model_rows(store)[0]
    assert (newest.version, newest.parent) == (2, first.model)
    assert len(newest.terms) == len(first.terms) + 2


def test_it_is_no_fall_where_the_error_rose(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    first = find_model(store, "baseline")
    worse = remove(store, first.model, term_ids(first.spec.effects)[0])
    text = writer.get(f"/compare?model={worse.model}").text
    assert "How the error rose" in text
    assert "How the error fell" not in text


def test_what_fails_is_told_as_in_a_terminal(writer: Client) -> None:
    text, onward = finished(writer, writer.post("/task/add", {"model": "baseline", "candidate": "coolent:T_hall"}).text)
    assert onward is None
    assert 'role="alert"' in text
    assert "coolent" in text
    assert writer.post("/task/add", {"model": "baseline"}).status == 400
    assert writer.post("/task/format_disk", {}).status == 400
    assert writer.get("/task/nothing").status == 400


def test_work_stays_inside_the_chosen_folders(writer: Client, tmp_path_factory: pytest.TempPathFactory) -> None:
    for task, field in (("ingest", "campaign"), ("fit", "path")):
        answer = writer.post(f"/task/{task}", {field: "../elsewhere.yaml"})
        assert answer.status == 400
        assert "outside of the chosen folders" in answer.text
    page = tmp_path_factory.mktemp("elsewhere") / "page.html"
    assert writer.post("/task/report", {"model": "baseline", "out": str(page)}).status == 400
    assert not page.exists()


def test_cancelled_work_leaves_the_store_as_it_was(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    before = [m.model for m in model_rows(store)]
    text = writer.post("/task/add", {"model": "baseline", "candidate": "1"}).text
    cancel = re.search(r'hx-post="(/task/[^"]+/cancel)"', text)[1]
    assert "Cancelled" in writer.post(cancel).text
    time.sleep(0.5)
    assert [m.model for m in model_rows(store)] == before
    assert not check_store(store).damaged


def test_no_more_than_two_at_once(lab: Path) -> None:
    work = Work()
    store = lab / "thermodata.store"
    try:
        for _ in range(2):
            work.start("diagnose", "asking", store, {"model": "baseline"})
        with pytest.raises(UsageError, match="still running"):
            work.start("diagnose", "asking", store, {"model": "baseline"})
    finally:
        work.close()


def test_a_child_ends_with_its_server(lab: Path) -> None:
    store = lab / "thermodata.store"
    request = json.dumps({"task": "ingest", "store": str(store), "arguments": {"campaign": str(lab / "campaign.yaml")}})
    child = subprocess.Popen(
        [sys.executable, "-m", "thermodata.web.child"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert child.stdin is not None
    child.stdin.write(request + "\n")
    child.stdin.close()  # as when the server is killed
    assert child.wait(20) in (0, 1)
    assert not check_store(Store(store)).damaged


def test_the_comparison_shows_only_what_differs(reader: Client) -> None:
    text = reader.get("/compare").text
    assert "Residual over every test" in text
    assert "Nothing differs" in reader.get("/compare?differs=1").text  # one model differs from nothing


def test_what_a_fit_says_of_itself_is_told_as_in_a_terminal(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    spec = find_model(store, "baseline").spec
    tight = [e.model_copy(update={"bounds": {"tau": (1.0, 1.1)}}) for e in spec.effects]
    made = fit(store, spec.model_copy(update={"name": "tight", "effects": tight}))
    said = [check_text(c) for c in made.checks if not c.passed]
    assert any(line.startswith("at_bound:") for line in said)
    text = html.unescape(client_of(lab)[0].get(f"/compare?model={made.model}").text)
    assert f"Worth a look: {len(said)} of tight 1" in text
    assert all(f"<li>{typeset(line)}</li>" in text for line in said)


def test_the_residual_over_a_channel(reader: Client) -> None:
    text = reader.get("/compare?over=spindle_speed").text
    spec = json.loads(re.search(r'id="against">(.*?)</script>', text)[1])
    assert spec["axis"]["unit"] == "rpm"
    assert reader.get("/compare?over=nothing").status == 400


def test_a_response_that_the_model_has_not_is_said_and_not_passed_over(reader: Client) -> None:
    text = html.unescape(reader.get("/compare?response=dY").text)
    assert "has no response 'dY' (it has dZ): what is of one response is of dZ." in text
    assert "has no response" not in reader.get("/compare?response=dZ").text


def test_a_residual_over_its_own_driver_is_found(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = model_rows(store)[0]
    keys = predicted_tests(store, model.model)
    assert keys == [("small", "heat1"), ("small", "heat2"), ("small", "day1")]
    found = against(store, residuals(store, model.model, keys, "dZ"), "T_nut_Z")
    # the baseline lacks the nut: the warmer it is, the more is left over
    assert found.means[-1] - found.means[0] > 3
    assert np.all(np.diff(found.bins) >= 0)


def drawn_correlation(parts: list[Prediction]) -> tuple[np.ndarray, np.ndarray]:
    """(lag [s], correlation) as the page draws them."""
    chart = correlated(parts)
    return np.asarray(chart.x) * 3600, np.asarray(chart.panels[0].series[0].y)


def left(t_s: np.ndarray, residual: np.ndarray, valid: np.ndarray | None = None) -> Prediction:
    there = np.ones(len(t_s), bool) if valid is None else valid
    return Prediction("c", "t", "dZ", t_s, residual, residual, residual, there, {})


def test_noise_forgets_and_a_slow_residual_remembers() -> None:
    rng = np.random.default_rng(0)
    t_s = np.arange(2000) * 60.0
    noise, slow = rng.normal(size=2000), np.sin(2 * np.pi * t_s / 36000)
    valid = np.ones(2000, bool)
    valid[500:600] = False
    _, c = drawn_correlation([left(t_s, noise, valid)])
    assert c[0] == pytest.approx(1.0)
    assert np.abs(c[1:]).max() < 0.1
    lag, c = drawn_correlation([left(t_s, slow, valid)])
    assert c[np.isclose(lag, 9000.0)] == pytest.approx(0.0, abs=0.1)
    assert c[np.isclose(lag, 18000.0)] == pytest.approx(-1.0, abs=0.1)


def test_a_drift_over_the_whole_test_correlates_by_no_more_than_one() -> None:
    t_s = np.arange(360) * 60.0  # as long as the longest lag: a handful of pairs at its end
    drift = np.linspace(-1.0, 1.0, 360)
    lag, c = drawn_correlation([left(t_s, drift), left(t_s, 3 * drift)])
    assert c[0] == pytest.approx(1.0)
    assert np.all(np.abs(c) <= 1.0)
    # the figure of the report, of `show` and of Python
    assert c == pytest.approx(autocorrelation([drift, 3 * drift], len(lag) - 1))
    assert len(drawn_correlation([left(t_s[:1], drift[:1])])[0]) == 1


def test_a_strip_is_as_long_as_its_test_and_its_cells_are_means_of_what_was_measured() -> None:
    fine = np.array([1.0, 3.0, np.nan, 5.0, np.nan, np.nan])
    row = _row(fine, 3)
    assert row[:3] == pytest.approx([2.0, 5.0, np.nan], nan_ok=True)
    assert row.shape == (BINS,)
    assert np.isnan(row[3:]).all()
    assert np.isnan(_row(None, 3)).all(), "a test that the model does not predict"


def test_contributions_stand_beside_each_other_on_one_scale(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    alone = writer.get("/compare").text
    assert "What each effect gives in" in alone  # one model: its own
    assert "bands apart for" not in alone
    _, onward = finished(writer, writer.post("/task/add", {"model": "baseline", "candidate": "1"}).text)
    before = store.connect().execute("select count(*) from locked_look").fetchall()
    text = writer.get(f"{onward}&test=small%2Fheat1").text
    spec = json.loads(re.search(r'id="shares1">(.*?)</script>', text)[1])
    old, new, apart = spec["panels"]
    assert old["range"] == new["range"]
    assert apart["title"].endswith("on its own scale")
    added = set(model_rows(store)[0].terms) - set(model_rows(store)[1].terms)
    assert added == {s["label"] for s in new["series"]} - {s["label"] for s in old["series"]}
    assert added <= {s["label"] for s in apart["series"]}
    assert "spindle_bearing (T_bearing)" in {s["name"] for s in old["series"]}, "the key says what drives it"
    assert '<td class="name">spindle_bearing <small class="muted">(T_\u200bbearing)</small>' in text
    # an effect has one colour here and on the page of the test
    chart = writer.get("/test?campaign=small&test=heat1").text
    shares = json.loads(re.search(r'id="chart">(.*?)</script>', chart)[1])["panels"][2]
    assert "contributions" in shares["title"]
    assert {s["name"]: s["colour"] for s in new["series"]} == {s["name"]: s["colour"] for s in shares["series"]}
    assert all(s["band"] for s in new["series"])
    assert "not in it" in text
    assert "--contributions heat1" in text
    only = json.loads(re.search(r'id="shares1">(.*?)</script>', writer.get(f"{onward}&differs=1").text)[1])
    assert {s["name"] for s in only["panels"][1]["series"]} == {s["name"] for s in only["panels"][2]["series"]}
    # a locked test has no stored prediction: it is refused, and no look is counted
    assert writer.get(f"{onward}&test=small%2Fday2").status == 400
    assert 'value="small/day2"' not in text
    assert store.connect().execute("select count(*) from locked_look").fetchall() == before


def test_a_model_that_its_data_left_behind_says_so_on_every_page_that_shows_it(writer: Client, lab: Path) -> None:
    """And no difference to it stands there with its 95 %: that would be one of the data."""
    store = Store(lab / "thermodata.store")
    first = model_rows(store)[0].model
    finished(writer, writer.post("/task/add", {"model": first, "candidate": "1"}).text)
    newest = model_rows(store)[0].model
    pages = [f"/compare?model={newest}&pin={first}", f"/test?campaign=small&test=day1&model={first}"]
    assert not any("stale: the data of" in writer.get(page).text for page in pages)
    assert "with its 95 %: samples" in writer.get(pages[0]).text
    path = lab / "campaign.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace("gain: 1 um", "gain: 1.01 um", 1), encoding="utf-8")
    assert ingest(store, path).stale
    for page in pages:
        assert f"stale: the data of baseline {first} changed since it was fitted" in writer.get(page).text
    assert "No differences with their 95 %" in writer.get(pages[0]).text
    assert "with its 95 %: samples" not in writer.get(pages[0]).text
