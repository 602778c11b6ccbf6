"""Whether a candidate is a cause of its own or refines the model (claims/refinement.py)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.candidates.kin import Kin
from thermodata.diagnosis.claims import refinement
from thermodata.diagnosis.claims.known_beside import KnownEffects
from thermodata.diagnosis.claims.probability import CLAIMED, PROBABILITY
from thermodata.diagnosis.claims.refinement import Refinement
from thermodata.diagnosis.claims.refines import PART, by_kind, elsewhere_of, mode_of, not_advised
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known_effects import from_other_zero, is_warm
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Float1D, Param
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import ChannelInfo

from .conftest import STEP_S, make_data
from .hand_made import Parts, PlainEffect, problem, scored

ROWS = 200
WAVE = np.sqrt(2) * np.sin(2 * np.pi * np.arange(ROWS) / 50)  # as large as 1
OTHER = np.sqrt(2) * np.cos(2 * np.pi * np.arange(ROWS) / 50)  # at a right angle
NOISE = Noise(0.1, 0.1, 600.0, 0.5)
WARM = ChannelInfo("T_a", "temperature", "degC")
TAU = Param("tau", "min", 30, 1, 360, "")
FALL = 0.5  # of the cause made by hand
# evidence a sample that makes a cause of it
SURELY = 10 ** ((np.log(CLAIMED / (1 - CLAIMED)) - PROBABILITY[0] - FALL * PROBABILITY[2]) / PROBABILITY[1])
MODE = mode_of(["term0"])
LITTLE = "it is little beside what the model has of that family"


def model(*families: str) -> Any:
    """A term of one gain and no parameter each."""
    return SimpleNamespace(
        terms=tuple(
            SimpleNamespace(id=f"term{i}", family=f, effect=PlainEffect(f"known{i}", f), binding={"u": f"T_{i}"})
            for i, f in enumerate(families)
        )
    )


def world(response: float = 1.0, known: Sequence[Float1D] = (WAVE,)) -> Problem:
    """response: its size. known: what each term does."""
    parts = Parts(response * WAVE, base=np.column_stack(known), values={"T_a": WAVE}, channels={"T_a": WARM})
    return problem(*[parts] * 3)


def said(one: Scored, response: float = 100.0, known: Sequence[Float1D] = (WAVE,), families: str = "feed_x") -> Any:
    asked = Refinement(model(*families.split()), world(response, known), NOISE)
    return asked(one)


def cause(kin: Kin = None, **of: Any) -> Scored:
    """What acts at a right angle to the known effect, and as large."""
    return scored(**{"kin": kin, "contribution": [OTHER] * 3, "after": 0.5, "size": 1.0, **of})


def dull(kin: Kin = None, **of: Any) -> Scored:
    """The same, of evidence too little for a cause."""
    return cause(kin, evidence=0.5 * 1000 * SURELY, **of)


def test_a_model_without_effects_has_nothing_to_refine() -> None:
    asked = Refinement(SimpleNamespace(terms=()), world(), NOISE)  # type: ignore[arg-type]
    assert asked(cause("same", refines=("plain",))) is None


def test_what_is_not_kin_and_acts_otherwise_is_a_cause() -> None:
    assert said(cause()) is None


def test_what_says_that_it_refines_does_so_however_much_it_takes_away() -> None:
    assert said(cause(refines=("known0",), after=0.01), response=1.0) == MODE


@pytest.mark.parametrize(("kin", "what"), [(None, None), ("same", MODE)])
def test_what_is_told_from_it_by_a_place_refines_only_what_the_model_has(kin: Kin, what: str | None) -> None:
    one = cause(kin, refines=("known0",), after=0.01)
    told = replace(one.candidate, effect=replace(one.candidate.effect, told_by="u"))
    assert said(replace(one, candidate=told), response=1.0) == what


@pytest.mark.parametrize("after", [0.9, 0.01])
@pytest.mark.parametrize("response", [1.0, 100.0])
def test_what_reads_the_same_cause_again_is_another_mode_of_it(after: float, response: float) -> None:
    """However much it takes away, and whether the model is poor or good."""
    assert said(cause("same", after=after), response) == MODE


@pytest.mark.parametrize(("evidence", "expected"), [(401.0, None), (399.0, PART)])
def test_a_part_of_what_the_model_reads_together_is_a_cause_where_it_is_evident(
    evidence: float, expected: str | None
) -> None:
    """From 0.4 a sample on, of a thousand, whatever it takes away."""
    for after in (0.9, 0.01):
        assert said(cause("part", evidence=evidence, after=after), 100.0) == expected


def evidence_of(sure: float, fall: float) -> float:
    """Of a thousand samples, so that a cause whose error falls so much is so probable."""
    level, sharp, by_fall, *_ = PROBABILITY
    return float(1000 * 10 ** ((np.log(sure / (1 - sure)) - level - fall * by_fall) / sharp))


@pytest.mark.parametrize(
    ("after", "sure", "of", "expected"),
    [
        (0.399, 0.851, {}, None),
        (0.401, 0.851, {}, MODE),  # it takes away too little
        (0.399, 0.849, {}, MODE),  # it is not sure enough
        (0.399, 0.9, {"of_motion": True}, MODE),  # it has the timing of no part
        (0.399, 0.96, {"of_motion": True}, None),  # from 1 a sample on: what a lag leaves is less evident
        (0.399, 0.851, {"contribution": [WAVE] * 3}, MODE),  # it takes the place of what is known
    ],
)
def test_another_reading_of_a_known_heat_is_a_cause_where_it_surely_acts_beside_it(
    after: float, sure: float, of: dict[str, Any], expected: str | None
) -> None:
    """The coolant's switch beside its temperature."""
    assert said(cause("heat", name="known0", after=after, evidence=evidence_of(sure, 1 - after), **of)) == expected


