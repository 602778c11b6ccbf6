from __future__ import annotations

import dataclasses
import json
import os
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast
from unittest import mock

import numpy as np
import pytest

from thermodata.chart import Strip
from thermodata.report.charts.figures import part_chart, points_for, residual_scale
from thermodata.report.collected.data import ReportData
from thermodata.report.page.error_rows import error_rows, headline_error
from thermodata.report.page.headline import error_sentence, first_sentences, headline, sentences
from thermodata.report.page.left_over import what_is_left
from thermodata.report.page.page import render
from thermodata.report.words.glossary import ERRORS
from thermodata.schema.answers.candidate import LeftOut
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.result import Check, Parameter
from thermodata.schema.answers.undetermined import Undetermined

from .conftest import diagnosis

_FIGURE = re.compile(r'<script type="application/json" id="(\w+)">(.*?)</script>', re.S)


def body(page: str) -> str:
    """The page without its script."""
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
    assert not re.search(r"\sstyle=|\son\w+=", body(page)), "the policy refuses what is inline"
    assert len(page) < 400_000
    figures = {key: json.loads(text) for key, text in _FIGURE.findall(page)}
    assert set(figures) == {"overview", "test0", "test1", "test2"}
    for text in ("Missing in dZ was feed_screw", "day2 1 time", "jump_z", "µm/K", "collinear", "feed_motor:T_motor_Z"):
        assert text in body(page)


def test_the_headline_says_what_was_missing_what_else_it_could_be_and_one_error(data: ReportData) -> None:
    assert headline(data) == "Missing in dZ was feed_screw (T_nut_Z), not told from feed_motor (T_motor_Z)"
    assert error_sentence(data) == "The error on locked tests falls: 4.60 -> 0.950 um (-79 %)"


@pytest.mark.parametrize(
    ("low", "high", "told"),
    [(146.7, None, "147 …"), (None, 9.5, "… 9.50"), (1.5, 2.5, "1.50 … 2.50"), (None, None, "not determined")],
)
def test_an_interval_is_told_as_the_fit_tells_it(
    low: float | None, high: float | None, told: str, data: ReportData
) -> None:
    """At one end, too, and what these tests set no end to."""
    given = {"ambient_frame.tau": Parameter(value=2.0, unit="min", low=low, high=high)}
    open_ = Check(name="not_determined:ambient_frame.tau", value=2.0, threshold=None, passed=False, advice="longer")
    page = body(render(dataclasses.replace(data, parameters=given, checks=[open_])))
    row = re.search(r"<td>tau</td>.*?</tr>", page)
    assert row is not None
    assert re.sub("<[^>]+>", "", row[0]).endswith(told)


def test_without_a_parent_the_headline_is_the_verdict(blind: ReportData) -> None:
    _keep(render(blind), "before")
    assert headline(blind).startswith("dZ misses feed_screw (T_nut_Z), not told from feed_motor (T_motor_Z)")
    assert error_sentence(blind) == "The error on locked tests is 4.60 um"


def test_every_error_of_a_page_stands_under_its_word_and_one_heads_it(data: ReportData) -> None:
    rows = {r.word: (r.before, r.after) for r in error_rows(data)}
    assert list(rows) == [w for w in ERRORS if w in rows]
    assert rows["locked"] == (4.6, 0.95)
    assert rows["left-out"] == (4.2, 0.9)
    assert rows["verification"] == pytest.approx((4.6, 1.1))
    assert rows["fitted"] == pytest.approx((4.0503, 0.8515), abs=1e-3)
    text = body(render(data))
    for word in rows:
        assert ERRORS[word] in text
    assert text.count('<tr class="head">') == 1


def test_on_a_narrow_screen_an_error_keeps_its_unit(data: ReportData, blind: ReportData) -> None:
    """There a cell has its own label, for the heads of the table are gone."""
    labels = re.findall(r'data-label="([^"]*)"', body(render(data)) + body(render(blind)))
    errors = {one for one in labels if one.split(" ")[0] in ("RMSE", "before", "after", "max", "PTP")}
    assert {"RMSE [µm]", "before [µm]", "after [µm]"} <= errors
    assert all(one.endswith("[µm]") for one in errors)


def test_a_row_says_once_that_its_tests_are_those_of_the_calibration(data: ReportData) -> None:
    text = body(render(data))
    assert "(etve and sp9000)" in text
    assert "calibration tests: " not in text


