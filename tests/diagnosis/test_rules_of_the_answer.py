"""What an answer opens and says, whatever was found (diagnosis/answer.py)."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis import answer as answering
from thermodata.diagnosis.confirm import Confirmation
from thermodata.diagnosis.investigate import Investigation
from thermodata.diagnosis.judge import Judgement
from thermodata.schema.model import Model
from thermodata.schema.result import Diagnosis, Parameter, WeakSpot
from thermodata.view.dataset import Dataset

from .hand_made import Parts, a_test, measure, problem, scored
from .stand_ins import Fitted, Response

SPOT = WeakSpot(campaign="c", test="t0", from_s=0, to_s=60, rmse_um=1.0, state="spindle at rest")


class TestAnswer:
    """What is found is given by hand: what matters is what is opened, and what is said."""

    RANKED = [
        scored("first", after=0.3, size=2.0),
        scored("twin", after=0.3, p_value=0.5),
        scored("other", after=0.9, p_value=0.5, shape=(0.0, 1.0)),
    ]

    def answered(
        self,
        monkeypatch: pytest.MonkeyPatch,
        spec: Model,
        judgement: Judgement,
        holds: bool = True,
        tests: int = 5,
        ranked: Sequence[Any] | None = None,
    ) -> Diagnosis:
        rng = np.random.default_rng(0)
        asked = problem(*(Parts(rng.normal(size=200), response=rng.normal(size=200)) for _ in range(tests)), noise=0.1)
        given = [b.test for b in asked.blocks]
        locked = [a_test("z", 4, role="locked"), a_test("unpredictable", 4, role="locked")]
        response = Response({t.test: rng.normal(size=len(t.t_s)) for t in [*given, locked[0]]})
        fitted: Any = Fitted([response], spec, given, locked)
        found = Investigation(
            asked, list(self.RANKED if ranked is None else ranked), [], [SPOT], judgement, measure(floor=0.2)
        )
        monkeypatch.setattr(answering, "fit_model", lambda *a, **k: SimpleNamespace(responses=[response]))
        monkeypatch.setattr(answering, "investigate", lambda *a, **k: found)
        self.opened: list[list[str]] = []

        def confirm(*asked: Any) -> Confirmation:
            self.opened.append([t.test for t in asked[5]])
            after = 0.5 if holds else 1.0
            return Confirmation(1.0, after, 1.0, after, {"plain.gain": Parameter(value=2.0, unit="um/K")})

        monkeypatch.setattr(answering, "confirm", confirm)
        got = answering.answer(fitted, Dataset(60.0, tuple(given), {}), {}, "m")
        self.looked_at = [t.test for t in got.locked]
        return got.diagnosis

    def test_locked_tests_are_opened_for_a_claim_only(self, monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
        for verdict in ("none", "unknown", "not_testable"):
            self.answered(monkeypatch, spec, Judgement(verdict, None, "because"))  # type: ignore[arg-type]
            assert self.opened == []
            assert self.looked_at == []
        self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[0], ""))
        assert self.opened == [["z"]]
        assert self.looked_at == ["z"]

    def test_one_candidate_is_claimed_and_confirmed_with_its_twin_beside(
        self, monkeypatch: pytest.MonkeyPatch, spec: Model
    ) -> None:
        found = self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[2], ""))
        assert [c.claimed for c in found.candidates] == [True, False, False]
        assert [c.effect for c in found.candidates] == ["other", "first", "twin"]
        assert [c.locked_rmse_um_after for c in found.candidates] == [0.5, None, None]
        assert [list(c.parameters) for c in found.candidates] == [["plain.gain"], [], []]
        assert [c.equivalent for c in found.candidates] == [[], ["twin:T_a"], ["first:T_a"]]
        assert "chance does as well in 50.0% of surrogate residuals" in found.candidates[0].why
        assert "the claimed effect explains it better" in found.candidates[1].why
        assert "not claimed: chance does as well" in found.candidates[2].why
        assert found.unknown is None

    def test_a_claim_that_does_not_hold_is_unknown_and_counted(
        self, monkeypatch: pytest.MonkeyPatch, spec: Model
    ) -> None:
        found = self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[0], ""), holds=False)
        assert found.verdict == "unknown"
        assert not any(c.claimed or c.locked_rmse_um_after for c in found.candidates)
        assert found.unknown is not None
        assert "on the locked ones the error does not fall" in found.candidates[0].why
        assert self.looked_at == ["z"]

    @pytest.mark.parametrize(("verdict", "advice", "characterised"), [("none", False, False), ("unknown", True, True)])
    def test_advice_is_given_where_something_is_unknown(
        self, monkeypatch: pytest.MonkeyPatch, spec: Model, verdict: Any, advice: bool, characterised: bool
    ) -> None:
        found = self.answered(monkeypatch, spec, Judgement(verdict, None, "because"))
        assert (found.next_test is not None, found.unknown is not None) == (advice, characterised)

    def test_a_claim_with_a_twin_says_how_to_tell_them_apart(
        self, monkeypatch: pytest.MonkeyPatch, spec: Model
    ) -> None:
        assert "to tell first:T_a from twin:T_a" in (
            self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[0], "")).next_test or ""
        )
        assert self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[2], "")).next_test is None

    def test_a_second_effect_is_named_beside_the_first(self, monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
        found = self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[0], "", self.RANKED[2]))
        assert "a second effect is missing too: with other:T_a beside it" in found.candidates[0].why

    def test_the_numbers_are_those_of_the_left_out_tests(self, monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
        found = self.answered(monkeypatch, spec, Judgement("effect", self.RANKED[0], ""))
        first = found.candidates[0]
        assert (first.rmse_um_before, first.rmse_um_after) == pytest.approx((1.0, 0.3))
        assert (found.rmse_um, found.explainable) == pytest.approx((1.0, 0.8))
        assert "falls from 1.00 to 0.30 um; it would act with 2.0 um RMS" in first.why

    def test_at_most_fifteen_candidates_are_shown(self, monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
        ranked = [scored(f"e{i}") for i in range(16)]
        found = self.answered(monkeypatch, spec, Judgement("none", None, ""), ranked=ranked)
        assert [c.rank for c in found.candidates] == list(range(1, 16))
        assert [bool(c.equivalent) for c in found.candidates] == [True] * 5 + [False] * 10


def test_the_response_with_the_largest_share_left_is_asked_about(spec: Model) -> None:
    tests = [a_test("a", 50)]
    wave = np.sin(np.arange(50))

    def left(share: float) -> Response:
        return Response({"a": 10.0 * np.sqrt(share) * wave + 7.0})

    assert answering.worst_response(Fitted([left(0.3), left(0.31)], spec), tests) == 1  # type: ignore[arg-type]
    assert answering.worst_response(Fitted([left(0.31), left(0.3)], spec), tests) == 0  # type: ignore[arg-type]