@pytest.mark.parametrize(("worth", "expected"), [(0.26, None), (0.24, MODE)])
def test_it_acts_beside_what_is_known_where_that_is_worth_a_quarter_of_what_it_was(
    worth: float, expected: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = iter([100.0 * worth, 100.0])
    monkeypatch.setattr(KnownEffects, "cost", lambda *_: next(told))
    assert said(cause("heat", name="known0", after=0.1, evidence=900.0)) == expected


def test_a_plain_function_that_stands_for_the_heat_is_no_effect_to_act_beside() -> None:
    assert said(cause("heat", name="other", after=0.1, evidence=900.0)) == MODE


@pytest.mark.parametrize(
    ("of", "families", "named"),
    [
        ({"refines": ("known1",)}, "feed_x feed_x", "term1"),  # what it refines
        ({"channels": ("T_1",)}, "feed_y feed_z", "term1"),  # what reads its channel
        ({}, "feed_y feed_x feed_x", "term1 and term2"),  # what is of its family
    ],
)
def test_a_mode_is_told_with_the_effects_that_it_is_taken_for_a_mode_of(
    of: dict[str, Any], families: str, named: str
) -> None:
    waves = [WAVE] * len(families.split())
    told = said(cause("same", **of), known=waves, families=families)
    assert told == mode_of(named.split(" and "))
    assert f"another mode of {named}, which the model has: these tests can't tell a cause of its own" in told
    assert "add it, or confirm it" in told
    against = not_advised(told, "left-out tests are foretold no better with it")
    assert against.endswith("from that; adding it is not advised, for left-out tests are foretold no better with it")
    assert "add it, or" not in against, "nobody is told both"
    assert not_advised(told, "") == told


@dataclass(frozen=True)
class OfHeat(PlainEffect):
    cause: str = "cut"


def test_a_mode_of_the_same_heat_is_told_with_it_whatever_its_family() -> None:
    """A part is warm by the cut that a load stands for."""
    known = model("cutting")
    known.terms[0].effect = OfHeat("load", "cutting")
    part = cause("heat", family="part", after=0.5)
    part = replace(part, candidate=replace(part.candidate, effect=OfHeat("part", "part")))
    assert Refinement(known, world(), NOISE)(part) == mode_of(["term0"])


def test_the_same_effect_by_another_sensor_is_told_as_that() -> None:
    """The water of the linear motors beside that of the spindle: it can be told from any mode of that."""
    told = said(cause("same", name="known0", channels=("T_9",)))
    assert told == elsewhere_of(["term0"])
    assert "by another sensor" in told
    assert said(cause("same", name="known0", channels=("T_0",))) == MODE


def test_a_mode_that_no_other_candidate_is_like_is_one_by_its_kind() -> None:
    """The tests tell it apart: to say that they can't would contradict the figures beside it."""
    told = by_kind(mode_of(["spindle_bearing"]), "from 1.20 to 0.635 um")
    assert "another mode of spindle_bearing, which the model has, by its kind: no other candidate does" in told
    assert "goes from 1.20 to 0.635 um (add it" in told
    assert "can't tell" not in told
    unnamed = mode_of([], ["cut:P"])
    assert by_kind(unnamed, "from 2 to 1 um") == unnamed, "another heat would explain it as well"


def test_a_mode_of_nothing_in_particular_is_one_of_what_the_model_has() -> None:
    assert said(cause("same"), families="feed_y") == mode_of([])
    assert "another mode of what the model has:" in mode_of([])


@pytest.mark.parametrize(("size", "expected"), [(0.599, LITTLE), (0.601, None)])
@pytest.mark.parametrize("kin", ["near", "related"])
def test_kin_is_a_mode_where_it_is_under_three_fifths_of_the_largest_effect(
    size: float, expected: str | None, kin: Kin
) -> None:
    known = (WAVE, 0.1 * OTHER)
    assert said(dull(kin, size=size), known=known, families="feed_x feed_y") == expected
    assert said(dull(None, size=size), known=known, families="feed_x feed_y") is None
    assert said(dull(kin, size=size, after=0.399), known=known, families="feed_x feed_y") is None, "it takes most"


@pytest.mark.parametrize(
    ("kin", "of_motion", "after", "cosine", "expected"),
    [
        ("related", True, 0.41, 0.51, MODE),
        ("near", True, 0.41, -0.51, MODE),
        ("related", True, 0.41, 0.49, None),  # it acts otherwise
        ("related", True, 0.399, 0.51, None),  # it takes most
        ("related", False, 0.41, 0.51, None),
        (None, True, 0.41, 0.51, None),
    ],
)
@pytest.mark.parametrize("response", [1.0, 100.0])
def test_a_motion_that_acts_like_the_part_that_the_model_has_is_another_mode_of_it(
    kin: Kin, of_motion: bool, after: float, cosine: float, expected: str | None, response: float
) -> None:
    """However sure and large it is, and whether the model is poor or good."""
    does = cosine * WAVE + np.sqrt(1 - cosine**2) * OTHER
    one = cause(kin, of_motion=of_motion, after=after, contribution=[does] * 3)
    assert said(one, response) == expected
    assert said(one, response, families="feed_y") is None, "of another family"


@pytest.mark.parametrize("kin", ["near", "related"])
def test_kin_that_is_surely_a_cause_is_no_mode_however_small(kin: Kin) -> None:
    known = (WAVE, 0.1 * OTHER)
    evidence = 1000 * SURELY
    assert said(cause(kin, size=0.1, evidence=1.01 * evidence), known=known, families="feed_x feed_y") is None
    assert said(cause(kin, size=0.1, evidence=0.99 * evidence), known=known, families="feed_x feed_y") == LITTLE


@pytest.mark.parametrize(("response", "expected"), [(2.49, None), (2.51, LITTLE)])
def test_where_a_model_leaves_more_than_two_fifths_something_is_missing(response: float, expected: str | None) -> None:
    assert said(dull("related", size=0.1), response) == expected


def test_the_size_of_an_effect_is_that_of_its_largest_test() -> None:
    small, large = (Parts(100 * WAVE, base=(s * WAVE)[:, None]) for s in (0.01, 1.0))
    asked = Refinement(model("feed_x"), problem(small, small, large), NOISE)
    assert asked(dull("related", size=0.599)) == LITTLE
    assert asked(dull("related", size=0.601)) is None


# ---- in the place of a known effect


def replacing(
    monkeypatch: pytest.MonkeyPatch, alone: float, beside: float, cosine: float = 1.0, **of: Any
) -> str | None:
    """alone, beside: log evidence that dropping the known effect costs, without and with the candidate."""
    asked = Refinement(model("feed_x"), world(100.0), NOISE)
    monkeypatch.setattr(KnownEffects, "cost", lambda self, problem, term: alone if problem is asked.problem else beside)
    contribution = cosine * WAVE + np.sqrt(1 - cosine**2) * OTHER
    return asked(scored(**{"family": "generic", "contribution": [contribution] * 3, "after": 0.5, **of}))


PLACE = "it takes the place of term0"


@pytest.mark.parametrize(
    ("alone", "beside", "cosine", "expected"),
    [
        (100.0, 9.9, 1.0, PLACE),
        (100.0, 10.1, 1.0, None),
        (20.1, 1.0, 1.0, PLACE),
        (19.9, 1.0, 1.0, None),
        (100.0, 1.0, 0.901, PLACE),
        (100.0, 1.0, -0.901, PLACE),
        (100.0, 1.0, 0.899, None),
    ],
)
def test_a_known_effect_is_replaced_where_it_is_worth_a_tenth_beside_what_acts_alike(
    monkeypatch: pytest.MonkeyPatch, alone: float, beside: float, cosine: float, expected: str | None
) -> None:
    assert replacing(monkeypatch, alone, beside, cosine) == expected


def test_what_takes_most_away_replaces_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    assert replacing(monkeypatch, 100.0, 1.0, after=0.401) == PLACE
    assert replacing(monkeypatch, 100.0, 1.0, after=0.399) is None
    for sure, expected in ((0.849, PLACE), (0.851, None)):
        evidence = evidence_of(sure, 1 - 0.399)
        found = replacing(monkeypatch, 100.0, 1.0, after=0.399, kin="near", evidence=evidence)
        assert found == expected, "but what sits at its place, unless it surely is missing"


def test_what_sits_at_its_place_takes_it_however_poor_the_model_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error before is 1: of a response of 1, or of 100."""
    for kin, expected in (("near", PLACE), ("related", None)):
        asked = Refinement(model("feed_x"), world(1.0), NOISE)
        monkeypatch.setattr(
            KnownEffects, "cost", lambda self, problem, term, whole=asked.problem: 100.0 if problem is whole else 1.0
        )
        assert asked(scored(kin=kin, contribution=[WAVE] * 3, after=0.5)) == expected


def test_what_names_another_heat_takes_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    assert replacing(monkeypatch, 100.0, 1.0, family="feed_y") is None
    assert replacing(monkeypatch, 100.0, 1.0, family="feed_y", kin="related") == PLACE


def test_the_cost_of_an_effect_is_asked_in_earnest() -> None:
    """A column beside the known one that does the same makes it worthless; a second term is left alone."""
    rng = np.random.default_rng(0)
    both = Parts(100 * (WAVE + OTHER) + 0.1 * rng.normal(size=ROWS), base=100 * np.column_stack([WAVE, OTHER]))
    one = problem(*[both] * 3)
    asked = Refinement(model("feed_x", "feed_y"), one, NOISE)
    twin = scored(contribution=[100 * WAVE] * 3, after=0.5, family="generic")
    assert asked.known.cost(one, 0) > 1000.0
    assert asked(twin) == "it takes the place of term0"
    assert asked(scored(contribution=[100 * OTHER] * 3, after=0.5, family="generic")) == "it takes the place of term1"
    assert asked(scored(contribution=[100 * (WAVE + OTHER)] * 3, after=0.5, family="generic")) is None


def test_an_effect_is_dropped_with_its_time_constants_and_what_was_added_stays() -> None:
    effect = PlainEffect("known0", params=(TAU,))
    fitted = SimpleNamespace(terms=(SimpleNamespace(id="a", family="x", effect=effect), *model("feed_y").terms))
    base, slack = np.arange(4.0) + np.zeros((ROWS, 4)), np.arange(5.0) + np.zeros((ROWS, 5))
    one = problem(*[Parts(WAVE, base=base, slack=slack)] * 2)
    asked = Refinement(fitted, one, NOISE)  # type: ignore[arg-type]
    first, second = (asked.known.without(one, term).blocks[0] for term in (0, 1))
    assert (first.base[0].tolist(), first.slack[0].tolist()) == ([2.0, 3.0], [4.0])
    assert (second.base[0].tolist(), second.slack[0].tolist()) == ([0.0, 1.0, 3.0], [0.0, 1.0, 2.0, 3.0, 4.0])


# ---- a temperature that counts from another


def counted(monkeypatch: pytest.MonkeyPatch, other: Float1D | None = None, **of: Any) -> str | None:
    """other: the known effect driven by the candidate's channel; minus it is what the candidate does. known: what that
    effect does in each test, and moves: what the machine does in the last two."""
    answer = WAVE if other is None else other
    monkeypatch.setattr(refinement, "from_other_zero", lambda fitted, term, channel, test: answer)
    families = of.pop("families", "feed_x")
    plain = {"family": "ambient", "contribution": [-0.5 * WAVE] * 3, "after": 0.5, "size": 0.5}
    known, moves = of.pop("known", [1.0, 1.0, 1.0]), of.pop("moves", 100.0)
    parts = [
        Parts(size * WAVE, base=k * OTHER[:, None], values={"T_a": WAVE}, channels={"T_a": WARM})
        for k, size in zip(known, [100.0, moves, moves], strict=True)
    ]
    asked = Refinement(model(families), problem(*parts), NOISE)
    return asked(scored(**{**plain, **of}))


ZERO = "it acts as term0 would if its temperature counted from T_a"


def test_what_acts_as_minus_a_known_effect_counts_from_another_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    assert counted(monkeypatch) == ZERO
    assert counted(monkeypatch, family="generic", passive=True) == ZERO
    assert counted(monkeypatch, family="generic", placeless=True) == ZERO
    assert counted(monkeypatch, family="generic") is None, "a source of heat surrounds nothing"
    assert counted(monkeypatch, family="feed_y") is None, "what names a heat means it"
    assert counted(monkeypatch, families="ambient") is None, "the air counts from nothing"
    assert counted(monkeypatch, channels=("T_a", "T_b")) is None
    assert counted(monkeypatch, channels=("n",)) is None, "no temperature"
    assert counted(monkeypatch, contribution=[0.5 * WAVE] * 3) is None, "the wrong way"


@pytest.mark.parametrize(("cosine", "expected"), [(0.801, ZERO), (0.799, None)])
def test_it_acts_against_the_known_effect(monkeypatch: pytest.MonkeyPatch, cosine: float, expected: str | None) -> None:
    turned = cosine * WAVE + np.sqrt(1 - cosine**2) * OTHER
    assert counted(monkeypatch, contribution=[-turned] * 3, known=[9.0] * 3) == expected


@pytest.mark.parametrize(("share", "expected"), [(0.199, None), (0.201, ZERO), (1.499, ZERO), (1.501, None)])
def test_it_takes_away_a_fifth_to_one_and_a_half(
    monkeypatch: pytest.MonkeyPatch, share: float, expected: str | None
) -> None:
    assert counted(monkeypatch, contribution=[-share * WAVE] * 3, known=[9.0] * 3) == expected


@pytest.mark.parametrize(("size", "expected"), [(0.599, ZERO), (0.601, None)])
def test_it_is_smaller_than_the_known_effect(
    monkeypatch: pytest.MonkeyPatch, size: float, expected: str | None
) -> None:
    assert counted(monkeypatch, size=size) == expected


@pytest.mark.parametrize(("evidence", "expected"), [(999.0, ZERO), (1001.0, None)])
def test_what_is_as_evident_as_one_a_sample_is_no_other_zero(
    monkeypatch: pytest.MonkeyPatch, evidence: float, expected: str | None
) -> None:
    assert counted(monkeypatch, evidence=evidence) == expected


@pytest.mark.parametrize(("moves", "expected"), [(0.299, ZERO), (0.301, None)])
def test_where_the_known_effect_rests_the_machine_does_not_move_by_another_zero(
    monkeypatch: pytest.MonkeyPatch, moves: float, expected: str | None
) -> None:
    """The candidate does 0.5 there, and 0.6 of it is asked: else the known effect takes it back."""
    assert counted(monkeypatch, known=[1.0, 0.2, 0.2], moves=moves) == expected
    assert counted(monkeypatch, known=[1.0, 0.6, 0.2], moves=moves) == ZERO, "in one test alone it may be chance"


def test_what_does_nothing_counts_from_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    assert counted(monkeypatch, contribution=[0.0 * WAVE] * 3) is None
    assert counted(monkeypatch, other=0.0 * WAVE) is None


def test_a_known_effect_by_another_temperature(spec: Model) -> None:
    data = make_data(tests=3)
    (response,) = fit_model(spec, data, uncertainty=False).responses
    test, (term,) = data.tests[0], response.terms
    found = from_other_zero(response, 0, "T_hall", test)
    rise = test.values["T_hall"] - test.values["T_hall"][0]
    assert found is not None
    tau = term.params["tau"] * 60.0
    np.testing.assert_allclose(np.ptp(found), np.ptp(term.gains["gain"] * lag(rise, tau, STEP_S)), rtol=0.05)
    own = from_other_zero(response, 0, "T_bearing", test)
    np.testing.assert_allclose(own, term.contribution(test), atol=1e-9)
    assert from_other_zero(response, 0, "T_nowhere", test) is None
    assert is_warm(test, "T_hall")
    assert not is_warm(test, "spindle_speed")
    assert not is_warm(test, "T_nowhere")


def test_what_a_speed_drives_counts_from_no_temperature(spec: Model) -> None:
    name = next(
        n for n, e in effects().items() if n.startswith("spindle") and e.needs[0].quantity == "rotational_speed"
    )
    by_speed = spec.model_copy(
        update={"effects": [EffectSpec(effect=name, drivers={effects()[name].needs[0].role: "spindle_speed"})]}
    )
    data = make_data(tests=3)
    (response,) = fit_model(by_speed, data, uncertainty=False).responses
    assert from_other_zero(response, 0, "T_hall", data.tests[0]) is None