def test_an_error_of_parts_that_were_left_out_says_so(blind: ReportData) -> None:
    assert blind.diagnosis is not None
    claim = blind.diagnosis.candidates[0]
    part = {"campaign": "demo", "test": "etve", "acts": True, "rmse_um_before": 2.0, "rmse_um_after": 1.0}
    parts = [LeftOut.model_validate({**part, "from_s": k * 600.0, "to_s": k * 600.0 + 600.0}) for k in range(4)]
    found = blind.diagnosis.model_copy(update={"candidates": [claim.model_copy(update={"left_out": parts})]})
    (row,) = (r for r in error_rows(dataclasses.replace(blind, diagnosis=found)) if r.word == "left-out")
    assert row.meaning.startswith("parts of the open tests in turn")
    assert "1 open test is too few to leave one out, so 4 parts of it are" in row.meaning


def test_verification_tests_that_helped_to_choose_are_no_test_any_more(data: ReportData) -> None:
    scores = [s.model_copy(update={"role": "verification (in-sample)"}) if "ver" in s.role else s for s in data.scores]
    rows = error_rows(dataclasses.replace(data, scores=scores, reason=None))
    assert [(r.word, r.tested) for r in rows] == [("verification", False), ("fitted", False)]
    assert headline_error(rows) == rows[0], "what helped to choose effects was fitted with more than what fitted them"
    said = error_sentence(dataclasses.replace(data, scores=scores, reason=None))
    assert said.startswith("The error on verification tests, which are fitted too by now, falls: ")
    page = body(render(dataclasses.replace(data, scores=scores, reason=None)))
    assert '<td class="name">verification, fitted too</td>' in page
    assert '<span class="badge">verification, fitted too</span>' in page, "in no colour of a verification"
    assert "verification, fitted too" not in body(render(data))


def test_verification_tests_are_said_to_be_fitted_for_what_they_were(data: ReportData) -> None:
    """An effect was chosen by two of them, one of which also holds samples of a calibration test."""
    fitted = [s.model_copy(update={"role": "verification (in-sample)"}) for s in data.scores if "ver" in s.role]
    first = fitted[0].model_copy(update={"phase": "all"})
    again = Check(name=f"overlap:{first.campaign}/{first.test}", value=1.0, threshold=0.0, passed=False, advice="")

    def note(*tests: str) -> str:
        scores = [s for s in data.scores if "ver" not in s.role]
        scores += [first.model_copy(update={"test": test}) for test in tests]
        made = dataclasses.replace(data, scores=scores, checks=[again])
        return next(r.notes for r in error_rows(made) if r.word == "verification")

    assert note(first.test) == f"{first.test}; fitted too by now: some hold samples of calibration tests"
    assert note(first.test, "other") == f"{first.test}; fitted too by now: they took part in the choice"


def test_rows_of_errors_name_their_tests_and_which_are_off_by_a_level(data: ReportData) -> None:
    """A test begins with something on: the head says so, for errors on left-out tests do not show it."""
    (test,) = {s.test for s in data.scores if s.role == "verification"}
    said = f"{test} begins with coolant at 1, and the model counts it as switched on there: 7.3 um of error"
    level = Check(
        name=f"on_at_start:demo/{test}", value=0.1, threshold=0.5, passed=False, advice=f"{said}. If so, this"
    )
    off = dataclasses.replace(data, checks=[level])
    plain = {r.word: r.note for r in error_rows(data)}
    assert (plain["verification"], plain["fitted"]) == (test, "etve and sp9000")
    there = {r.word: r.note for r in error_rows(off)}
    assert (there["verification"], there["fitted"]) == (f"{test}; mostly the level of {test}", plain["fitted"])
    assert f"{said}; errors on left-out tests have their level free" in " ".join(sentences(off))
    assert "level free" not in " ".join(sentences(data))
    alone = " ".join(sentences(dataclasses.replace(off, reason=None, diagnosis=None)))
    assert f"{said}." in alone
    assert "left-out" not in alone, "no left-out error stands beside it"


