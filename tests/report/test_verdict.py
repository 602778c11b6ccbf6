"""A verdict in words: every claim, every refinement, probabilities, and no word against another."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import pytest

from thermodata.diagnosis.claims.probability import CLAIMED, PLACELESS_CLAIMED
from thermodata.report.collected.collect import _reason
from thermodata.report.collected.data import ReportData
from thermodata.report.page.error_rows import error_rows, headline_error
from thermodata.report.page.headline import error_sentence, headline, sentences
from thermodata.report.page.page import render
from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.verdict.candidate_errors import beside
from thermodata.report.verdict.explainable import explainable
from thermodata.report.verdict.left_over import in_parts
from thermodata.report.verdict.refined import named
from thermodata.report.verdict.verdict import causes, probability, told, verdict_sentence
from thermodata.schema.agreed.limits import CLAIMS_ASK
from thermodata.schema.answers.candidate import Candidate, LeftOut, Rung
from thermodata.schema.answers.diagnosis import Artefact, ClockMoved, Diagnosis, NotAsked, PutRight, StartedOn, WeakSpot
from thermodata.schema.answers.missing_heat import Unknown
from thermodata.schema.words.sentences import listed

from ..answers import candidate
from .conftest import diagnosis


def one(effect: str, **more: Any) -> Candidate:
    given = {"p_value": 0.005, "rmse_um_before": 4.0, "rmse_um_after": 1.0, "fit_before": None, "fit_after": None}
    return candidate(f"{effect}:T", **{"why": f"because of {effect}", **given, **more})


def among(*others: str) -> str:
    return f"where it acts (4 of 4 tests), beside {' and '.join(others)}, the error falls (2.00 -> 1.00 um)"


def claim(effect: str, share: float | None = 0.94, **more: Any) -> Candidate:
    locked = {"locked_rmse_um_before": 5.0, "locked_rmse_um_after": 2.0}
    return one(effect, **{"claimed": True, "probability": share, **locked, **more})


def found(verdict: Any, candidates: Sequence[Candidate], **more: Any) -> Diagnosis:
    return diagnosis().model_copy(update={"verdict": verdict, "candidates": list(candidates), "artefacts": [], **more})


def test_what_a_claim_asks_is_what_is_said_of_it() -> None:
    assert CLAIMS_ASK == (CLAIMED, PLACELESS_CLAIMED)


def test_a_clock_that_could_not_be_aligned_is_named_in_the_verdict() -> None:
    said = "the clock of nc is doubtful in 01_night: measuring comes from it"
    for verdict in ("effect", "none", "unknown", "refine"):
        assert verdict_sentence(found(verdict, [claim("nut")], doubtful_clocks=[said])).endswith(f"; {said}")
        assert "doubtful" not in verdict_sentence(found(verdict, [claim("nut")]))


@pytest.mark.parametrize(
    ("share", "text"),
    [
        *((None, ""), (0.94, "94 %"), (0.9996, "over 99 %"), (1.0, "100 %"), (0.004, "under 1 %"), (0.0, "under 1 %")),
        *((0.6453, "64.5 %"), (0.65, "65 %"), (0.6549, "65 %"), (0.4996, "49.96 %")),
    ],
)
def test_a_probability_is_a_share_in_percent_and_never_certain_below_one(share: float | None, text: str) -> None:
    assert probability(share) == text


@pytest.mark.parametrize(
    ("effect", "twins", "told"),
    [
        ("lag", ["coolant:T"], "lag (T), which may be coolant"),
        ("lag", ["lag:T_b", "tank:T_b", "coolant:T", "pump:T"], "lag (T), which may be coolant"),
        ("lag", ["coolant:T_b"], "lag (T)"),
        ("sun", ["coolant:T"], "sun (T)"),
    ],
)
def test_a_lag_says_by_which_name_it_may_go(effect: str, twins: list[str], told: str) -> None:
    told_first = verdict_sentence(found("effect", [claim(effect, equivalent=twins)])).removeprefix("missing: ")
    name, _, sure = told_first.partition("; ")[0].partition(", probability ")
    assert name.partition(", not told from ")[0] == told
    assert sure.startswith("94 %")


def test_names_are_listed_with_an_and() -> None:
    assert [listed(["a", "b", "c"][:n]) for n in range(4)] == ["", "a", "a and b", "a, b and c"]
    assert (named(one("sun")), named(one("sun", drivers=[]))) == ("sun (T)", "sun")


def test_one_claim_is_told_with_its_probability_and_both_errors() -> None:
    assert verdict_sentence(found("effect", [claim("screw"), one("other", probability=0.2)])) == (
        "missing: screw (T), probability 94 %; error on left-out tests 4.00 -> 1.00 um; locked tests 5.00 -> 2.00 um"
    )
    bare = claim("screw", None, locked_rmse_um_before=None, locked_rmse_um_after=None)
    assert verdict_sentence(found("effect", [bare])) == "missing: screw (T); error on left-out tests 4.00 -> 1.00 um"


def test_a_claim_names_the_effects_on_other_channels_that_it_cant_be_told_from() -> None:
    twins = ["lag:T_other", "screw:v", "lag:T", "motor:T_mot", "motor:T_mot_2", "oil:T", "guide:T_g,v", "sun:E"]
    text = verdict_sentence(found("effect", [claim("screw", equivalent=twins)]))
    assert text.startswith(
        "missing: screw (T), not told from motor (T_mot) and guide (T_g, v), probability 94 % (that it is one of "
        "these); "
    )
    assert "not told" not in verdict_sentence(found("effect", [claim("screw", equivalent=["lag:T", "oil:T"])]))


def test_all_claims_of_one_answer_are_told() -> None:
    def all_of(*names: str) -> list[Candidate]:
        given: dict[str, Any] = {"screw": {}, "sun": {"share": 0.7, "rmse_um_before": 2.0}, "oil": {"share": None}}
        return [claim(n, why=among(*(f"{o}:T" for o in names if o != n)), **given[n]) for n in names]

    assert verdict_sentence(found("effect", all_of("screw", "sun"))) == (
        "missing: screw (T), probability 94 %, and sun (T), probability 70 %; error on left-out tests, each beside the "
        "other: screw 4.00 -> 1.00 um, sun 2.00 -> 1.00 um; locked tests with both: 5.00 -> 2.00 um"
    )
    text = verdict_sentence(found("effect", all_of("screw", "sun", "oil")))
    assert text.startswith("missing: screw (T), probability 94 %, sun (T), probability 70 %, and oil (T); ")
    assert "each beside the others: " in text
    assert "locked tests with all 3: " in text


@pytest.mark.parametrize("verdict", ["none", "refine"])
def test_what_the_model_as_it_stands_lacks_is_told_first(verdict: Any) -> None:
    second = one("mode", refinement=True, as_modelled=True, rmse_um_before=3.0, rmse_um_after=0.6)
    given = {"rmse_um": 0.5, "noise_um": 0.1, "modelled_rmse_um": 3.0}
    text = verdict_sentence(found(verdict, [second], **given))
    assert text.startswith(
        "as the model has its effects, one lag each, it leaves 3.00 um on left-out tests (0.500 um with these free to "
        "act otherwise, as errors of a claim are told), and 0.600 um with mode (T), another mode of them or a cause "
        "that they hide: add it, "
    )
    twice = verdict_sentence(found(verdict, [second], **{**given, "rmse_um": 1.4}))
    assert "it leaves 3.00 um on left-out tests, and 0.600 um with mode (T), another" in twice
    assert "; where its effects may act otherwise, the open tests show no missing effect: 0.500 um are left on " in text
    assert "refined by" not in text
    alone = verdict_sentence(found("none", [one("mode")], **given))
    assert "as the model has them it leaves 3.00 um, and no effect that is logged takes 30 % of that away" in alone
    near = verdict_sentence(found("none", [one("mode")], **{**given, "modelled_rmse_um": 0.74}))
    assert "as the model has them" not in near, "half as much again is told"


def test_one_test_that_makes_nearly_all_of_what_the_model_leaves_as_it_stands_is_named() -> None:
    """After `add` of a claim by 4.86 -> 1.51 um the next answer began with 12.6 um: 33.1 um of one test, without
    which an effect and its second lag all but cancel."""

    def left(test: str, before: float, after: float) -> LeftOut:
        return LeftOut(
            campaign="c", test=test, from_s=0.0, to_s=3600.0, acts=True, rmse_um_before=before, rmse_um_after=after
        )

    parts = [left("const", 1.6, 0.7), left("spec", 1.0, 0.6), left("mix", 21.7, 1.5)]
    second = one("mode", refinement=True, as_modelled=True, rmse_um_before=12.6, rmse_um_after=0.84, left_out=parts)
    text = verdict_sentence(found("refine", [second], rmse_um=2.15, modelled_rmse_um=12.6))
    assert text.startswith(
        "as the model has its effects, one lag each, it leaves 12.6 um on left-out tests (2.15 um with these free to "
        "act otherwise, as errors of a claim are told), and 0.840 um with mode (T) (1.33 -> 0.652 um without mix, "
        "which the others foretell badly), another mode"
    )


def test_what_refines_the_model_is_told_with_the_names_that_it_cannot_be_told_from() -> None:
    """The lag of a channel that drives nothing stood for a screw of another one, which the JSON alone had."""
    twins = ["lag:T_nut", "feed_screw:T_nut", "gain_by:air,conditions.tool.id", "phases:air,heating,cooling"]
    second = one("lag", refinement=True, equivalent=[*twins, "coolant:T"], rmse_um_before=3.0, rmse_um_after=0.6)
    apart = "lag (T), which may be coolant, not told from feed_screw (T_nut)"
    as_it_stands = second.model_copy(update={"as_modelled": True})
    text = verdict_sentence(found("refine", [as_it_stands], modelled_rmse_um=3.0))
    assert f"and 0.600 um with {apart}, another mode of them or a cause that they hide" in text
    assert f"can be refined by {apart}, error on left-out" in verdict_sentence(found("refine", [second]))
    both = verdict_sentence(found("effect", [claim("screw"), second, one("mode", refinement=True)]))
    assert both.endswith(f"can be refined by {apart}, and by mode (T)")
    named = second.model_copy(update={"effect": "mode"})
    assert "mode (T), error" in verdict_sentence(found("refine", [named])), "a name says which physics it is"
    changed = second.model_copy(update={"effect": "air", "phases": ["heating", "cooling"], "equivalent": twins})
    assert "not told from" not in verdict_sentence(found("refine", [changed]))


def test_what_the_model_was_made_without_ends_the_sentence() -> None:
    note = "made without V03: its probe is turned; mend it in the campaign file"
    text = verdict_sentence(found("effect", [claim("screw")], made_without=[note]))
    assert text.endswith("; this version was made without V03: its probe is turned, mend it in the campaign file")


def test_refinements_are_offered_and_never_missing() -> None:
    second, bearing = one("mode", refinement=True), one("bearing", refinement=True)
    assert verdict_sentence(found("refine", [second])) == (
        "the open tests show no missing cause that the model has nothing of; what the model has can be refined "
        "by mode (T), error on left-out tests 4.00 -> 1.00 um"
    )
    assert "refined by mode (T) and bearing (T), " in verdict_sentence(found("refine", [second, bearing]))
    assert "missing: mode" not in verdict_sentence(found("refine", [second, bearing]))
    both = verdict_sentence(found("effect", [claim("screw"), second]))
    assert both.startswith("missing: screw (T), ")
    assert both.endswith("; what the model has can be refined by mode (T)")
    assert verdict_sentence(found("unknown", [second])).endswith(
        "can be refined by mode (T), error on left-out tests 4.00 -> 1.00 um: add it and ask again"
    )


@pytest.mark.parametrize(
    ("left", "said"),
    [
        (1.0, ""),
        (1.1, "; 1.10 um stay then, 11 % of the response (the model fails most in day1, from 8.5 h to 18.5 h)"),
        (
            3.0,
            "; 3.00 um stay then, 30 % of the response (the model fails most in day1, from 8.5 h to 18.5 h), more than "
            "is mostly left of a machine that lacks nothing: heat of what nobody logs may be in it",
        ),
    ],
)
def test_what_stays_beside_a_refinement_is_told_where_it_is_more_than_is_left_alone(left: float, said: str) -> None:
    spot = WeakSpot(campaign="c", test="day1", from_s=30600.0, to_s=66600.0, rmse_um=9.0, state="hot")
    second = one("mode", refinement=True, rmse_um_after=left)
    told = verdict_sentence(found("refine", [second], named_rmse_um=left, response_um=10.0, weak_spots=[spot]))
    assert told.partition(" -> ")[2].partition(" um")[2] == said


def test_no_error_falls_upward() -> None:
    """Over all tests an error may rise though it falls where the effect acts, and locked tests are asked by shape."""
    rises = {"rmse_um_before": 0.61, "rmse_um_after": 0.80}
    text = verdict_sentence(
        found("effect", [claim("screw", locked_rmse_um_before=0.5, locked_rmse_um_after=0.6, **rises)])
    )
    assert "error on left-out tests (falls where it acts only; over all: 0.610 -> 0.800 um)" in text
    assert "locked tests (judged by their shape where it acts; from their first samples on: 0.500 -> 0.600 um)" in text
    assert "falls where" not in verdict_sentence(found("effect", [claim("screw")]))


def test_one_test_that_makes_nearly_all_of_an_error_that_rises_is_told_by_itself() -> None:
    """3.91 -> 5.75 um, of which a table that moves in one test alone made 11.5 -> 17.2 um: nothing else knew of it."""

    def left(test: str, before: float, after: float) -> LeftOut:
        whole = {"campaign": "c", "from_s": 0.0, "to_s": 3600.0, "acts": False}
        return LeftOut(test=test, rmse_um_before=before, rmse_um_after=after, **whole)

    tests = [left("idle", 0.3, 0.2), left("table", 6.0, 9.0), left("cutting", 2.0, 0.4)]
    error = (sum(t.rmse_um_before**2 for t in tests) / 3) ** 0.5
    rises = {"rmse_um_before": error, "rmse_um_after": 5.2}
    text = verdict_sentence(found("effect", [claim("chips", left_out=tests, **rises)]))
    assert "3.66 -> 5.20 um, and 1.43 -> 0.316 um without table, which the others foretell badly)" in text
    alike = [*tests[:1], left("table", 2.0, 9.0), *tests[2:]]
    error = (sum(t.rmse_um_before**2 for t in alike) / 3) ** 0.5
    plain = {"rmse_um_before": error, "rmse_um_after": 5.2}
    assert "foretell badly" not in verdict_sentence(found("effect", [claim("chips", left_out=alike, **plain)]))


@pytest.mark.parametrize(("fall", "falls"), [(0.01, True), (-0.3, False)])
def test_an_error_that_falls_nowhere_is_not_said_to_fall_where_the_effect_acts(fall: float, falls: bool) -> None:
    rung = Rung(name="fall", asks="", value=fall, limit=0.15, unit="1", at="least", holds=True, asked=True)
    mode = one("mode", refinement=True, rmse_um_before=1.38, rmse_um_after=1.48, rungs=[rung])
    text = verdict_sentence(found("refine", [mode]))
    assert ("(falls where it acts only; over all: 1.38 -> 1.48 um)" in text) is falls
    assert ("left-out tests are foretold no better (1.38 -> 1.48 um) with it, so adding it is not" in text) is not falls
    assert ("can be refined by" in text) is falls


@pytest.mark.parametrize(
    ("left_out", "fall", "locked", "advised", "weighs"),
    [
        ((1.0, 0.9), 0.1, None, True, False),
        ((1.0, 1.1), 0.1, None, True, False),
        ((1.0, 1.1), -0.1, None, False, False),
        ((1.0, 1.1), -0.1, (1.0, 0.8), False, True),
        ((1.0, 0.9), 0.1, (1.0, 0.8), True, False),
        ((1.0, 0.9), 0.1, (1.0, 1.3), False, False),
    ],
)
def test_what_lets_no_error_fall_is_not_advised(
    left_out: tuple[float, float], fall: float, locked: tuple[float, float] | None, advised: bool, weighs: bool
) -> None:
    """An error of left-out tests may rise over all where it falls in those in which the mode acts."""
    (before, after), (held, holds) = left_out, locked or (None, None)
    rungs = [Rung(name="fall", asks="", value=fall, limit=0.15, unit="1", at="least", holds=True, asked=True)]
    mode = one(
        "mode",
        refinement=True,
        rmse_um_before=before,
        rmse_um_after=after,
        locked_shape_um_before=held,
        locked_shape_um_after=holds,
        rungs=rungs,
    )
    text = verdict_sentence(found("unknown", [mode, one("other", refinement=True)]))
    assert "refined by other (T)" in text or advised
    assert text.endswith("add them and ask again") is advised
    assert ("add it and ask again" in text) is not advised
    assert ("mode (T) goes with what is left" in text and "not advised" in text) is not advised
    assert (
        "not advised, though locked tests are foretold better (1.00 -> 0.800 um about each one's mean)" in text
    ) is weighs
    claimed = verdict_sentence(found("effect", [claim("screw"), mode]))
    assert claimed.endswith("; what the model has can be refined by mode (T)") is advised


@pytest.mark.parametrize(
    ("share", "left", "locked", "said"),
    [
        (0.06, 0.7, None, "something may be missing, though models of machines that lack nothing leave as much (10 %"),
        (0.06, 3.5, None, "something may be missing, though models of machines that lack nothing leave as much (50 %"),
        (0.06, 3.6, None, "something is missing, and the evidence does not suffice"),
        (0.3, 0.7, None, "something is missing, and the evidence does not suffice"),
        (0.06, 0.7, 1.4, "something is missing on the locked tests, which"),
        (
            0.04,
            0.7,
            None,
            "something is left on left-out tests (0.700 um of the response's 7.00) that nothing logged is "
            "likely to explain, though models of machines that lack nothing leave as much (10 % of the response)",
        ),
        (
            0.04,
            3.6,
            None,
            "something is left on left-out tests (3.60 um of the response's 7.00) that nothing logged is "
            "likely to explain: ",
        ),
    ],
)
def test_something_is_missing_where_more_is_left_than_of_a_machine_that_lacks_nothing(
    share: float, left: float, locked: float | None, said: str
) -> None:
    """Or where a cause is plausible, or a claim left the locked tests with it."""
    known = {"rmse_um": left, "response_um": 7.0, "locked_rmse_um": locked}
    assert verdict_sentence(found("unknown", [one("sun", probability=share)], **known)).startswith(said)


def test_the_likeliest_says_by_which_name_it_may_go_and_what_else_it_may_be() -> None:
    lag = one("lag", probability=0.41, equivalent=["oil:T"], unread=["axis.z.nut"])
    assert (
        "is lag (T), which may be oil or heat at axis.z.nut, which T can't tell from it, probability 41 %"
        in verdict_sentence(found("unknown", [lag]))
    )


def test_what_one_candidate_alone_takes_away_says_which() -> None:
    assert explainable(found("unknown", [], explainable=0.62, explainable_by="oil:T")) == (
        "the best candidate alone, oil:T, takes away 62 % of the squared residual, which by itself names no cause"
    )


def test_errors_beside_other_candidates_are_none_of_the_users_model_and_say_so() -> None:
    hidden = claim("screw", rmse_um_before=7.04, rmse_um_after=4.92, why=among("lag:t8", "lag:t2"))
    assert "error on left-out tests beside lag:t8 and lag:t2: 7.04 -> 4.92 um" in verdict_sentence(
        found("effect", [hidden])
    )
    own = found("effect", [hidden], rmse_um=7.04)
    assert "error on left-out tests 7.04 -> 4.92 um" in verdict_sentence(own), "from the model's own error"
    screw, sun = claim("screw"), claim("sun", why=among("screw:T"))
    assert "error on left-out tests: screw alone 4.00 -> 1.00 um, sun beside screw:T 4.00 -> 1.00 um; " in (
        verdict_sentence(found("effect", [screw, sun]))
    )
    known = claim("screw", beside=["oil:T"], why=among("sun:T"))
    assert beside(known, 4.0) == ["oil:T"], "what the answer says itself goes first"
    assert beside(claim("screw", beside=[], why=among("sun:T")), 9.0) == []
    apart = [claim("screw", beside=["sun:T"], rmse_um_after=0.196), claim("sun", beside=["screw:T"])]
    assert "(fitted in turn, the others as they stand, so these end apart)" in verdict_sentence(found("effect", apart))
    both = [claim("screw", why=among("sun:T")), sun]
    assert "each beside the other: screw 4.00 -> 1.00 um, sun 4.00 -> 1.00 um" in verdict_sentence(
        found("effect", both)
    )


def test_the_errors_of_a_headline_are_of_the_users_model_and_of_all_that_it_names() -> None:
    """Whatever else a claim was judged beside: nobody adds that."""
    hidden = claim("screw", rmse_um_before=3.05, rmse_um_after=1.30, beside=["lag:t2"])
    text = verdict_sentence(found("effect", [hidden], rmse_um=1.46, named_rmse_um=1.16))
    assert "; error on left-out tests 1.46 -> 1.16 um; " in text
    both = verdict_sentence(found("effect", [hidden, claim("sun")], rmse_um=1.46, named_rmse_um=1.16))
    assert "; error on left-out tests with both: 1.46 -> 1.16 um; locked tests with both: " in both
    worse = verdict_sentence(found("effect", [hidden], rmse_um=1.46, named_rmse_um=1.5))
    assert "error on left-out tests (falls where it acts only; over all: 1.46 -> 1.50 um)" in worse
    mode = one("mode", refinement=True, beside=["oil:T"])
    text = verdict_sentence(found("refine", [mode], rmse_um=1.46, named_rmse_um=1.16))
    assert text.endswith("refined by mode (T), error on left-out tests 1.46 -> 1.16 um")
    two = [mode, one("bearing", refinement=True)]
    text = verdict_sentence(found("refine", two, rmse_um=1.27, named_rmse_um=2.12))
    assert text.endswith("foretold worse with all of them (1.27 -> 2.12 um): add one, and ask again")


def test_what_is_not_excluded_says_how_probable_it_is() -> None:
    assert verdict_sentence(found("none", [one("sun", probability=0.14)])).endswith(
        "; not excluded: sun (T), probability 14 %"
    )


def test_what_is_as_probable_as_a_claim_and_not_excluded_says_what_stops_it_and_its_twins() -> None:
    rungs = [
        rung("worth", holds=False).model_copy(update={"fails": "it explains 1.8 % of the response (limit 10 %)"}),
        rung("probability", holds=True),
    ]
    likely = one("motor", probability=0.71, equivalent=["screw:T_n"], rungs=rungs)
    text = verdict_sentence(found("none", [likely]))
    assert text.startswith("the open tests show no missing effect that may be named: ")
    assert text.endswith(
        "; not excluded: motor (T), not told from screw (T_n), probability 71 % (that it is one of these): "
        "enough for a claim, which asks 50 %, but it explains 1.8 % of the response (limit 10 %); "
        "thermodata confirm b1 motor:T asks the locked tests of it, where there are some"
    )
    unlikely = likely.model_copy(update={"probability": 0.4, "rungs": [rungs[0], rung("probability", holds=False)]})
    assert verdict_sentence(found("none", [unlikely])).endswith(
        "motor (T), not told from screw (T_n), probability 40 % (that it is one of these)"
    )


@pytest.mark.parametrize(("shape", "said"), [(None, "0.549 um"), (0.22, ""), (0.5, "0.500 um")])
def test_locked_and_left_out_tests_are_held_against_each_other_with_a_free_level(
    shape: float | None, said: str
) -> None:
    known = found("none", [], rmse_um=0.197, locked_rmse_um=0.549, locked_shape_um=shape)
    told = f"but an earlier claim left the locked tests with {said}"
    assert (told in verdict_sentence(known)) is bool(said)
    assert ("an earlier claim" in verdict_sentence(known)) is bool(said)
    assert "on locked tests" in diagnosis_text(known)
    assert ("about each one's mean, 0.549 um from first samples on" in diagnosis_text(known)) is (shape is not None)


def test_nothing_is_missing_only_as_the_logs_are_dated_where_a_clock_was_not_moved() -> None:
    hint = Artefact(kind="clock_offset", campaign="c", test="feed20", at_s=None, size_um=None, why="odd ends")
    text = verdict_sentence(found("none", [], artefacts=[hint]))
    assert text.startswith(
        "a clock may be off in feed20, by which nothing was moved: first try what the artefact says, for until then "
        "something may be missing; the open tests show no missing effect as the logs are dated: "
    )
    moved = PutRight(clocks=[ClockMoved(source="nc", campaign="c", test="feed20", moved_s=-2405.0)])
    assert "may be off" not in verdict_sentence(found("none", [], artefacts=[hint], put_right=moved))
    for mode in (one("m", refinement=True), one("m", refinement=True, as_modelled=True)):
        refined = verdict_sentence(found("refine", [mode], artefacts=[hint]))
        assert refined.startswith("a clock may be off in feed20, ")
        assert "as the logs are dated" in refined


@pytest.mark.parametrize(
    ("tests", "said"),
    [
        (("a", "b"), ""),
        (("a", "a"), "1 open test is too few to leave one out, so 2 parts of it are"),
        (("a", "a", "b", "b"), "2 open tests are too few to leave one out, so 4 parts of them are"),
    ],
)
def test_where_parts_of_tests_are_left_out_that_is_said(tests: Sequence[str], said: str) -> None:
    parts = [
        LeftOut(campaign="c", test=t, from_s=0, to_s=1, acts=True, rmse_um_before=2, rmse_um_after=1) for t in tests
    ]
    text = in_parts(found("none", [one("sun", left_out=parts)]))
    assert text.startswith(said)
    assert ("each with a level of its own" in text) is bool(said)
    assert in_parts(found("none", [one("sun")])) == ""


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        (
            (0.4, 0.3),
            "; locked tests get better by their shape where it acts (0.400 -> 0.300 um), which a claim is judged by, "
            "and worse as they are scored, from their first samples on (0.500 -> 0.600 um)",
        ),
        ((0.4, 0.5), "get worse"),
    ],
)
def test_locked_tests_that_get_worse_by_their_shape_too_are_not_called_judged_by_it(
    shape: tuple[float, float], said: str
) -> None:
    before, after = shape
    locked = {"locked_rmse_um_before": 0.5, "locked_rmse_um_after": 0.6}
    one = claim("screw", **locked, locked_shape_um_before=before, locked_shape_um_after=after)
    text = verdict_sentence(found("effect", [one]))
    assert said in text
    assert ("locked tests get worse (0.500 -> 0.600 um, by their shape 0.400 -> 0.500 um)" in text) is (
        said == "get worse"
    )


@pytest.mark.parametrize(
    ("scored", "shape", "said"),
    [
        (
            (1.56, 0.777, 0.35),
            (None, None),
            "; locked tests 1.56 (0.777 once that model is fitted to all open tests) -> 0.350 um",
        ),
        ((0.78, 0.777, 0.35), (None, None), "; locked tests 0.777 -> 0.350 um"),
        (
            (0.747, 2.73, 0.9),
            (None, None),
            "; locked tests 0.747 (2.73 once that model is fitted to all open tests) -> 0.900 um: with the model "
            "as it is fitted it is less; this is with one lag for each effect: add may give it a second one, "
            "and tells what that version leaves",
        ),
        (
            (1.56, 0.777, 0.83),
            (0.574, 0.656),
            "; locked tests 1.56 (0.777 once that model is fitted to all open tests) -> 0.830 um, by their "
            "shape 0.574 -> 0.656 um from there on: they get better than with the model as it is fitted, and worse "
            "than once that model is fitted to all open tests",
        ),
        (
            (1.56, 0.777, 0.83),
            (0.7, 0.5),
            "; locked tests get better by their shape where it acts (0.700 -> 0.500 um), which a claim is judged by, "
            "and as they are scored, from their first samples on, 1.56 (0.777 once that model is fitted to all "
            "open tests) -> 0.830 um",
        ),
    ],
)
def test_before_on_locked_tests_is_the_model_that_the_user_has(
    scored: tuple[float, float, float], shape: tuple[float | None, float | None], said: str
) -> None:
    """0.777 of a refit that nobody has got "worse" by a version that leaves half of what the user's model leaves."""
    fitted, before, after = scored
    locked = {"locked_rmse_um_fitted": fitted, "locked_rmse_um_before": before, "locked_rmse_um_after": after}
    shapes = {"locked_shape_um_before": shape[0], "locked_shape_um_after": shape[1]}
    assert verdict_sentence(found("effect", [claim("screw", **locked, **shapes)])).endswith(said)


