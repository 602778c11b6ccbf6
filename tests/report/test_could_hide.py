"""What a verdict without a claim can't exclude, in words."""

from __future__ import annotations

from typing import Any

import pytest

from thermodata.report.verdict.could_hide import could_be, could_hide, was_not_asked
from thermodata.report.verdict.left_over import left_over
from thermodata.schema.answers.diagnosis import AtRest, DetectionLimit, Diagnosis
from thermodata.schema.answers.missing_heat import HeatCompanion, Unknown

from ..answers import diagnosis
from .conftest import missing_heat


def one(effect: str, least: float | None, seen: float = 0.9, family: str = "", behind: str | None = None) -> Any:
    """Large from 3 um on."""
    return DetectionLimit(
        id=f"{effect}:T",
        effect=effect,
        family=family or effect,
        drivers=["T"],
        least_um=least,
        seen=seen,
        behind=behind,
        large=least is None or least > 3,
    )


def found(*limits: DetectionLimit, response: float | None = 9.0) -> Diagnosis:
    return diagnosis(
        verdict="none", noise_um=0.1, rmse_um=0.3, explainable=None, response_um=response, limits=list(limits)
    )


def test_what_would_have_to_be_large_is_named_with_what_it_hides_behind() -> None:
    text = could_hide(
        found(
            one("guideway", 13.6, seen=0.09, behind="feed_screw"),
            one("floor", 4.0),
            one("coolant", 2.9),
            response=15.0,
        )
    )
    assert text == (
        "these tests can't exclude guideway (T) up to 13.6 um, for feed_screw does 91 % of it; floor (T) up to 4.00 "
        "um, for slow noise covers what is less (RMS where it acts; the response has 15.0 um)"
    )


def test_of_what_nothing_bounds_the_one_that_the_tests_speak_for_comes_first() -> None:
    """However much larger another one could be; of what is bounded the one that could do most."""
    limits = [one("oil", 30.0), one("coolant", 20.0), one("cut", 9.5), one("floor", 8.0), one("sun", 5.0)]
    spoken = [None, 10.0, 290.0, 5.0, 300.0]
    asked = found(*(limit.model_copy(update={"evidence": e}) for limit, e in zip(limits, spoken, strict=True)))
    names = [part.split(" (")[0].removeprefix("these tests can't exclude ") for part in could_hide(asked).split("; ")]
    assert names[:4] == ["cut", "coolant", "oil", "floor"]
    assert could_be(asked) == "cut (T), coolant (T) or oil (T)"


def test_more_than_all_that_was_measured_is_no_bound() -> None:
    assert "floor (T) of any size, for slow noise covers it (" in could_hide(found(one("floor", 9.1)))
    nearly = could_hide(found(one("floor", 8.9)))
    assert "floor (T) up to 8.90 um, nearly all of the response, for slow noise covers what is less (" in nearly
    assert "nearly" not in could_hide(found(one("floor", 8.0)))


@pytest.mark.parametrize(
    ("least", "seen", "said"),
    [
        (None, 0.48, "of any size, for base does 52 % of it and slow noise covers the rest"),
        (None, 0.03, "of any size, for base does 97 % of it ("),
        (7.0, 0.48, "up to 7.00 um, for base does 52 % of it ("),
    ],
)
def test_what_does_half_of_an_effect_alone_does_not_hide_it(least: float | None, seen: float, said: str) -> None:
    assert said in could_hide(found(one("floor", least, seen=seen, behind="base")))


def test_where_all_would_have_been_seen_that_is_said() -> None:
    text = could_hide(found(one("coolant", 2.9), one("floor", 0.5)))
    assert text.startswith("an effect of the library that acts by more than 2.90 um (RMS where it acts; the response")
    assert text.endswith("would have been named here; coolant (T) could hide most")


def test_of_one_effect_the_sensor_counts_that_shows_it_best() -> None:
    twice = found(one("floor", 8.0), one("floor", 1.0), one("feed_screw", 7.0, family="feed_x"))
    assert could_hide(twice).count("floor") == 0
    assert "feed_screw (T) up to 7.00 um" in could_hide(twice)


def test_what_no_size_would_show_and_how_many_more() -> None:
    text = could_hide(found(*[one(f"e{i}", None, seen=0.0, behind="base") for i in range(6)]))
    assert text.count("of any size, for base does 100 % of it") == 4
    assert "; 2 more (" in text


