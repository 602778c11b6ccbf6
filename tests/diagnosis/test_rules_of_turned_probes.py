"""A probe that is turned in a test is told by what the other tests foretell, also where the model lacks much."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.sensors.turned import is_turned, turned
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Float1D
from thermodata.schema.answers.diagnosis import Diagnosis, PutRight
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .conftest import STEP_S, make_data
from .hand_made import Parts, of_one_model, problem


def by_the_nut(channels: dict[str, Any], t: np.ndarray) -> Float1D:
    """As much as the spindle does, and the model knows nothing of it."""
    nut = channels["T_nut_X"]
    return np.asarray(lag(9 * (nut - nut[0]), 1200, STEP_S))


def with_turned(data: Dataset, *names: str) -> Dataset:
    tests = tuple(replace(t, values={**t.values, "dZ": -t.values["dZ"]}) if t.test in names else t for t in data.tests)
    return replace(data, tests=tests)


def found(data: Dataset, spec: Model) -> Diagnosis:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis


def signs(of: Diagnosis) -> list[str]:
    return [a.test for a in of.artefacts if a.kind == "sign"]


@pytest.mark.parametrize("names", [(), ("t3",), ("t1", "t4")])
def test_turned_tests_are_named_and_the_cause_is_named_without_them(spec: Model, names: tuple[str, ...]) -> None:
    told = found(with_turned(make_data(by_the_nut), *names), spec)
    assert signs(told) == list(names)
    assert told.verdict == "effect"
    assert [c.family for c in told.candidates if c.claimed] == ["feed_x"]
    assert not {c.test for c in told.candidates[0].left_out} & set(names)


def test_the_cause_is_not_named_where_a_turned_test_takes_part(spec: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    """What leaving it out is for."""
    monkeypatch.setattr("thermodata.diagnosis.sound.turned_probes", lambda *_: [])
    told = found(with_turned(make_data(by_the_nut), "t1", "t4"), spec)
    assert told.verdict != "effect" or told.candidates[0].rmse_um_after > 1.0  # type: ignore[operator]


def test_a_fault_that_leaves_a_test_out_says_so(spec: Model) -> None:
    answer = found(with_turned(make_data(by_the_nut), "t3"), spec)
    [told] = [a for a in answer.artefacts if a.kind == "sign"]
    assert "takes no part in the choice" in told.why
    assert answer.put_right == PutRight(left_out=[(told.campaign, "t3")])
    assert found(make_data(by_the_nut), spec).put_right is None


@pytest.mark.parametrize(
    ("after", "fit", "is_one"), [(0.399, 90.0, True), (0.401, 90.0, False), (0.1, 40.1, True), (0.1, 39.9, False)]
)
def test_turning_a_test_must_take_away_most_of_all_error_and_foretell_it(
    after: float, fit: float, is_one: bool
) -> None:
    assert is_turned(1.0, after, fit) is is_one


@pytest.mark.parametrize(
    ("factors", "named"),
    [
        ([1, 1, 1, 1], []),
        ([1, 1, 1, 2], []),
        ([1, 1, -1], ["t2"]),
        ([1, -1], []),
        ([1, 1, 1, -1, -1], ["t3", "t4"]),
        ([1, -1, -1, -1, 1], ["t0", "t4"]),
        ([1, 1, -1, -1], []),
    ],
)
def test_a_sign_is_turned_against_those_of_most_tests(factors: list[float], named: list[str]) -> None:
    assert [a.test for a in turned(of_one_model(factors), [])] == named


def test_a_part_of_one_of_two_tests_is_not_turned() -> None:
    """Where there are few, parts in time stand for tests."""
    asked = of_one_model([1, 1, 1, -1])
    first, second = asked.blocks[0].test, asked.blocks[3].test
    parts = tuple(replace(b, test=first if i < 2 else second) for i, b in enumerate(asked.blocks))
    assert turned(replace(asked, blocks=parts, kept={}), []) == []


@pytest.mark.parametrize(("lacking", "named"), [(0.7, True), (0.8, False)])
def test_a_test_that_others_hardly_foretell_is_not_turned(lacking: float, named: bool) -> None:
    """FIT 40 of that test alone: what it has beside what it shares with others is 0.75 times as large."""
    turns = np.arange(2000) * 2 * np.pi / 200
    base = np.sin(turns)[:, None]

    def one(sign: float, lacking: float) -> Parts:
        y: Float1D = sign * (base[:, 0] + lacking * np.cos(turns))
        return Parts(y, response=y, base=base)

    others = (one(1.0, 0.0) for _ in range(4))
    assert [a.test for a in turned(problem(*others, one(-1.0, lacking), noise=0.01), [])] == (["t4"] if named else [])


@pytest.mark.parametrize(("size", "named"), [(0.25, True), (0.15, False)])
def test_a_test_that_hardly_moves_is_not_turned(size: float, named: bool) -> None:
    """A fifth of what all do, as RMS."""
    base = np.sin(np.arange(2000) * 2 * np.pi / 200)[:, None]
    tests = [Parts(k * base[:, 0], response=k * base[:, 0], base=abs(k) * base) for k in (1.0, 1.0, 1.0, 1.0, -size)]
    assert [a.test for a in turned(problem(*tests, noise=0.01), [])] == (["t4"] if named else [])


def test_of_nothing_nothing_is_turned() -> None:
    still = [Parts(np.zeros(50), response=np.zeros(50), base=np.zeros((50, 1))) for _ in range(4)]
    assert turned(problem(*still, noise=0.01), []) == []