def test_a_shape_that_falls_far_more_than_the_error_as_scored_is_told() -> None:
    """24 % beside a probability of 99 %: what remains is where the tests start."""
    locked = {"locked_rmse_um_before": 2.34, "locked_rmse_um_after": 1.78}
    far = claim("screw", **locked, locked_shape_um_before=2.29, locked_shape_um_after=0.847)
    assert verdict_sentence(found("effect", [far])).endswith(
        "; locked tests (judged by their shape where it acts, 2.29 -> 0.847 um; from their first samples on: "
        "2.34 -> 1.78 um)"
    )
    near = claim("screw", **locked, locked_shape_um_before=2.29, locked_shape_um_after=1.6)
    assert verdict_sentence(found("effect", [near])).endswith("; locked tests 2.34 -> 1.78 um")


def test_locked_tests_in_which_a_claim_rests_are_not_said_to_have_judged_it() -> None:
    rests = {"locked_rmse_um_before": 0.5, "locked_rmse_um_after": 0.6, "locked_tests_asked": 0}
    text = verdict_sentence(found("effect", [claim("screw", **rests)]))
    assert text.endswith(
        "; it hardly acts in the locked tests (under a fifth of its largest), so these can't bear it out; they were "
        "opened to see that they do not get twice as bad: 0.500 -> 0.600 um"
    )
    assert "not asked" not in text, "a look was counted"
    text = verdict_sentence(found("effect", [claim("screw", **rests), claim("sun", **rests)]))
    assert "; they hardly act in the locked tests (under a fifth of their largest)" in text


