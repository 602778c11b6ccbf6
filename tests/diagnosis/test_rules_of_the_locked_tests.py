"""What the locked tests decide (diagnosis/confirm.py, and a claim that they contradict in answer.py)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis import confirm as confirming
from thermodata.diagnosis.answer import kept_where_it_holds
from thermodata.diagnosis.confirm import Confirmation, extended, on_all_open, rmse
from thermodata.diagnosis.judge import Judgement
from thermodata.schema.model import Model
from thermodata.schema.result import Parameter
from thermodata.view.dataset import Dataset

from .hand_made import a_test, candidate, scored
from .stand_ins import Fitted, Response


def confirmation(before: float | None, after: float | None) -> Confirmation:
    """By shape; the errors from the first samples on say the opposite."""
    return Confirmation(after, before, before, after, {})


@pytest.mark.parametrize(("after", "holds"), [(0.979, True), (0.981, False), (1.5, False)])
def test_the_locked_error_must_fall_by_two_percent(after: float, holds: bool) -> None:
    assert confirmation(1.0, after).holds is holds


def test_without_locked_tests_a_claim_stands() -> None:
    assert confirmation(None, None).holds


@pytest.mark.parametrize(("after", "verdict"), [(0.979, "effect"), (0.981, "unknown")])
def test_a_claim_that_the_locked_tests_contradict_is_withdrawn(after: float, verdict: str) -> None:
    claimed = scored("screw", channels=("T_nut",))
    found = kept_where_it_holds(Judgement("effect", claimed, ""), confirmation(1.0, after), "um")
    assert found.verdict == verdict
    assert found.claimed is (claimed if verdict == "effect" else None)
    assert ("screw:T_nut explains the open tests" in found.reason) == (verdict == "unknown")


# ---- what is compared


def test_the_free_offset_decides_and_is_taken_for_each_test_by_itself() -> None:
    left = {"a": np.array([1.0, 3.0, 1.0, 3.0]), "b": np.array([-5.0, -5.0, -5.0, -5.0])}
    tests = [a_test("a", 4), a_test("b", 4)]
    assert rmse(Response(left), tests) == pytest.approx(np.sqrt((1 + 9 + 1 + 9 + 100) / 8))
    assert rmse(Response(left), tests, free=True) == pytest.approx(np.sqrt(0.5))
    assert rmse(Response(left), []) is None
    unseen = replace(tests[1], in_window=np.zeros(4, bool))
    assert rmse(Response(left), [tests[0], unseen], free=True) == pytest.approx(1.0)
    assert rmse(Response(left), [unseen], free=True) is None


def test_the_model_is_extended_by_the_candidate_and_calibrated_on_open_tests_only(spec: Model) -> None:
    more = extended(spec, candidate("screw", channels=("T_nut",)))
    assert [e.effect for e in more.effects] == ["spindle_bearing", "screw"]
    assert more.effects[1].drivers == {"u": "T_nut"}
    assert [e.effect for e in spec.effects] == ["spindle_bearing"]
    opened = on_all_open(spec, [a_test("a"), a_test("b")], [a_test("z")])
    assert (opened.calibrate_on, opened.verify_on, opened.locked) == (["c/a", "c/b"], [], ["c/z"])


class TestConfirm:
    """Fits are replaced by residuals: what matters is which model is asked about which test."""

    OPEN, LOCKED = [a_test("o", 4)], [a_test("z", 4), a_test("no_driver", 4)]

    def confirmed(self, monkeypatch: pytest.MonkeyPatch, spec: Model, second: bool) -> Confirmation:
        wave = np.array([1.0, -1.0, 1.0, -1.0])
        left = {1: {"z": 4 * wave + 1, "no_driver": 9 * wave}, 2: {"z": 3 * wave + 2}, 3: {"z": wave}}
        self.calibrated: list[Any] = []

        def fit_model(asked: Model, data: Dataset, **more: Any) -> Fitted:
            self.calibrated.append((asked.calibrate_on, asked.locked))
            count = len(asked.effects)
            values = {f"effect{i}.gain": Parameter(value=i, unit="um/K") for i in range(1, count + 1)}
            return Fitted([Response({}), Response(left[count])], asked, values=values)

        monkeypatch.setattr(confirming, "fit_model", fit_model)
        data = Dataset(60.0, (*self.OPEN, *self.LOCKED), {})
        return confirming.confirm(
            spec, 1, data, candidate(), self.OPEN, self.LOCKED, candidate("second") if second else None
        )

    def test_both_models_are_asked_about_the_same_locked_tests(
        self, monkeypatch: pytest.MonkeyPatch, spec: Model
    ) -> None:
        found = self.confirmed(monkeypatch, spec, second=False)
        assert found.before == pytest.approx(np.sqrt(17))
        assert found.after == pytest.approx(np.sqrt(13))
        assert (found.shape_before, found.shape_after) == pytest.approx((4.0, 3.0))
        assert list(found.parameters) == ["effect2.gain"]
        assert {(*c, *z) for c, z in self.calibrated} == {("c/o", "c/z", "c/no_driver")}

    def test_a_pair_is_decided_by_both_together(self, monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
        found = self.confirmed(monkeypatch, spec, second=True)
        assert found.after == pytest.approx(np.sqrt(13))
        assert (found.shape_before, found.shape_after) == pytest.approx((4.0, 1.0))
