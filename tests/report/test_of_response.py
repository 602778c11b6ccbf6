"""What is said of the response that was diagnosed, and in which unit errors stand on the page."""

from __future__ import annotations

import dataclasses
import json
import re

import pytest

from thermodata.report.collected.data import ReportData
from thermodata.report.collected.lost import lost_of_compared, lost_sentence
from thermodata.report.page.drawn import ranked_spots
from thermodata.report.page.error_rows import error_rows
from thermodata.report.page.headline import sentences
from thermodata.report.page.page import render
from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.words.of_response import of_response, some_of, worst_of
from thermodata.schema.answers.diagnosis import ResponseLeft

from .conftest import diagnosis, score

TWO = [ResponseLeft(response="dZ", left=0.8), ResponseLeft(response="dY", left=0.25)]


def test_of_several_responses_the_text_names_the_one_that_was_asked_and_why() -> None:
    assert of_response(diagnosis()) == ""
    found = diagnosis().model_copy(update={"responses": TWO})
    assert diagnosis_text(found).splitlines()[1] == (
        "  of dZ, of which the model leaves most: 80 % of its variance, of dY 25 %; --response asks of another"
    )
    chosen = found.model_copy(update={"response": "dY", "by_choice": True})
    assert of_response(chosen) == "of dY, as asked; the model leaves 25 % of its variance, of dZ 80 %"


def test_a_page_on_a_temperature_says_no_micrometres(blind: ReportData) -> None:
    kelvin = dataclasses.replace(blind, unit="K", units={"dZ": "K"}, calibrations=())
    text = re.sub(r"<(script|style).*?</\1>", "", render(kelvin), flags=re.DOTALL)
    words = re.sub(r"<[^>]+>", " ", text)
    assert not re.search(r"\d\s(um|µm)(?![/\w])", words)
    assert re.search(r"\d\sK\b", words)


def test_a_page_of_two_responses_says_which_an_error_and_a_weak_spot_are_of(blind: ReportData) -> None:
    spots = diagnosis().weak_spots
    warm = [w.model_copy(update={"rmse_um": 100 * w.rmse_um, "campaign": "other"}) for w in spots]
    found = diagnosis().model_copy(update={"responses": TWO})
    two = dataclasses.replace(
        blind,
        responses=("dZ", "T_nut"),
        units={"dZ": "um", "T_nut": "K"},
        weak={"dZ": spots, "T_nut": warm},
        campaigns=("demo", "other"),
        diagnosis=found,
    )
    # kelvins and micrometres have no common cost
    assert [w.campaign for _, w in ranked_spots(two)] == [*["demo"] * len(spots), *["other"] * len(warm)]
    assert {r.word: r.notes for r in error_rows(two)}["left-out"] == "of dZ"
    page = render(two)
    for heading in ("<th>campaign</th>", "<th>response</th>"):
        assert heading in page
    assert "Of dZ, of which the model leaves most: 80 % of its variance, of dY 25 %." in page


@pytest.mark.parametrize("added", [False, True])
def test_no_error_is_told_before_the_response_that_it_is_of(blind: ReportData, data: ReportData, added: bool) -> None:
    found = diagnosis().model_copy(update={"responses": TWO})
    page = dataclasses.replace(data if added else blind, responses=("dZ", "T_nut"), units={"dZ": "um", "T_nut": "K"})
    lines = sentences(dataclasses.replace(page, diagnosis=found))
    assert lines[0].startswith("The error of dZ on ")
    of = next(i for i, line in enumerate(lines) if line.startswith("Of dZ, of which the model leaves most"))
    assert "left-out tests" in " ".join(lines[of + 1 :])
    assert "left-out tests" not in " ".join(lines[:of])


def test_the_errors_of_a_verdict_that_nothing_is_missing_are_told_behind_its_response(blind: ReportData) -> None:
    clean = diagnosis().model_copy(update={"responses": TWO, "verdict": "none", "candidates": []})
    lines = sentences(dataclasses.replace(blind, responses=("dZ", "T_nut"), diagnosis=clean))
    assert lines[0].startswith("Of dZ, of which the model leaves most")


@pytest.mark.parametrize(
    ("told", "responses", "some", "worst"),
    [
        (["dZ"], ["dZ"], "", ""),
        (["dZ"], ["dZ", "T"], "dZ", "dZ"),
        (["dY", "dZ"], ["dY", "dZ"], "", "the worst of dY and dZ"),
        (["dY", "dZ"], ["dY", "dZ", "T"], "dY and dZ", "the worst of dY and dZ"),
    ],
)
def test_an_error_names_its_responses(told: list[str], responses: list[str], some: str, worst: str) -> None:
    assert (some_of(told, responses), worst_of(told, responses)) == (some, worst)


def test_a_page_of_two_units_has_a_map_and_a_scale_of_bars_for_each(blind: ReportData) -> None:
    cool = [dataclasses.replace(t, response="T_nut", residual=t.residual / 100) for t in blind.tests]
    tests = tuple(both for pair in zip(blind.tests, cool, strict=True) for both in pair)
    scores = [s.model_copy(update={"rmse_um": (s.rmse_um or 0.0) / 100, "response": "T_nut"}) for s in blind.scores]
    two = dataclasses.replace(
        blind,
        responses=("dZ", "T_nut"),
        units={"dZ": "um", "T_nut": "K"},
        tests=tests,
        scores=[*blind.scores, *scores],
        before=[*blind.scores, *scores],
    )
    page = render(two)
    found = re.findall(r'<script type="application/json" id="(overview\d*)">(.*?)</script>', page, flags=re.DOTALL)
    maps = {key: json.loads(text) for key, text in found}
    assert {key: (m["unit"], m["targets"]) for key, m in maps.items()} == {
        "overview": ("um", ["test0", "test2", "test4"]),
        "overview1": ("K", ["test1", "test3", "test5"]),
    }
    assert [row.rpartition(" ")[2] for row in maps["overview1"]["rows"]] == ["T_nut"] * 3
    assert maps["overview1"]["limit"] == pytest.approx(maps["overview"]["limit"] / 100)
    assert all(f'data-chart="{key}"' in page for key in maps)
    widths = re.findall(r'width="([\d.]+)%"', page[page.index('id="scores"') : page.index('id="parameters"')])
    assert len(widths) > 2
    assert widths[: len(widths) // 2] == widths[len(widths) // 2 :]


@pytest.mark.parametrize("lost", [True, False])
def test_models_beside_each_other_tell_what_only_one_predicts(lost: bool) -> None:
    both = [score("a", "calibration", 3.0), score("b", "verification", 5.0)]
    said = lost_of_compared({"m 1": both, "m 2": both[:1] if lost else both})
    told = "m 2 predicts 1 of 2 tests not: demo/b; errors are over the 1 that all of them predict"
    assert said == (told if lost else "")
    assert bool(lost_sentence(both, both[:1] if lost else both)) is lost