def test_what_is_unknown_does_not_deny_what_is_named_below() -> None:
    text = verdict_sentence(
        found("unknown", [one("mode", refinement=True, probability=0.9), one("sun", probability=0.35)])
    )
    assert "the likeliest that was logged is sun (T), probability 35 %" in text
    assert "nothing logged" not in text
    assert verdict_sentence(found("unknown", [])) == ("something is missing, and nothing logged may be named for it")
    unread = Unknown(time_constants_h=[], hours_of_day=[], states=[], not_logged=0.574)
    assert verdict_sentence(found("unknown", [], unknown=unread)).endswith(
        "nothing logged may be named for it; that no logged channel reads its cause is 57 % probable"
    )


def rung(name: str, *, holds: bool) -> Rung:
    return Rung(name=name, asks="", value=1.0, limit=0.5, at="least", asked=True, holds=holds, unit="1")


@pytest.mark.parametrize(
    ("tests", "holds", "locked", "told"),
    [
        (2, True, (1.07, 1.09), ": enough for a claim, which asks 50 %, but the locked tests do not bear it out (1.07"),
        (2, True, (1.07, 0.99), ": enough for a claim, which asks 50 %, but the locked tests do not bear it out (1.07"),
        (2, True, (None, None), ": enough for a claim, which asks 50 %, but the locked tests do not bear it out"),
        (
            1,
            False,
            (0.66, 1.38),
            ", though the locked tests do not bear it out (0.660 -> 1.38 um about each one's mean)",
        ),
        (1, False, (1.4, 1.3), ""),
        (1, False, (None, None), ""),
        (None, True, (None, None), ""),
    ],
)
def test_the_likeliest_that_the_locked_tests_refuse_is_told_with_that(
    tests: int | None, holds: bool, locked: tuple[float | None, float | None], told: str
) -> None:
    """One that keeps all rules, and is no claim, is stopped by nothing else; one that is less probable for what they
    say has them beside its probability, too."""
    rungs = [rung("fall", holds=True), rung("probability", holds=holds)]
    shape = dict(zip(("locked_shape_um_before", "locked_shape_um_after"), locked, strict=True))
    first = one("sun", probability=0.82, locked_tests_asked=tests, rungs=rungs, **shape)
    text = verdict_sentence(found("unknown", [first]))
    _, _, rest = text.partition("the likeliest that was logged is sun (T), probability 82 %")
    assert rest.startswith(told)
    assert bool(rest) is bool(told)


