"""The whole question on machines whose truth is known."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import yaml

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.locked.confirm import rmse
from thermodata.diagnosis.sound import beside_slips, sound
from thermodata.diagnosis.tell.of_version.as_stored import by_its_own_parameters
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.run import Loaded
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.versions.as_kept import as_kept
from thermodata.modelling.versions.result import make_result
from thermodata.report.collected.spots import weak_spots_of
from thermodata.report.verdict.verdict import verdict_sentence
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.files.model import EffectSpec, Model, Response
from thermodata.view.grid.dataset import ChannelInfo, Dataset

from .conftest import CHANNELS, STEP_S, base, make_data


def diagnosis(data: Dataset, spec: Model) -> Diagnosis:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis


def of_nut(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
    return lag(2.0 * (channels["T_nut_X"] - channels["T_nut_X"][0]), 2400, STEP_S)


@pytest.fixture(scope="module")
def of_a_missing_screw() -> Diagnosis:
    return diagnosis(make_data(of_nut), base())


def test_the_error_before_on_locked_tests_is_told_of_the_model_as_it_is_fitted_too() -> None:
    """Fitted to two tests of six it is another model than the refit that a claim is judged beside."""
    data = make_data(of_nut)
    spec = base().model_copy(update={"calibrate_on": ["t0", "t1"], "verify_on": ["t2", "t3", "t4", "t5"]})
    fitted = fit_model(spec, data, uncertainty=False)
    best = answer(fitted, data, effects(), "m").diagnosis.candidates[0]
    locked = [t for t in data.tests if t.role == "locked"]
    assert best.claimed
    assert best.locked_rmse_um_fitted == pytest.approx(rmse(fitted.responses[0], locked))
    assert best.locked_rmse_um_fitted != pytest.approx(best.locked_rmse_um_before, rel=0.02)
    assert "before is the model once it is fitted to all open tests; as it is fitted it leaves" in best.why


def test_a_missing_screw_is_named_with_its_axis_and_holds_on_the_locked_test(of_a_missing_screw: Diagnosis) -> None:
    found, best = of_a_missing_screw, of_a_missing_screw.candidates[0]
    assert found.verdict == "effect"
    assert (best.effect, best.family, best.drivers, best.claimed) == ("feed_screw", "feed_x", ["T_nut_X"], True)
    assert best.rmse_um_after is not None
    assert best.rmse_um_before is not None
    assert best.rmse_um_after < 0.3 * best.rmse_um_before
    assert best.locked_rmse_um_after is not None
    assert best.locked_rmse_um_before is not None
    assert best.locked_rmse_um_after < 0.4 * best.locked_rmse_um_before
    (gain,) = (p for name, p in best.parameters.items() if name.endswith("feed_screw.gain"))
    assert 1.5 < gain.value < 2.5
    assert best.probability is not None
    assert best.probability > 0.8
    assert sum(c.claimed for c in found.candidates) == 1


def test_one_equation_has_one_error_whatever_it_is_called(of_a_missing_screw: Diagnosis) -> None:
    """A screw is a lag of its nut's temperature: the two differ by the grid of their time constants alone."""
    screw, lagged = (of_a_missing_screw.candidates[0], by_id(of_a_missing_screw, "lag:T_nut_X"))
    assert (lagged.rmse_um_before, lagged.rmse_um_after) == (screw.rmse_um_before, screw.rmse_um_after)
    assert [one.rmse_um_after for one in lagged.left_out] == [one.rmse_um_after for one in screw.left_out]
    assert lagged.why.startswith(f"it is one equation with {screw.id} and told as that: where it acts")