@pytest.mark.parametrize(
    ("errors", "name", "note"),
    [
        ({("dZ", "big"): 12.0, ("dZ", "small"): 10.0}, "dZ/demo/big", "big and small; mostly the level of big"),
        ({("dZ", "big"): 12.0, ("dZ", "small"): 0.4}, "dZ/demo/small", "big and small"),
        ({("dZ", "big"): 12.0, ("dX", "big"): 0.4}, "dX/demo/big", "big"),
        ({("dZ", "big"): 12.0}, "dZ/ademo/big", "big"),
    ],
)
def test_a_row_is_mostly_the_level_of_tests_that_make_most_of_it(
    data: ReportData, errors: dict[tuple[str, str], float], name: str, note: str
) -> None:
    like = next(s for s in data.scores if s.role == "verification" and s.phase == "all")
    scores = [like.model_copy(update={"response": r, "test": t, "rmse_um": e}) for (r, t), e in errors.items()]
    check = Check(name=f"on_at_start:{name}", value=0.1, threshold=0.5, passed=False, advice="")
    units = {"dX": "K", "dZ": "um"}
    made = dataclasses.replace(
        data, scores=scores, before=[], checks=[check], responses=("dZ", "dX"), units=units, unit="um"
    )
    assert [r.note for r in error_rows(made) if r.word == "verification"] == [note]


def test_an_effect_that_nobody_claims_says_so(data: ReportData) -> None:
    added = dataclasses.replace(data, reason=diagnosis("none"))
    assert headline(added) == "feed_screw was added to baseline, and no diagnosis claims it"


@pytest.mark.parametrize("holds", [True, False])
def test_what_the_locked_tests_said_of_a_choice_is_told(holds: bool, data: ReportData) -> None:
    asked = Confirmed(
        model="b1", response="dZ", candidate="feed_screw:T_nut_Z", holds=holds, locked_rmse_um_before=11.7,
        locked_rmse_um_after=7.04, parameters={}, tests=[], looks=1,
    )  # fmt: skip
    added = dataclasses.replace(data, reason=diagnosis("none"), by_choice=(asked,))
    chosen = "feed_screw was added to baseline by choice, and holds on the locked tests"
    assert (headline(added) == chosen) is holds
    held = "holds" if holds else "does not hold"
    assert any(f"Asked by choice, feed_screw:T_nut_Z {held} on the locked tests" in line for line in sentences(added))


@pytest.mark.parametrize("offered", [True, False])
def test_what_was_offered_as_a_refinement_is_told_so(offered: bool, data: ReportData) -> None:
    said = headline(dataclasses.replace(data, reason=diagnosis("none"), offered=offered))
    assert ("a refinement that its diagnosis offered" in said) is offered
    assert ("no diagnosis claims it" in said) is not offered


def test_further_rows_are_not_said_to_explain_less(data: ReportData) -> None:
    """What refines comes first, and what gives most of the rest may stand below."""
    reason = diagnosis()
    rows = [reason.candidates[0].model_copy(update={"rank": i, "id": f"c{i}"}) for i in range(1, 9)]
    page = body(render(dataclasses.replace(data, reason=reason.model_copy(update={"candidates": rows}))))
    assert "2 more</summary>" in page
    assert "explain less" not in page


@pytest.mark.parametrize(("twins", "folded"), [(4, False), (5, True)])
def test_many_that_it_cannot_be_told_from_are_folded_and_all_of_them_there(
    twins: int, folded: bool, data: ReportData
) -> None:
    reason = diagnosis()
    row = reason.candidates[0].model_copy(update={"equivalent": [f"lag:T_{i}" for i in range(twins)]})
    page = body(render(dataclasses.replace(data, reason=reason.model_copy(update={"candidates": [row]}))))
    cell = page[page.index('class="ids"') :]
    cell = cell[: cell.index("</td>")]
    assert cell.count("lag:<wbr>T_") == twins
    assert (f"and {twins - 3} more</summary>lag:<wbr>T_<wbr>3" in cell) is folded


def test_noise_is_named_with_its_averaging_time_beside_what_is_systematic(data: ReportData) -> None:
    left = {what: note for what, _, note in what_is_left(data)}
    assert "how far a mean of 30 s scatters about its course by chance" in left["noise"]
    figures = {what: float(figure) for what, figure, _ in what_is_left(data)}
    assert figures["of it, in means of 30 min"] < figures["left over in all open tests"]
    limits = part_chart(data.tests[0], [], {}, 0.7, "um", 1200).panels[1].limits  # type: ignore[union-attr]
    assert limits[0].label == "noise of 30 s means ±0.70\u00a0µm"