@pytest.mark.parametrize(("tests", "said"), [(2, True), (0, False), (None, False)])
def test_that_the_lock_was_opened_for_what_is_not_claimed_is_said(tests: int | None, said: bool) -> None:
    text = verdict_sentence(found("unknown", [one("sun", probability=0.5, locked_tests_asked=tests)]))
    assert ("the evidence, with that of the locked tests, does not suffice to name a cause" in text) is said


@pytest.mark.parametrize(("locked", "said"), [(None, False), (2.9, False), (3.1, True)])
def test_what_only_the_locked_tests_show_is_said_of_them(locked: float | None, said: bool) -> None:
    for candidates in ([], [one("sun", probability=0.35)]):
        text = verdict_sentence(found("unknown", candidates, rmse_um=1.5, locked_rmse_um=locked))
        assert ("missing on the locked tests, which an earlier claim left with 3.1" in text) is said
    text = verdict_sentence(found("unknown", [one("sun", probability=0.03)], rmse_um=1.5, locked_rmse_um=locked))
    told = (
        "left on the locked tests, which an earlier claim left with 3.10 um, that nothing logged is likely to explain"
    )
    assert (told in text) is said


@pytest.mark.parametrize(("locked", "said"), [(None, False), (0.9, False), (3.1, True)])
def test_none_is_said_with_what_an_earlier_claim_left_on_the_locked_tests(locked: float | None, said: bool) -> None:
    text = verdict_sentence(found("none", [], rmse_um=0.5, locked_rmse_um=locked))
    assert text.startswith("the open tests show no missing effect: ")
    assert ("; but an earlier claim left the locked tests with 3.10 um, and these may lack one" in text) is said


