"""What the known effects may still do, and what is asked and judged: known_effects.py and investigate.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.compressed import error_of
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known_effects import otherwise, owners, remembered
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict import investigate as investigating
from thermodata.diagnosis.verdict import on_locked as locking
from thermodata.diagnosis.verdict.inquiry import Given, Inquiry
from thermodata.diagnosis.verdict.investigate import Investigation, investigate
from thermodata.diagnosis.verdict.judged import Judged
from thermodata.diagnosis.verdict.selection import Member, Selection
from thermodata.diagnosis.weigh.evidence import Columns
from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.diagnosis.weigh.ranking import Ranked
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.fitted import FittedModel, FittedResponse
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset

from .conftest import make_data
from .hand_made import scored


@pytest.fixture(scope="module")
def data() -> Dataset:
    return make_data(tests=4)


@pytest.fixture(scope="module")
def fitted(data: Dataset) -> FittedModel:
    model = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "base",
            "campaign": "c",
            "response": {"axis": "Z", "at": "tcp"},
            "step": "120 s",
            "effects": [{"effect": "spindle_bearing", "drivers": {"temperature": "T_bearing"}}],
        }
    )
    return fit_model(model, data, uncertainty=False)


def test_a_known_effect_may_grow_and_its_time_constant_move(data: Dataset, fitted: FittedModel) -> None:
    """One column a gain, that doubles it; one a time constant, that stretches it by e to first order."""
    response, test = fitted.responses[0], data.tests[0]
    (term,) = response.terms
    columns = remembered(response)(test)
    assert columns.shape == (len(test.t_s), 2)
    np.testing.assert_allclose(columns[:, 0], term.contribution(test))
    little = 1e-3
    longer = {**term.params, "tau": term.params["tau"] * np.exp(little)}
    slope = (term.bound.columns(test, longer) @ [term.gains["gain"]] - term.contribution(test)) / little
    np.testing.assert_allclose(columns[:, 1], slope, atol=0.01 * np.abs(slope).max())


def test_a_known_effect_may_act_faster_and_slower_over_four_decades_at_a_price(
    data: Dataset, fitted: FittedModel
) -> None:
    response, test = fitted.responses[0], data.tests[0]
    (term,) = response.terms
    columns = otherwise(response, test)
    assert columns.shape == (len(test.t_s), 4)
    for j, factor in enumerate((1 / 25, 1 / 5, 5.0, 25.0)):
        other = {**term.params, "tau": term.params["tau"] * factor}
        changed = term.bound.columns(test, other) @ [term.gains["gain"]]
        np.testing.assert_allclose(columns[:, j], changed - term.contribution(test))


def test_each_column_has_the_term_that_it_belongs_to(data: Dataset, fitted: FittedModel) -> None:
    (term,) = fitted.responses[0].terms
    two = replace(fitted.responses[0], terms=(term, term))
    base, spare = owners(two)
    assert (base, spare) == ([0, 0, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1])
    assert remembered(two)(data.tests[0]).shape[1] == len(base)
    assert otherwise(two, data.tests[0]).shape[1] == len(spare)


def test_a_known_effect_that_is_absent_in_a_test_can_do_nothing_there(data: Dataset) -> None:
    model = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "base",
            "campaign": "c",
            "response": {"axis": "Z", "at": "tcp"},
            "step": "120 s",
            "effects": [EffectSpec(effect="spindle_bearing", drivers={"temperature": "T_bearing"}, tests=["t0", "t1"])],
        }
    )
    response = fit_model(model, data, uncertainty=False).responses[0]
    assert remembered(response)(data.tests[0]).any()
    assert not remembered(response)(data.tests[2]).any()
    assert not otherwise(response, data.tests[2]).any()


NOISE = Noise(0.1, 0.1, 600.0, 0.5)
FAR = scored("far", before=1.0, after=0.95)


# evidence a sample of a passive one whose error falls to nothing: log10 of it is (log(0.65 / 0.35) - 0.9 + 0.05) / 2.15
LEAST_OF_PASSIVE = 10 ** ((np.log(0.65 / 0.35) - 1.1 + 0.2) / 2.2)
# and of one without any place: (log(0.5 / 0.5) - 0.9 - 2.6) / 2.15
LEAST_OF_PLACELESS = 10 ** (-3.55 / 2.2)


class TestJudged:
    """Selection is replaced by evidence made by hand: what matters is what is asked for, and against which measure."""

    def investigated(
        self,
        monkeypatch: pytest.MonkeyPatch,
        data: Dataset,
        fitted: FittedResponse,
        members: Sequence[Scored] | None,
        ranked: Sequence[Scored] = (FAR,),
        refined: Sequence[str] = (),
        stands_out: bool = True,
        **more: Any,
    ) -> Investigation:
        """members: that are selected, the passive ones where they may be; None where nothing can be asked.
        stands_out: whether one that is passive may be claimed at best."""
        self.rows: list[int] = []
        self.among: list[list[str]] = []
        known: Any = None
        first = Ranked(known, tuple(ranked))
        build = investigating.compressed

        def first_ranking(problem: Problem, candidates: Sequence[CandidateEffect]) -> Ranked | None:
            self.asked = [c.id for c in candidates]
            return None if members is None else first

        def select(problem: Problem, given: Ranked, sound: Any, *, among: Sequence[Columns], **of: Any) -> Selection:
            assert given is first
            self.sound = sound
            self.among.append([c.candidate.effect.name for c in among])
            passive = any(c.candidate.passive for c in among)
            chosen = [m for m in members or () if passive or not m.candidate.passive]
            return Selection(
                first, tuple(Member(m, m, tuple(ranked)) for m in chosen), (), NOISE, ranked[0].error_before
            )

        def built(fitted: Any, data: Any, tests: Any, rows: int, base: Any) -> Problem:
            self.rows.append(rows)
            return build(fitted, data, tests, rows, base)

        def any_stands_out(
            problem: Problem, given: Ranked, found: Selection, some: Sequence[Columns], may: Any
        ) -> bool:
            assert given is first
            self.may = may
            return stands_out and bool(some)

        monkeypatch.setattr(investigating, "first_ranking", first_ranking)
        monkeypatch.setattr(investigating, "any_stands_out", any_stands_out)
        monkeypatch.setattr(investigating, "select", select)
        monkeypatch.setattr(investigating, "_limits", lambda *of: ())  # asked of hand-made columns, of no rows
        monkeypatch.setattr(investigating, "compressed", built)
        monkeypatch.setattr(investigating, "best_of_chance", lambda known, pool, seed: np.full(199, 100.0))
        monkeypatch.setattr(
            investigating,
            "Refinement",
            lambda fitted, problem, noise, twins: lambda s: "kin" if s.candidate.effect.name in refined else None,
        )
        return investigate(Inquiry(fitted, data, fitted_tests(data), effects()), Given(**more))

    def test_the_measure_is_that_of_the_response(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        found = self.investigated(monkeypatch, data, fitted.responses[0], None)
        whole = np.concatenate([t.values["dZ"] - t.values["dZ"].mean() for t in fitted_tests(data)])
        assert found.measure.spread == pytest.approx(np.sqrt(np.mean(whole**2)))
        assert found.measure.noise == pytest.approx(0.1, rel=0.2)
        assert "spindle_bearing:T_bearing" not in self.asked
        assert "lag:T_hall" in self.asked
        assert (found.on_open.verdict, found.selection) == ("not_testable", None)
        one = scored()
        assert found.borne_out(Judged(one, one, None, ()), ()) is None

    def test_steps_are_looked_for_in_fine_samples_and_candidates_weighed_in_2400(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        self.investigated(monkeypatch, data, fitted.responses[0], [])
        assert self.rows == [9000, 2400]

    def test_what_is_sound_is_judged_against_the_chance_of_this_response(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        cause = scored("cause", before=3.0, after=0.3, size=3.0, evidence=500.0)
        found = self.investigated(monkeypatch, data, fitted.responses[0], [cause])
        assert found.measure.chance.tolist() == [100.0] * 199
        assert self.sound(cause)
        assert not self.sound(replace(cause, evidence=99.0))
        assert [c.scored for c in found.on_open.claims] == [cause]

    @pytest.mark.parametrize(
        ("evidence", "verdict", "asked"),
        [(500.0, "effect", [["cause"]]), (30.0, "unknown", [["cause"], ["cause", "bed"]])],
    )
    def test_what_is_passive_is_chosen_only_where_nothing_else_may_be_claimed(
        self,
        monkeypatch: pytest.MonkeyPatch,
        data: Dataset,
        fitted: FittedModel,
        evidence: float,
        verdict: str,
        asked: list[list[str]],
    ) -> None:
        cause = scored("cause", before=3.0, after=0.3, size=3.0, evidence=evidence)
        bed = scored("bed", before=3.0, after=0.3, size=3.0, evidence=700.0, passive=True, family="generic")
        found = self.investigated(monkeypatch, data, fitted.responses[0], [cause, bed], ranked=[cause, bed])
        assert (found.on_open.verdict, self.among) == (verdict, asked)
        assert [j.scored.candidate.effect.name for j in found.on_open.judged] == asked[-1]
        self.investigated(monkeypatch, data, fitted.responses[0], [FAR])
        assert self.among == [["far"]], "no second look where nothing is passive"

    def test_what_is_passive_is_asked_for_only_where_it_may_be_claimed_at_best(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        """At best: left-out tests foretold without any error."""
        bed = scored("bed", before=3.0, after=0.3, size=3.0, evidence=700.0, passive=True, family="generic")
        blunt = scored("blunt", before=3.0, after=0.3, size=3.0, evidence=30.0)
        some = [blunt, bed]
        found = self.investigated(monkeypatch, data, fitted.responses[0], some, ranked=some, stands_out=False)
        assert self.among == [["blunt"]]
        assert [j.scored.candidate.effect.name for j in found.on_open.judged] == ["blunt"]
        rows = found.problem.rows
        for one, enough in ((bed, LEAST_OF_PASSIVE), (scored(placeless=True), LEAST_OF_PLACELESS)):
            assert self.may(replace(one, evidence=1.01 * enough * rows))
            assert not self.may(replace(one, evidence=0.99 * enough * rows))

    def test_locked_tests_are_asked_beside_all_that_was_selected_and_then_beside_refinements_alone(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        members = [
            scored("cause", before=3.0, after=0.3, size=3.0),
            scored("mode", before=3.0, after=0.3, size=3.0),
            scored("blunt", before=3.0, after=0.3, size=3.0, evidence=110.0),
        ]
        asked: list[tuple[int, int, list[str], list[str]]] = []
        holds = [False, True]

        def foretell(problem: Problem, opened: int, noise: Noise, kept: Any, claims: Any) -> Foretold:
            names = [[s.candidate.effect.name for s in some] for some in (kept, claims)]
            asked.append((len(problem.blocks), opened, *names))  # type: ignore[arg-type]
            assert noise is NOISE
            return Foretold(1.0, 0.1 if holds.pop(0) else 1.0, 1.0)

        monkeypatch.setattr(locking, "foretell", foretell)
        locked = [t for t in data.tests if t.role == "locked"]

        def investigated(some: Sequence[Scored], **more: Any) -> Investigation:
            return self.investigated(monkeypatch, data, fitted.responses[0], some, refined=["mode"], **more)

        found = investigated(members, locked=locked)
        result = found.borne_out(found.on_open.claims[0], ())
        assert result is not None
        assert result.holds
        assert asked == [(4, 3, ["mode", "blunt"], ["cause"]), (4, 3, ["mode"], ["cause"])]
        asked.clear()
        holds[:] = [False]
        found = investigated(members[:2], locked=locked)
        result = found.borne_out(found.on_open.claims[0], ())
        assert result is not None
        assert not result.holds
        assert len(asked) == 1, "nothing but refinements stood beside it"
        assert investigated(members).borne_out(found.on_open.claims[0], ()) is None, "there are no locked tests"

    @pytest.mark.parametrize(
        ("evidence", "left", "asked", "among"),
        [
            (45.0, 0.2, [], [["likely"]]),  # the locked tests will make a claim of it
            (45.0, 0.9, ["likely", "likely"], [["likely"], ["likely", "bed"]]),
            (45.0, None, ["likely", "likely"], [["likely"], ["likely", "bed"]]),  # there are none
            (16.0, 0.2, ["likely", "likely"], [["likely"], ["likely", "bed"]]),  # nor are they opened for it
            (900.0, 0.2, [], [["likely"]]),  # a claim without them
        ],
    )
    def test_other_axes_are_asked_only_of_what_the_locked_tests_leave_open(
        self,
        monkeypatch: pytest.MonkeyPatch,
        data: Dataset,
        fitted: FittedModel,
        evidence: float,
        left: float | None,
        asked: list[str],
        among: list[list[str]],
    ) -> None:
        """Each is a diagnosis of its own; nor is what is passive asked for beside what will be a claim."""
        one = scored("likely", before=3.0, after=0.3, size=3.0, evidence=evidence)
        bed = scored("bed", before=3.0, after=0.3, size=3.0, evidence=1.0, passive=True, family="generic")
        said: list[str] = []

        class Others:
            def say(self, some: Scored, causes: Any) -> tuple[tuple[str, float], ...]:
                said.append(some.candidate.effect.name)
                return ()

        def foretell(problem: Problem, opened: int, noise: Noise, kept: Any, claims: Any) -> Foretold:
            assert left is not None
            return Foretold(10.0, 10.0 * left, 10.0)

        monkeypatch.setattr(locking, "foretell", foretell)
        locked = [t for t in data.tests if t.role == "locked"] if left is not None else []
        more: dict[str, Any] = {"ranked": [one, bed], "locked": locked, "others": Others()}
        found = self.investigated(monkeypatch, data, fitted.responses[0], [one], **more)
        assert said == asked
        assert self.among == among
        opened = evidence == 45.0 and left is not None
        assert found.looked_for == (("likely:T_a",) if opened else ()), "each look counts, whatever comes of it"

    def test_wrong_parameters_are_those_of_the_model_that_is_asked_about(
        self, monkeypatch: pytest.MonkeyPatch, data: Dataset, fitted: FittedModel
    ) -> None:
        refitted = fitted.responses[0]
        (term,) = refitted.terms
        doubled = {g: replace(v, gains={"gain": 2 * v.gains["gain"]}) for g, v in term.groups.items()}
        wrong = replace(refitted, terms=(replace(term, groups=doubled),))
        ranked = [scored(before=0.1, after=0.1, evidence=0.0)]
        as_it_is = self.investigated(monkeypatch, data, refitted, [], ranked)
        asked_about = self.investigated(monkeypatch, data, refitted, [], ranked, as_fitted=wrong)
        assert [a.kind for a in as_it_is.artefacts] == []
        assert [a.kind for a in asked_about.artefacts] == ["parameters"]
        assert asked_about.spots[0].rmse_um > 5 * as_it_is.spots[0].rmse_um, "weak spots are those of the same model"


def test_an_unlucky_zero_is_no_error(data: Dataset, fitted: FittedModel) -> None:
    """The first samples, which give a test that was not fitted its offset, are 50 um off: 5 of 360."""
    first = np.where(np.arange(360) < 5, 50.0, 0.0)
    tests = [replace(t, values={**t.values, "dZ": t.values["dZ"] + first}) for t in fitted_tests(data)]
    response = replace(fitted.responses[0], calibrate=frozenset())
    assert np.abs(np.mean(response.residual(tests[0]))) > 40.0
    assert error_of(response, tests) == pytest.approx(50.0 * np.sqrt(5 / 360), rel=0.05)


def fitted_tests(data: Dataset) -> list[Any]:
    return [t for t in data.tests if t.role != "locked"]