@pytest.mark.parametrize(
    ("minutes", "role", "told"),
    [
        (60, "calibration", False),
        (61, "calibration", True),
        (60, "verification", True),
        (60, "verification (in-sample)", True),
    ],
)
def test_what_is_slow_is_told_of_tests_that_are_long_enough_to_have_it(
    data: ReportData, minutes: int, role: str, told: bool
) -> None:
    """A fit leaves a short test's mean at zero, not that of a test which it foretells from its first samples."""
    one = data.tests[0]
    rows = round(60 * minutes / one.step_s)
    short = dataclasses.replace(data, tests=[dataclasses.replace(one, residual=one.residual[:rows], role=role)])
    assert ("of it, in means of 30 min" in {what for what, _, _ in what_is_left(short)}) is told


def test_the_heat_map_keeps_the_scale_of_the_first_version(data: ReportData, blind: ReportData) -> None:
    figures = dict(_FIGURE.findall(render(dataclasses.replace(data, first=blind.tests))))
    first, now = json.loads(figures["first"]), json.loads(figures["overview"])
    assert first["limit"] == now["limit"] == residual_scale([t.residual for t in blind.tests])
    assert now["limit"] > 3 * residual_scale([t.residual for t in data.tests])
    assert now["targets"] == ["test0", "test1", "test2"]


def test_weak_spots_are_ranked_by_cost_shaded_in_their_own_test_and_lead_there(blind: ReportData) -> None:
    page = render(blind)
    figures = {key: json.loads(text) for key, text in _FIGURE.findall(page)}
    shaded = {k: [s for s in f["spans"] if s["kind"] == "weak"] for k, f in figures.items() if k.startswith("test")}
    assert [len(shaded[k]) for k in ("test0", "test1", "test2")] == [1, 0, 1]
    assert shaded["test2"][0]["from"] == 11000 / 3600
    assert (shaded["test2"][0]["rank"], shaded["test0"][0]["rank"]) == (1, 2)
    assert f'data-show="test2" data-from="{11000 / 3600}"' in page


def test_a_page_of_many_tests_draws_fewer_points(data: ReportData) -> None:
    assert points_for(data.tests) == 1200
    assert points_for(data.tests * 12) < 700
    assert points_for(data.tests * 1000) == 240


def test_states_are_drawn_where_they_change(data: ReportData) -> None:
    spec = part_chart(data.tests[0], [], {}, None, "um", 1200)
    (speed,) = (p.series for p in spec.panels if isinstance(p, Strip) and p.series.name == "spindle_speed")
    assert len(speed.y) < 60
    hours = np.asarray(speed.x)
    assert np.interp(hours, np.arange(1680) / 120, data.tests[0].lanes[0].values) == pytest.approx(speed.y, abs=4501)
    assert (hours[0], hours[-1]) == pytest.approx((0.0, 1679 / 120), abs=0.02), "from the first block to the last"


def test_texts_from_data_can_not_break_the_page(data: ReportData) -> None:
    evil = "</script><script>alert(1)</script>"
    tests = (dataclasses.replace(data.tests[0], test=evil, conditions={evil: evil}), *data.tests[1:])
    page = render(dataclasses.replace(data, tests=tests, name=evil, machine=evil, responses=(evil,)))
    assert evil not in page
    assert "alert(1)" in page


def test_a_model_without_tests_or_diagnosis_still_has_a_page(data: ReportData) -> None:
    bare = dataclasses.replace(data, tests=(), scores=[], before=[], versions=(), reason=None, calibrations=())
    assert "No test of this model can be predicted" in render(bare)


def test_what_is_slow_is_no_more_than_all_that_is_left(data: ReportData) -> None:
    """A short calibration test has its zero in both rows."""
    one = data.tests[0]
    fitted = dataclasses.replace(one, residual=np.tile([-0.1, 0.1], 50), role="calibration")
    foretold = dataclasses.replace(one, residual=np.full(1000, 5.0), role="verification")
    figures = {
        what: float(figure)
        for what, figure, _ in what_is_left(dataclasses.replace(data, tests=[fitted] * 10 + [foretold]))
    }
    assert figures["of it, in means of 30 min"] <= figures["left over in all open tests"]