@pytest.mark.parametrize(("error", "said"), [(1.02, True), (0.98, False)])
def test_none_is_said_with_the_hours_in_which_far_more_is_left(error: float, said: bool) -> None:
    """Twice the error on left-out tests; of weak spots, ranked by what they cost, the one of the largest error."""
    spots = [
        WeakSpot(campaign="c", test="t6", from_s=0, to_s=43_200, rmse_um=0.9, state="idle"),
        WeakSpot(campaign="c", test="t8", from_s=3600, to_s=14_400, rmse_um=error, state="idle"),
    ]
    text = verdict_sentence(found("none", [], rmse_um=0.5, weak_spots=spots))
    assert text.startswith("the open tests show no missing effect: ")
    assert (f"; most in t8, up to {error:.2f} um over 3.0 h as it is fitted" in text) is said
    assert ("most in" in text) is said
    other = [*spots, spots[0].model_copy(update={"campaign": "d"})]
    assert ("most in c/t8" in verdict_sentence(found("none", [], rmse_um=0.5, weak_spots=other))) is said
    assert "most in" not in verdict_sentence(found("none", [], rmse_um=None, weak_spots=spots))


def test_every_verdict_has_words_without_any_candidate() -> None:
    said = {v: verdict_sentence(found(v, [])) for v in ("effect", "refine", "none", "unknown", "not_testable")}
    assert len(set(said.values())) == len(said)
    assert said["refine"].startswith("the open tests show no missing cause that the model has nothing of")