def test_figures_rules_and_reason_of_a_row_are_of_one_thing(of_a_missing_screw: Diagnosis) -> None:
    """Beside the screw a lag of its nut has nothing to do: that it hardly lets the error fall there is no figure of
    the equation that it is told as."""
    screw, lagged = (of_a_missing_screw.candidates[0], by_id(of_a_missing_screw, "lag:T_nut_X"))
    assert not lagged.claimed
    assert lagged.why.endswith("; not claimed: it is claimed by that name")
    assert (lagged.p_value, lagged.evidence, lagged.beside) == (screw.p_value, screw.evidence, screw.beside)
    assert lagged.rungs == screw.rungs
    figures = lagged.why.partition(" told as that: ")[2].partition("; not claimed")[0]
    assert f"the error falls ({screw.acting_um_before:.2f} -> {screw.acting_um_after:.2f} um)" in figures
    assert screw.why.startswith(figures)


def test_of_one_that_is_not_claimed_the_reason_is_that_of_its_equation_too(of_a_missing_screw: Diagnosis) -> None:
    named = {c.id: c for c in of_a_missing_screw.candidates}
    pairs = [
        (c, other)
        for c in named.values()
        for name, other in named.items()
        if c.why.startswith(f"it is one equation with {name} and told as that: ") and not other.claimed
    ]
    assert pairs
    for one, other in pairs:
        assert one.why == f"it is one equation with {other.id} and told as that: {other.why}"
        assert [r for r in one.rungs if r.name != "probability"] == [r for r in other.rungs if r.name != "probability"]


def test_what_is_not_claimed_stands_by_the_error_that_it_takes_where_it_acts(of_a_missing_screw: Diagnosis) -> None:
    """By the figures of `why` (docs/method.md, "Candidates"), not by errors of all tests."""
    others = [c for c in of_a_missing_screw.candidates if not c.claimed and not c.refinement]
    falls = [re.search(r"\(([\d.]+) -> ([\d.]+) um\)", c.why) for c in others]
    given = [max(0.0, float(f[1]) ** 2 - float(f[2]) ** 2) ** 0.5 for f in falls if f is not None]
    assert len(given) == len(others) > 5
    assert all(later <= sooner + 0.2 for sooner, later in pairwise(given)), "as far as two decimals say"
    assert given[0] > 2 * given[-1]


def test_the_error_with_a_claim_is_that_which_the_next_version_tells_of_itself(of_a_missing_screw: Diagnosis) -> None:
    more = [*base().effects, EffectSpec(effect="feed_screw", drivers={"temperature": "T_nut_X"})]
    following = diagnosis(make_data(of_nut), base().model_copy(update={"effects": more}))
    assert of_a_missing_screw.named_rmse_um == pytest.approx(following.rmse_um, rel=1e-6)
    assert of_a_missing_screw.candidates[0].rmse_um_after == pytest.approx(following.rmse_um, rel=1e-6)


def by_id(found: Diagnosis, name: str) -> Candidate:
    return next(c for c in found.candidates if c.id == name)


def test_a_locked_test_that_is_a_copy_of_an_open_one_is_left_out_and_said() -> None:
    """Of it nothing is looked at; a claim is then told as without locked tests."""
    data = make_data(of_nut)
    again = replace(data.tests[2], test="again", role="locked")
    answered = answer(
        fit_model(base(), copied := replace(data, tests=(*data.tests[:-1], again)), uncertainty=False),
        copied,
        effects(),
        "m",
    )
    assert answered.locked == ()
    assert answered.diagnosis.candidates[0].claimed
    assert answered.diagnosis.candidates[0].locked_rmse_um_after is None
    [said] = [a for a in answered.diagnosis.artefacts if a.kind == "copy"]
    assert (said.test, "'t2'" in said.why) == ("again", True)


def test_an_open_test_that_stands_there_twice_counts_once_and_is_told(of_a_missing_screw: Diagnosis) -> None:
    """Its copy would double the evidence, and be foretold by its own samples."""
    data = make_data(of_nut)
    again = replace(data.tests[2], test="again")
    twice = diagnosis(replace(data, tests=(*data.tests, again)), base())
    [said] = [a for a in twice.artefacts if a.kind == "copy"]
    assert (said.test, "'t2'" in said.why) == ("again", True)
    one, other = of_a_missing_screw.candidates[0], twice.candidates[0]
    # the model as it is fitted has the copy twice
    why = other.why.partition(" (before is the model once it is fitted")[0]
    assert (other.id, other.probability, why) == (one.id, one.probability, one.why)