@pytest.mark.parametrize("ends", [5.0, np.nan])
def test_a_mean_of_one_sample_weighs_as_one_sample(data: ReportData, ends: float) -> None:
    """A test seldom ends with a whole half hour: the noise of its last sample is nothing slow."""
    residual = np.tile([-0.1, 0.1], 300)
    residual[1::60] = np.nan
    one = dataclasses.replace(data.tests[0], step_s=30.0, residual=np.append(residual, ends), role="verification")
    figures = {what: float(figure) for what, figure, _ in what_is_left(dataclasses.replace(data, tests=[one]))}
    whole = one.residual[np.isfinite(one.residual)]
    assert figures["left over in all open tests"] == pytest.approx(np.sqrt(np.mean(whole**2)), rel=0.01)
    expected = np.sqrt(25.0 / len(whole)) if ends == 5.0 else 0.0
    assert figures["of it, in means of 30 min"] == pytest.approx(expected, abs=0.01)


def test_a_minus_is_one_sign_in_values_and_ranges(data: ReportData) -> None:
    cells = re.search(r'<td class="n">−2.410?</td><td>[^<]*</td><td>([^<]*)</td>', render(data))
    assert cells is not None
    assert "-" not in cells[1]
    assert cells[1].startswith("−2.5")


def test_a_state_that_the_residual_does_not_go_with_is_named_and_not_drawn(data: ReportData) -> None:
    states = [SimpleNamespace(state=name, correlation=r) for name, r in (("T_hall", 0.004), ("feed", -0.42))]
    seen = SimpleNamespace(paths=[], not_shown=[], ljung_box=[], states=states)
    with mock.patch("thermodata.report.page.drawn.system_charts", return_value={}):
        page = render(dataclasses.replace(data, systems=(cast(Any, seen),)))
    assert "feed: r −0.42" in page
    assert "T_hall: r" not in page
    assert "It does not go with T_hall." in page


def test_legends_say_what_drives_an_effect_and_the_ends_of_lines_its_id(data: ReportData) -> None:
    named = {"spindle_bearing": "spindle_bearing (T_brg)"}
    page = render(dataclasses.replace(data, driven=named))
    panels = json.loads(dict(_FIGURE.findall(page))["test0"])["panels"]
    keys = {s["label"]: s["name"] for p in panels if "contributions" in p["title"] for s in p["series"]}
    assert keys["spindle_bearing"] == "spindle_bearing (T_brg)"
    assert "</i>spindle_bearing (T_brg)</span>" in page


def test_behind_each_strip_stands_its_error(data: ReportData) -> None:
    overview = json.loads(dict(_FIGURE.findall(render(data)))["overview"])
    assert overview["figures_title"] == "RMSE [µm]"
    left = [t.residual[np.isfinite(t.residual)] for t in data.tests]
    assert [float(text) for text in overview["figures"]] == pytest.approx(
        [np.sqrt(np.mean(r**2)) for r in left], rel=0.01
    )


def test_the_head_says_what_to_act_by_and_folds_the_evidence(data: ReportData, blind: ReportData) -> None:
    """Up to fifteen paragraphs stood above the first figure."""
    for page in (data, blind):
        html, at_once = render(page), first_sentences(page)
        head = html[html.index("<header") : html.index("</header>")]
        open_part, _, folded = head.partition("<details data-print>")
        assert len(at_once) <= 4
        assert set(at_once) <= set(sentences(page))
        assert open_part.count("<p") == len(at_once) + bool(page.diagnosis and page.diagnosis.next_test)
        assert folded.count("<p>") == len(sentences(page)) - len(at_once)
        assert html.index('id="where"') < html.index('id="errors"'), "the figure comes first"


def test_what_to_do_next_stands_in_the_head(blind: ReportData) -> None:
    assert blind.diagnosis is not None
    asked = dataclasses.replace(blind, diagnosis=blind.diagnosis.model_copy(update={"next_test": "a cold start"}))
    head = render(asked).partition("</header>")[0]
    assert "<b>What to do next:</b> a cold start" in head
    without = dataclasses.replace(blind, diagnosis=blind.diagnosis.model_copy(update={"next_test": None}))
    assert "What to do next" not in render(without)


def test_what_the_fit_leaves_open_stands_in_the_head(blind: ReportData) -> None:
    assert blind.diagnosis is not None
    gain = Parameter(value=3.0, unit="um/K", low=-1.0, high=7.0)
    one = Undetermined(effect="screw", drivers=["T"], gains={"screw.gain": gain}, does_um=0.1)
    unsure = dataclasses.replace(blind, diagnosis=blind.diagnosis.model_copy(update={"undetermined": [one]}))
    assert any("do not determine screw (3.00 um/K, 95 %: -1.00 to 7.00)" in line for line in first_sentences(unsure))