def test_what_a_candidate_could_take_away_is_no_promise() -> None:
    assert explainable(found("none", [], explainable=None)) == ""
    assert explainable(found("none", [], explainable=0.0)) == ""
    assert explainable(found("none", [], explainable=0.4)) == (
        "the best candidate alone takes away 40 % of the squared residual, which by itself names no cause"
    )
    assert explainable(found("effect", [claim("sun")], explainable=0.996)) == (
        "the best candidate alone takes away over 99 % of the squared residual"
    )
    other = found("effect", [claim("sun")], explainable=0.76, explainable_by="lag:T_x")
    assert explainable(other).endswith("76 % of the squared residual, which by itself names no cause")


def test_below_several_claims_stands_what_all_take_away_beside_the_best_one_alone() -> None:
    two = {"rmse_um": 8.0, "named_rmse_um": 4.0, "explainable": 0.71}
    assert explainable(found("effect", [claim("sun"), claim("oil")], explainable_by="lag:T_table", **two)) == (
        "both together take away 75 % of the squared residual, the best candidate alone, lag:T_table, 71 %, which by "
        "itself names no cause"
    )
    own = claim("sun")
    assert explainable(found("effect", [own, claim("oil")], explainable_by=own.id, **two)).endswith(
        f"alone, {own.id}, 71 %, one of them"
    )
    assert explainable(found("effect", [claim(n) for n in "abc"], **two)).startswith("all 3 together take away 75 %")


def test_evidence_is_told_of_all_claims_and_refinements_else_of_the_first() -> None:
    a, b, mode, rest = claim("a"), claim("b"), one("mode", refinement=True), one("rest")
    assert told(found("effect", [a, b, mode, rest])) == [a, b, mode]
    assert told(found("unknown", [mode, rest, one("last")])) == [rest, mode]
    assert told(found("refine", [rest, mode])) == [mode, rest], "what the verdict names comes first"
    assert told(found("none", [])) == []


@pytest.mark.parametrize(("after", "also"), [(0.69, True), (0.71, False)])
def test_what_leaves_far_less_than_the_claim_is_told_too(after: float, also: bool) -> None:
    """From under 70 % of the claim's error on; but not what is said to be the claim, or where nothing is claimed."""
    rival = one("rival", rmse_um_after=after)
    assert told(found("effect", [claim("a"), rival])) == [claim("a"), *[rival] * also]
    assert told(found("effect", [claim("a", equivalent=["rival:T"]), rival])) == [claim("a", equivalent=["rival:T"])]
    assert told(found("unknown", [one("a"), rival])) == [one("a")]


def test_a_headline_of_several_long_claims_counts_them_and_each_has_a_line(blind: ReportData) -> None:
    twin = "feed_motor:a_motor_with_a_name_of_some_length"
    long = [claim(n).model_copy(update={"equivalent": [twin]}) for n in ("screw", "sun")]
    page = dataclasses.replace(blind, diagnosis=found("effect", long))
    assert headline(page) == "dZ misses 2 effects"
    assert sentences(page)[:2] == [f"{causes([c])}." for c in long]
    assert render(page).count('<p class="first">') == 2, "both as large"


def test_a_page_names_all_claims_with_their_probabilities(blind: ReportData) -> None:
    asked = found("effect", [claim("screw"), claim("sun", 0.7), one("mode", refinement=True), one("rest")])
    page = dataclasses.replace(blind, diagnosis=asked)
    assert headline(page) == "dZ misses screw (T), probability 94 %, and sun (T), probability 70 %"
    assert verdict_sentence(asked).startswith("missing: screw (T), probability 94 %, and sun (T), probability 70 %;")
    html = render(page)
    html = html[: html.index("<script>")]
    assert html.count('<span class="badge good">claimed</span>') == 2
    assert html.count('<span class="badge">refines</span>') == 1
    assert '<td class="n" data-label="probability">94 %</td>' in html
    for effect in ("screw", "sun", "mode"):
        assert f"because of {effect}" in html
    assert "because of rest" not in html


def test_three_claims_have_a_line_each_below_the_headline(blind: ReportData, data: ReportData) -> None:
    asked = found("effect", [claim("screw"), claim("sun", 0.7), claim("oil", 0.8)])
    page = dataclasses.replace(blind, diagnosis=asked)
    assert headline(page) == "dZ misses 3 effects"
    assert sentences(page)[:3] == [
        "screw (T), probability 94 %.",
        "sun (T), probability 70 %.",
        "oil (T), probability 80 %.",
    ]
    added = dataclasses.replace(data, reason=asked, effects=("air", "screw", "sun", "oil"))
    assert headline(added) == "Missing in dZ were 3 effects"
    assert sentences(added)[:3] == sentences(page)[:3]


def test_a_page_tells_why_of_each_claim_that_was_added(data: ReportData) -> None:
    asked = found("effect", [claim("screw"), claim("sun", equivalent=["oil:T", "air:T"])])
    html = render(dataclasses.replace(data, reason=asked, effects=("air", "screw", "sun")))
    assert "screw:T: because of screw." in html
    assert "sun:T: because of sun." in html
    assert "and sun (T), probability 94\u00a0%" in html
    assert "These tests can&#39;t tell sun:T from oil:T and air:T." in html


def test_locked_errors_are_those_of_all_claims_only_where_all_were_added(data: ReportData) -> None:
    asked = found("effect", [claim("screw"), claim("sun")])
    both = dataclasses.replace(data, reason=asked, effects=("air", "screw", "sun_2"))
    assert {r.word: (r.before, r.after) for r in error_rows(both)}["locked"] == (5.0, 2.0)
    assert "locked" not in {r.word for r in error_rows(dataclasses.replace(both, effects=("air", "screw", "sunny")))}


def test_the_page_has_the_model_as_it_is_fitted_before_what_is_claimed(data: ReportData) -> None:
    asked = found("effect", [claim("screw", locked_rmse_um_fitted=7.0)])
    added = dataclasses.replace(data, reason=asked, effects=("air", "screw"))
    (row,) = (r for r in error_rows(added) if r.word == "locked")
    assert (row.before, row.after) == (7.0, 2.0)
    assert "before: 5 um once that model is fitted to all open tests" in row.notes
    # what the refit takes away is no merit of the effect
    both = "7.00 (5.00 once that model is fitted to all open tests) -> 2.00 um (-60 % from 5.00"
    said = f"The error on locked tests falls: {both}"
    assert error_sentence(added).startswith(said)
    assert "\N{MINUS SIGN}60\N{NO-BREAK SPACE}%" in render(added)
    (row,) = (r for r in error_rows(dataclasses.replace(data, diagnosis=asked, reason=None)) if r.word == "locked")
    assert (row.before, row.after) == (None, 7.0)
    assert "5 um once that model is fitted to all open tests; 2 um with what is claimed" in row.notes