@pytest.mark.parametrize(("limits", "response"), [((), 9.0), ((one("floor", 5.0),), None)])
def test_nothing_is_said_where_nothing_is_known(limits: tuple[DetectionLimit, ...], response: float | None) -> None:
    assert could_hide(found(*limits, response=response)) == ""


def test_what_no_open_test_moves_is_told_with_what_would_be_warmed() -> None:
    rests = AtRest(channel="feed_Y", warms=["T_motor_Y"], effects=["feed_motor", "feed_screw"], moves_in=["day2"])
    asked = found(one("floor", 4.0)).model_copy(update={"at_rest": [rests]})
    assert could_hide(asked).endswith(
        "; never moved in the open tests: feed_Y (feed_motor, feed_screw, nor was T_motor_Y heated by it; it moves in "
        "day2); let an open test move it"
    )
    assert "never moved" not in could_hide(found(one("floor", 4.0)))


def test_a_headline_names_what_no_size_would_have_shown() -> None:
    assert could_be(found(one("floor", 4.0), one("sun", 2.0))) == ""
    assert could_be(found(one("floor", None), one("sun", 9.5), one("bed", 4.0))) == "floor (T) or sun (T)"
    rests = AtRest(channel="n_C", effects=["table_bearing"], moves_in=["day2"])
    asked = found(*(one(name, None) for name in "abcd")).model_copy(update={"at_rest": [rests]})
    assert could_be(asked) == "what n_C moves (no open test does), a (T), b (T) or 2 more"


@pytest.mark.parametrize(("without", "told"), [("T", ""), ("T_other", "floor (T)")])
def test_a_headline_names_nothing_that_the_missing_heat_does_not_go_with(without: str, told: str) -> None:
    heat = missing_heat().model_copy(
        update={"goes_not_with": [HeatCompanion(channel=without, at=None, on_with=None, on_without=None, follows=0.0)]}
    )
    unknown = Unknown(time_constants_h=[], hours_of_day=[], states=[], heat=heat)
    assert could_be(found(one("floor", None)).model_copy(update={"unknown": unknown})) == told


@pytest.mark.parametrize(
    ("fitted", "limits", "told"),
    [
        (1.75, (one("bearing", None, 0.02, behind="gearbox"),), True),
        (1.75, (one("bearing", 9.5, 0.02, behind="gearbox"),), True),  # more than all that was measured
        (1.75, (one("bearing", 8.5, 0.02, behind="gearbox"),), False),
        (1.75, (one("bearing", None),), False),  # behind no effect, but slow noise
        (0.35, (one("bearing", None, 0.02, behind="gearbox"),), False),  # its effects act as they are fitted
    ],
)
def test_what_stands_behind_an_effect_that_acts_otherwise_than_fitted_may_be_missing(
    fitted: float, limits: tuple[DetectionLimit, ...], told: bool
) -> None:
    text = left_over(found(*limits).model_copy(update={"fitted_rmse_um": fitted}))
    asks = "bearing (T), which gearbox hides in these tests, may do that instead (thermodata confirm m bearing:T asks"
    assert (asks in text) is told


def test_what_the_user_may_ask_for_is_said_with_the_command_that_asks() -> None:
    asked = diagnosis(
        verdict="unknown", unknown=Unknown(time_constants_h=[], hours_of_day=[], states=[], by_name=["a:T,z"])
    )
    assert could_hide(asked) == (
        "not asked for by itself, though all that drives it is logged: a (T, z); "
        f"thermodata confirm {asked.model[:8]} a:T,z asks locked tests of it"
    )
    several = Unknown(time_constants_h=[], hours_of_day=[], states=[], by_name=["a:T,z", "b:u"])
    text = could_hide(asked.model_copy(update={"unknown": several}))
    assert "themselves, though all that drives them is logged: a (T, z) and b (u); " in text
    assert text.endswith(" a:T,z asks locked tests of the first")
    assert was_not_asked(asked) == "a (T, z) was not asked for, though all that drives it is logged"
    assert was_not_asked(asked.model_copy(update={"unknown": several})) == (
        "a (T, z) and 1 more were not asked for, though all that drives them is logged"
    )
    assert not was_not_asked(diagnosis(verdict="none"))