def test_locked_figures_are_filled_for_the_claim_only(of_a_missing_screw: Diagnosis) -> None:
    others = of_a_missing_screw.candidates[1:]
    assert len(others) > 3
    assert all(c.locked_rmse_um_before is None and not c.parameters for c in others)


def test_what_the_model_has_is_no_candidate(of_a_missing_screw: Diagnosis) -> None:
    assert "spindle_bearing:T_bearing" not in [c.id for c in of_a_missing_screw.candidates]


def test_nothing_is_claimed_where_nothing_is_missing(spec: Model) -> None:
    found = diagnosis(make_data(), spec)
    assert found.verdict == "none"
    assert not any(c.claimed for c in found.candidates)


def test_two_missing_causes_are_claimed_at_once_or_one_after_the_other(spec: Model) -> None:
    def both(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        oil = lag(4.0 * (channels["T_tank"] - channels["T_tank"][0]), 1200, STEP_S)
        return of_nut(channels, t) + oil

    data, claimed = make_data(both), set[str]()
    for _ in range(2):
        found = diagnosis(data, spec)
        new = {c.drivers[0]: c for c in found.candidates if c.claimed}
        assert found.verdict == "effect"
        assert new
        assert found.rmse_um is not None
        assert found.named_rmse_um is not None
        assert found.named_rmse_um < found.rmse_um, "with all that is claimed"
        claimed |= set(new)
        if claimed == {"T_nut_X", "T_tank"}:
            break
        added = [EffectSpec(effect=c.effect, drivers=driven(c)) for c in new.values()]
        spec = spec.model_copy(update={"effects": [*spec.effects, *added]})
    assert claimed == {"T_nut_X", "T_tank"}


def driven(one: Candidate) -> dict[str, str]:
    return {need.role: channel for need, channel in zip(effects()[one.effect].needs, one.drivers, strict=False)}


def test_what_goes_with_the_error_by_another_gain_in_each_test_is_not_claimed(spec: Model) -> None:
    """A cause acts alike everywhere."""
    gains = iter([2.5, -1.5, 0.5, 3.0, -2.5, 1.0, 2.0])

    def proxy(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        return next(gains) * of_nut(channels, t) / 2.0

    found = diagnosis(make_data(proxy), spec)
    assert found.verdict == "unknown"
    assert not any(c.claimed for c in found.candidates)
    (screw,) = (c for c in found.candidates if c.effect == "feed_screw" and c.drivers == ["T_nut_X"])
    assert "not claimed" in screw.why


def test_what_is_kin_to_the_model_is_a_refinement_and_no_missing_cause(spec: Model) -> None:
    """A second bearing beside the one that the model has: smaller, with its own heat, and something else is left."""
    rng = np.random.default_rng(8)

    def rear(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        load = np.repeat(rng.uniform(0, 8, 12), len(t) // 12)
        unlogged = np.repeat(rng.uniform(0, 3.6, 9), len(t) // 9)
        channels["T_rear"] = 22 + lag(load, 900, STEP_S) + rng.normal(0, 0.02, len(t))
        return lag(-1.5 * (channels["T_rear"] - channels["T_rear"][0]), 3000, STEP_S) + lag(unlogged, 1800, STEP_S)

    info = {**CHANNELS, "T_rear": ChannelInfo("T_rear", "temperature", "degC", at="spindle.bearing.rear")}
    data = make_data(rear)
    tests = tuple(replace(t, channels=info) for t in data.tests)
    found = diagnosis(replace(data, tests=tests, channels=info), spec)
    assert found.verdict == "refine"
    assert not any(c.claimed for c in found.candidates)
    assert (found.candidates[0].refinement, found.candidates[0].drivers) == (True, ["T_rear"])


def test_a_cause_that_was_not_logged_stays_unknown(spec: Model) -> None:
    rng = np.random.default_rng(5)

    def unlogged(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        return lag(12.0 * np.repeat(rng.uniform(size=12) > 0.5, len(t) // 12), 3000, STEP_S)

    found = diagnosis(make_data(unlogged), spec)
    assert found.verdict == "unknown"
    assert found.unknown is not None
    assert found.unknown.time_constants_h
    assert not any(c.claimed for c in found.candidates)


def test_one_short_test_is_not_testable(spec: Model) -> None:
    data = make_data(of_nut, tests=2)
    short = [replace(t, in_window=t.t_s < 3600) for t in data.tests]
    found = diagnosis(replace(data, tests=tuple(short)), spec)
    assert found.verdict == "not_testable"
    assert found.next_test is not None


def test_a_slipped_probe_is_an_artefact_and_does_not_hide_the_effect(spec: Model) -> None:
    def slipped(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        still = np.flatnonzero(np.abs(np.diff(channels["spindle_speed"], prepend=0)) > 0)
        at = next(i for i in range(90, len(t) - 40) if np.abs(still - i).min() > 15)
        return of_nut(channels, t) + 6.0 * (np.arange(len(t)) >= at)

    data = make_data(of_nut)
    tests = list(data.tests)
    broken = make_data(slipped).tests[2]
    tests[2] = broken
    found = diagnosis(replace(data, tests=tuple(tests)), spec)
    steps = [a for a in found.artefacts if a.test == broken.test]
    assert len(steps) == 1
    assert steps[0].size_um is not None
    assert abs(steps[0].size_um - 6.0) < 1.0
    assert found.candidates[0].effect == "feed_screw"
    # the line that it says to write takes the step out of a fit, though the screw is missing there
    line = steps[0].why.partition("write '- ")[2].partition("' under")[0]
    slip = EffectSpec.model_validate(yaml.safe_load(line))
    with_slip = spec.model_copy(update={"effects": [*spec.effects, slip]})
    again = diagnosis(replace(data, tests=tuple(tests)), with_slip)
    assert [a for a in again.artefacts if a.kind == "step"] == []
    (gain,) = (p for name, p in again.candidates[0].parameters.items() if name.endswith("feed_screw.gain"))
    assert gain.value == pytest.approx(2.0, abs=0.1)
    # no other test says how large a slip of this one was: its level is free after it, as where the step was found
    assert again.named_rmse_um == pytest.approx(found.named_rmse_um, rel=0.1)


def knocked(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
    return -40.0 * (t >= 90 * STEP_S)


def with_a_knock(add: Callable[[dict[str, Any], np.ndarray], np.ndarray] | None = None) -> Dataset:
    """A probe that is knocked in one test, by more than the effects do."""
    data = make_data(add)
    tests = list(data.tests)
    tests[2] = make_data(lambda channels, t: knocked(channels, t) + (0.0 if add is None else add(channels, t))).tests[2]
    return replace(data, tests=tuple(tests))


def test_what_is_asked_of_has_its_effects_as_they_are_beside_a_slip(spec: Model) -> None:
    """A knock bends them all in the fit of the model, as `add` makes it."""
    data, broken = make_data(), with_a_knock()
    plain, whole = (fit_model(spec, some, uncertainty=False) for some in (broken, data))
    found = sound(plain, 0, broken, broken.tests[:-1], effects())
    asked = beside_slips(found, 0)

    def gain(of: FittedModel) -> float:
        return of.term("spindle_bearing").gains["gain"]

    assert abs(gain(found.fitted) / gain(whole) - 1) > 0.1, "the slip bends the fit"
    assert gain(asked.fitted) == pytest.approx(gain(whole), rel=0.03)
    level = asked.fitted.responses[0].residual(broken.tests[2])
    assert np.nanmedian(level[-20:]) - np.nanmedian(level[:20]) == pytest.approx(-40.0, abs=2.0), "the slip is left"
    assert beside_slips(sound(whole, 0, data, data.tests[:-1], effects()), 0).level is None


def test_a_knock_is_in_no_error_that_is_told_and_makes_no_parameter_wrong(spec: Model) -> None:
    """The error with what is named is that which the next version's own answer tells of it, beside the knock, too."""

    def drifting(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        return of_nut(channels, t) + lag(2.0 * (channels["T_hall"] - channels["T_hall"][0]), 9000, STEP_S)

    data = with_a_knock(drifting)
    air = EffectSpec(effect="ambient_frame", drivers={"temperature": "T_hall"})
    spec = spec.model_copy(update={"effects": [*spec.effects, air]})
    found = diagnosis(data, spec)
    assert [c.effect for c in found.candidates if c.claimed] == ["feed_screw"]
    more = [*spec.effects, EffectSpec(effect="feed_screw", drivers={"temperature": "T_nut_X"})]
    following = diagnosis(data, spec.model_copy(update={"effects": more}))
    assert found.named_rmse_um == pytest.approx(following.rmse_um, rel=0.05)
    assert found.named_rmse_um is not None
    assert found.named_rmse_um < 0.5
    assert {a.kind for a in [*found.artefacts, *following.artefacts]} == {"step"}


def test_a_knock_of_one_of_several_places_is_answered(spec: Model) -> None:
    """Whose time constants are shared: no effect of one response alone can stand in such a model."""
    broken, other = with_a_knock(), ChannelInfo("dZ2", "displacement", "um", at="table", axis="Z")
    channels = {**CHANNELS, "dZ2": other}
    rng = np.random.default_rng(5)
    whole = make_data()
    tests = []
    for test, sane in zip(broken.tests, whole.tests, strict=True):
        values = {**test.values, "dZ2": 0.6 * sane.values["dZ"] + rng.normal(0, 0.1, len(test.t_s))}
        valid = {name: np.ones(len(test.t_s), dtype=np.bool_) for name in values}
        tests.append(replace(test, values=values, valid=valid, channels=channels))
    data = Dataset(STEP_S, tuple(tests), channels)
    places = [Response(axis="Z", at="tcp"), Response(axis="Z", at="table")]
    shared = [one.model_copy(update={"gain_by": "place"}) for one in spec.effects]
    model = fit_model(spec.model_copy(update={"response": places, "effects": shared}), data, uncertainty=False)
    found = answer(model, data, effects(), "m", name="dZ").diagnosis
    assert (found.verdict, [a.kind for a in found.artefacts]) == ("none", ["step"])


def test_where_a_model_fails_is_by_its_own_parameters_as_in_every_other_command(spec: Model) -> None:
    """The question is asked of a fit to all tests, also to one that came since: two tables said where it fails."""
    data = make_data(of_nut)
    fitted = fit_model(spec, replace(data, tests=data.tests[:3]), uncertainty=False)
    kept = as_kept(fitted.spec, make_result(fitted, data, "m"), data, changed=False)
    found = diagnosis(data, spec)
    stored = Loaded("m", None, kept, data, kept=True)
    told = by_its_own_parameters(found, stored)
    assert told.weak_spots == weak_spots_of(stored, [found])[found.response]
    assert told.weak_spots != found.weak_spots
    # nor is its error that of the refit
    own = np.concatenate([r.residual(t)[r.mask(t)] for t in kept.tests(data) for r in kept.responses])
    assert told.fitted_rmse_um == pytest.approx(float(np.sqrt(np.mean(own**2))))
    assert found.fitted_rmse_um is not None
    assert told.fitted_rmse_um > 1.01 * found.fitted_rmse_um


@pytest.mark.parametrize("count", [1, 2])
def test_an_answer_counts_the_open_tests_that_took_part_and_says_what_few_ones_lack(count: int) -> None:
    found = diagnosis(make_data(tests=count + 1), base())
    assert (found.open_tests, found.open_tests_asked, found.locked_tests) == (count, count, 1)
    assert f"{count} open test{'s' if count > 1 else ''} took part, so errors are of parts of" in verdict_sentence(
        found
    )