def test_errors_of_claims_on_other_data_or_of_another_fit_are_none_of_the_version(data: ReportData) -> None:
    asked = found("effect", [claim("screw")])
    own = dataclasses.replace(data, reason=asked, effects=("air", "screw"))
    assert {"locked", "left-out"} <= {r.word for r in error_rows(own)}
    other = dataclasses.replace(own, reason_of_fit=False)
    assert {r.word for r in error_rows(other)} == {"verification", "fitted"}
    assert headline(other).startswith("Missing in dZ was screw")
    # with a second lag beside the claim its errors were foretold of nearly this model, and are told as such
    lagged = dataclasses.replace(other, reason_but_for=("screw_lag2",))
    rows = {r.word: r for r in error_rows(lagged)}
    assert list(rows) == ["locked", "left-out", "verification", "fitted"]
    assert [word for word, r in rows.items() if r.foretold] == ["locked", "left-out"]
    scored = {r.word: r for r in error_rows(dataclasses.replace(lagged, left_on_locked=1.23))}
    assert [word for word, r in scored.items() if r.foretold] == ["left-out"]
    assert (scored["locked"].before, scored["locked"].after) == (rows["locked"].before, 1.23)
    assert scored["locked"].tested, "add scored this very version on the tests that were opened for its claim"
    head = headline_error(list(rows.values()))
    assert head is not None
    assert head.word == "verification", "none of those that are of another model"
    assert any(
        line.startswith("Foretold for one lag of each effect: this version has screw_lag2 too; the error on locked")
        for line in sentences(lagged)
    )


def test_the_reason_of_a_version_stands_as_far_back_as_its_answer_has_claims() -> None:
    single, pair = found("effect", [claim("a")]), found("effect", [claim("a"), claim("b")])
    assert _reason([]) is None
    assert _reason([single]) == 0
    assert _reason([pair, None]) == 0
    assert _reason([single, None]) is None
    assert _reason([pair, None, None]) is None
    assert _reason([pair, single]) == 1


@pytest.mark.parametrize("verdict", ["none", "refine"])
def test_a_cause_that_is_not_excluded_is_named_though_none_is_said_to_be_missing(verdict: str) -> None:
    mode = [one("mode", refinement=True, drivers=["T_b"])]
    screw = one("screw", probability=0.24, unread=["axis.z.guide"])
    text = verdict_sentence(found(verdict, [*mode, screw]))
    assert text.endswith(
        "; not excluded: screw (T) or heat at axis.z.guide, which T can't tell from it, probability 24 %"
    )
    again = one("lag", probability=0.24, drivers=["T_b"])
    for slight in (one("screw", probability=0.09), one("screw", probability=None), again):
        assert "not excluded" not in verdict_sentence(found(verdict, [*mode, slight]))
    likely = one("shift", probability=0.74, drivers=["T_b"], rungs=[rung("probability", holds=True)])
    assert verdict_sentence(found(verdict, [*mode, likely])).endswith("; not excluded: shift (T_b), probability 74 %")


@pytest.mark.parametrize(("fitted", "told_of"), [(0.29, False), (0.31, True), (None, False)])
def test_an_error_that_the_model_has_only_as_it_is_fitted_is_told(fitted: float | None, told_of: bool) -> None:
    text = verdict_sentence(found("none", [], rmse_um=0.1, noise_um=0.05, fitted_rmse_um=fitted))
    assert ("as it is fitted the model leaves 0.310 um on the open tests" in text) is told_of


def test_a_step_that_was_taken_out_of_left_out_errors_alone_is_said() -> None:
    """19.2 -> 0.402 um stood beside 42.2 min, fitted to the slip: the truth was 35 min."""
    step = Artefact(kind="step", campaign="c", test="V04", at_s=7890.0, size_um=14.0, why="")
    text = verdict_sentence(found("effect", [one("screw", claimed=True)], artefacts=[step]))
    assert "errors on left-out tests are without the step in V04 at 2.2 h (+14.0 um), but fits, parameters" in text
    assert "until the model is without (thermodata add b1 step:V04)" in text
    repeated = step.model_copy(update={"kind": "repeated_step"})
    assert "without the step" not in verdict_sentence(
        found("effect", [one("screw", claimed=True)], artefacts=[repeated])
    )


def test_an_error_as_fitted_says_from_where_it_counts_in_which_tests() -> None:
    text = verdict_sentence(found("none", [], rmse_um=0.1, noise_um=0.05, fitted_rmse_um=0.31))
    levels = "of calibration about levels fitted to them, others from their first samples on"
    assert f"0.310 um on the open tests ({levels})" in text


@pytest.mark.parametrize(("compared", "said"), [(120.0, ", 0.0194 um a mean of 2 min, as"), (60.0, ""), (None, "")])
def test_noise_is_told_over_the_means_that_left_out_tests_are_compared_by(compared: float | None, said: str) -> None:
    """An error of 0.0200 um beside a noise of 0.0275 um: that is of other means."""
    short = {"rmse_um": 0.02, "noise_um": 0.0275, "noise_over_s": 60.0, "left_out_over_s": compared}
    text = verdict_sentence(found("none", [], **short))
    assert f"noise (0.0275 um, by which a mean of 60 s scatters by chance{said}" in text
    assert ("left-out tests are compared by" in text) is bool(said)


@pytest.mark.parametrize(
    ("left", "compared", "noise"),
    [(0.0291, 120.0, True), (0.0293, 120.0, False), (0.0412, 60.0, True), (0.0412, None, True), (0.0414, 60.0, False)],
)
def test_what_is_left_is_held_against_noise_in_its_own_means(left: float, compared: float | None, noise: bool) -> None:
    """1.5 times the noise; an error in means of 2 min was called noise for it was no more than that of 60 s."""
    short = {"rmse_um": left, "noise_um": 0.0275, "noise_over_s": 60.0, "left_out_over_s": compared}
    text = verdict_sentence(found("none", [], **short))
    assert ("are left on left-out tests, and they are noise" in text) is noise
    assert ("but more than white noise leaves in theirs (0.0275 um" in text) is (left == 0.0293)


@pytest.mark.parametrize(("share", "likely"), [(0.049, False), (0.051, True)])
def test_what_is_hardly_likely_is_no_suspect(share: float, likely: bool) -> None:
    text = verdict_sentence(found("unknown", [one("screw", probability=share)], rmse_um=1.4, response_um=5.1))
    assert ("does not suffice to name a cause; the likeliest that was logged is screw (T)" in text) is likely
    assert ("on left-out tests (1.40 um of the response's 5.10) that nothing logged is likely" in text) is not likely


@pytest.mark.parametrize(("after", "said"), [(0.97, True), (0.99, False)])
def test_nothing_is_said_to_explain_what_is_left_but_what_refines_and_takes_much_of_it(
    after: float, said: bool
) -> None:
    """A bearing, by its kind a mode of the motor, took 6.62 to 4.12 um below "nothing logged is likely to explain"."""
    mode = one("screw", refinement=True, rmse_um_before=1.4, rmse_um_after=after)
    text = verdict_sentence(found("unknown", [one("oil", probability=0.02), mode], rmse_um=1.4, response_um=5.1))
    but = " that nothing logged is likely to explain but screw (T), which would refine what the model has"
    assert (but in text) is said


def test_nothing_logged_is_said_only_where_all_that_is_logged_was_asked() -> None:
    not_asked = Unknown(time_constants_h=[], hours_of_day=[], states=[], not_logged=0.77, by_name=["overhang:T,z"])
    some = [one("screw", probability=0.01)]
    text = verdict_sentence(found("unknown", some, rmse_um=1.4, response_um=5.1, unknown=not_asked))
    assert "that nothing that was asked for is likely to explain" in text
    assert (
        "; overhang (T, z) was not asked for, though all that drives it is logged; that no logged channel that" in text
    )
    assert text.endswith("was asked about reads its cause is 77 % probable")


@pytest.mark.parametrize(("left", "more"), [(5.0, False), (5.2, True)])
def test_an_error_larger_than_the_response_says_how_it_can_be(left: float, more: bool) -> None:
    text = verdict_sentence(found("unknown", [one("screw", probability=0.01)], rmse_um=left, response_um=5.1))
    worse = "more than the response's 5.10: fitted to the other tests, the model foretells a test worse than none would"
    assert (f"on left-out tests (5.20 um, {worse})" in text) is more
    assert ("on left-out tests (5.00 um of the response's 5.10)" in text) is not more


@pytest.mark.parametrize(
    ("right", "said"),
    [
        (PutRight(left_out=[("shop", "day2")]), "judged without day2, where the probe is turned round"),
        (PutRight(clocks=[ClockMoved(source="nc", moved_s=3660.0)]), "judged with the clock of nc moved by +61 min"),
        (
            PutRight(
                left_out=[("shop", "day2"), ("shop", "day3")],
                clocks=[
                    ClockMoved(source="nc", moved_s=3600.0),
                    ClockMoved(source="hall", campaign="shop", test="day1", moved_s=-3600.0),
                ],
            ),
            "judged without day2 and day3, where the probe is turned round, and with the clocks of nc moved by +60 min "
            "and of hall moved by -60 min in day1",
        ),
    ],
)
@pytest.mark.parametrize("verdict", ["effect", "unknown", "none", "refine", "not_testable"])
def test_what_was_put_right_in_the_logs_stands_beside_any_verdict(verdict: str, right: PutRight, said: str) -> None:
    answer = found(verdict, [claim("screw")] if verdict == "effect" else [], put_right=right)
    assert verdict_sentence(answer) == f"{verdict_sentence(answer.model_copy(update={'put_right': None}))}; {said}"


def test_the_head_of_the_page_says_what_was_put_right(data: ReportData) -> None:
    right = PutRight(left_out=[("demo", "day9")])
    page = render(dataclasses.replace(data, diagnosis=found("effect", [claim("screw")], put_right=right)))
    head = page[: page.index("<h2")]
    assert "Judged without day9, where the probe is turned round" in head


@pytest.mark.parametrize("failed", [[], [NotAsked(effect="zz", why="effect 'zz' failed: KeyError: 'zz'")]])
def test_an_effect_whose_plugin_fails_is_told_on_the_page_and_in_text(data: ReportData, failed: list[NotAsked]) -> None:
    answer = found("effect", [claim("screw")], not_asked=failed)
    page = render(dataclasses.replace(data, diagnosis=answer))
    assert ("<b>zz</b> was left out, for its plugin fails: effect &#39;zz&#39; failed: KeyError" in page) == bool(
        failed
    )
    said = "left out, for their plugins fail\n  ! zz: effect 'zz' failed: KeyError: 'zz'"
    assert (said in diagnosis_text(answer)) == bool(failed)
    assert ("for their plugins fail" in diagnosis_text(answer)) == bool(failed)


def test_a_verdict_without_a_claim_is_headed_by_its_first_words_and_told_to_its_end(data: ReportData) -> None:
    right = PutRight(left_out=[("demo", "day9")])
    told_so = dataclasses.replace(data, versions=data.versions[:1], diagnosis=found("none", [], put_right=right))
    assert headline(told_so).startswith("The open tests show no missing effect: ")
    assert ";" not in headline(told_so)
    assert sentences(told_so)[0] == "Judged without day9, where the probe is turned round."


@pytest.mark.parametrize(("share", "otherwise"), [(0.9, False), (0.87, True), (None, True)])
def test_the_level_of_a_test_that_begins_with_something_on_is_told_in_place_of_effects_that_act_otherwise(
    share: float | None, otherwise: bool
) -> None:
    t5: dict[str, object] = {
        "campaign": "A",
        "test": "t5",
        "on": "Coolant at 1",
        "rmse_um": 2.2,
        "left_um": 0.24,
        "of_squares": share,
    }
    started = [] if share is None else [StartedOn.model_validate(t5)]
    seen = found("none", [], rmse_um=0.1, noise_um=0.05, fitted_rmse_um=0.9)
    text = verdict_sentence(seen.model_copy(update={"started_on": started}))
    assert ("fit it to all of them, or add a second lag" in text) is otherwise
    level = "t5 begins with Coolant at 1, and the model counts it as switched on there: 2.2 um of error, 0.24 um had it"
    assert (level in text) is (share is not None)


@pytest.mark.parametrize(
    ("fitted", "share", "errors", "levels"), [(0.9, 0.4, 1, 1), (0.2, 0.9, 1, 1), (0.9, 0.02, 1, 0)]
)
def test_the_error_as_fitted_is_told_once_and_levels_that_make_little_of_it_are_not(
    fitted: float, share: float, errors: int, levels: int
) -> None:
    one = StartedOn(
        campaign="A",
        test="t5",
        on="Coolant at 1 and n at 3000 rpm",
        channels={"Coolant": "1", "n": "3000 rpm"},
        rmse_um=2.2,
        left_um=0.24,
        of_squares=share,
    )
    seen = found("none", [], rmse_um=0.1, noise_um=0.05, fitted_rmse_um=fitted, started_on=[one])
    text = verdict_sentence(seen)
    assert text.count("as it is fitted the model leaves") == errors
    assert text.count("counts them as switched on there: 2.2 um of error, 0.24 um had they run before") == levels


def test_what_is_called_the_likeliest_is_though_what_the_locked_tests_refused_stands_first() -> None:
    text = verdict_sentence(found("unknown", [one("axis", probability=0.55), one("part", probability=0.6)]))
    assert "the likeliest that was logged is part (T), probability 60 %" in text


@pytest.mark.parametrize(("p", "after", "seen"), [(0.005, 0.43, True), (0.02, 0.43, False), (0.005, 0.47, False)])
def test_none_above_a_candidate_that_is_seen_says_that_none_may_be_named(p: float, after: float, seen: bool) -> None:
    first = one("lag", p_value=p, rmse_um_before=0.54, rmse_um_after=after)
    text = verdict_sentence(found("none", [first], rmse_um=0.54))
    assert text.startswith(f"the open tests show no missing effect{' that may be named' if seen else ''}: ")


@pytest.mark.parametrize(
    ("either", "twins", "expected"),
    [
        (0.78, [], ", probability 18 % (78 % that it is one of these)"),
        (0.49, [], ", probability 18 %"),
        (None, [], ", probability 18 %"),
    ],
)
def test_of_what_may_be_another_part_too_the_head_says_how_sure_the_heat_of_both_is(
    either: float | None, twins: list[str], expected: str
) -> None:
    first = one("guideway", probability=0.18, unread=["axis.x.nut"], probability_with_unread=either, equivalent=twins)
    told = verdict_sentence(found("unknown", [first]))
    assert f"guideway (T) or heat at axis.x.nut, which T can't tell from it{expected}" in told
    assert ("one of these" in told) is (either == 0.78)
