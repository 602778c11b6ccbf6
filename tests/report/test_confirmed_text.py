"""What a person reads of a choice that was put to the locked tests."""

from __future__ import annotations

import pytest

from thermodata.diagnosis.locked.held import despite
from thermodata.report.text.confirmed import confirmed_text
from thermodata.schema.answers import confirmed as results


@pytest.mark.parametrize(
    ("holds", "by_shape", "scored", "shape", "said"),
    [
        (True, True, (14.2, 10.9), (11.0, 8.0), "lag:t4 holds on the locked tests: 14.2 -> 10.9 um"),
        (
            False,
            True,
            (14.2, 17.2),
            (11.0, 8.0),
            "lag:t4 holds in shape only on the locked tests: 11.0 -> 8.00 um about each test's mean, but from their "
            "first samples on the error rises, 14.2 -> 17.2 um: the course fits and where it starts does not (a test "
            "that began warm, or noise where its zero is taken)",
        ),
        (
            True,
            True,
            (14.2, 14.3),
            (11.0, 8.0),
            "lag:t4 holds on the locked tests by its shape, 11.0 -> 8.00 um about each test's mean; from their first "
            "samples on it hardly changes, 14.2 -> 14.3 um",
        ),
        (
            False,
            False,
            (14.2, 17.2),
            (11.0, 12.0),
            "lag:t4 does not hold on the locked tests, for its course does not fit: about each test's mean the error "
            "rises, 11.0 -> 12.0 um (as tests are scored, from their first samples on, 14.2 -> 17.2 um)",
        ),
        (
            False,
            False,
            (14.2, 13.9),
            (11.0, 10.9),
            "lag:t4 does not hold on the locked tests, for what it adds is not found there: about each test's mean "
            "the error goes 11.0 -> 10.9 um only, where a cause of its size takes away twice as much and more, in "
            "squares; that it goes 14.2 -> 13.9 um as tests are scored, from their first samples on, counts where they "
            "start, too",
        ),
        (True, True, (None, None), (None, None), "lag:t4 holds on the locked tests"),
        (
            None,
            None,
            (14.2, 13.9),
            (None, None),
            "lag:t4 hardly acts in the locked tests (under a fifth of its largest), so these say little of it "
            "(14.2 -> 13.9 um): one that moves it more would, locked, from a cold start",
        ),
    ],
)
def test_words_and_figures_agree(
    holds: bool | None,
    by_shape: bool | None,
    scored: tuple[float | None, float | None],
    shape: tuple[float | None, float | None],
    said: str,
) -> None:
    result = results.Confirmed(
        model="m",
        response="dX",
        candidate="lag:t4",
        holds=holds,
        holds_by_shape=by_shape,
        locked_rmse_um_before=scored[0],
        locked_rmse_um_after=scored[1],
        locked_shape_um_before=shape[0],
        locked_shape_um_after=shape[1],
        parameters={},
        tests=[results.TestConfirmed(campaign="c", test="last", rmse_um_before=14.2, rmse_um_after=14.3)],
        looks=2,
    )
    text = confirmed_text(result)
    assert text.splitlines()[0] == said
    onward = "\nto have it: thermodata add m lag:t4" if holds else ""
    assert text.endswith(f"opened 2 times so far{onward}")


@pytest.mark.parametrize(
    ("holds", "probability", "said"),
    [(False, 0.88, True), (False, None, False), (True, 0.88, False), (None, 0.88, False)],
)
def test_a_claim_that_does_not_hold_alone_is_not_left_as_a_contradiction(
    holds: bool | None, probability: float | None, said: bool
) -> None:
    result = results.Confirmed(
        model="m",
        response="dX",
        candidate="lag:t4",
        holds=holds,
        locked_rmse_um_before=2.0,
        locked_rmse_um_after=1.9,
        parameters={},
        tests=[],
        looks=1,
        probability=probability,
    )
    assert ("The diagnosis claims it all the same, with 88 %" in confirmed_text(despite(result))) is said


def test_the_tests_that_were_asked_are_named_where_not_all_were() -> None:
    tests = [
        results.TestConfirmed(campaign="c", test=name, rmse_um_before=2.0, rmse_um_after=1.0, acts=name != "idle")
        for name in ("idle", "day1", "day2")
    ]
    result = results.Confirmed(
        model="m",
        response="dX",
        candidate="lag:t4",
        holds=True,
        locked_rmse_um_before=2.0,
        locked_rmse_um_after=1.0,
        locked_shape_um_before=1.5,
        locked_shape_um_after=0.5,
        parameters={},
        tests=tests,
        looks=1,
    )
    first = confirmed_text(result).splitlines()[0]
    assert first == (
        "lag:t4 holds on the locked tests in which it acts most (day1, day2): 1.50 -> 0.500 um about each test's mean; "
        "from their first samples on, over all, 2.00 -> 1.00 um"
    )


def test_a_test_that_rises_is_named_beside_what_holds_and_a_response_is_no_cause() -> None:
    def of(campaign: str, before: float, after: float) -> results.TestConfirmed:
        return results.TestConfirmed(campaign=campaign, test="mix2", rmse_um_before=before, rmse_um_after=after)

    known = results.Confirmed(
        model="m", response="dZ", candidate="lag:ch4", holds=True, holds_by_shape=True, locked_rmse_um_before=14.1,
        locked_rmse_um_after=11.7, parameters={}, tests=[of("sim", 20.0, 9.0), of("tool2", 7.69, 11.6)], looks=1,
        note="ch4 is itself a displacement",
    )  # fmt: skip
    text = confirmed_text(known)
    assert "; yet from its first samples on the error rises in tool2/mix2, 7.69 -> 11.6 um\n" in text
    assert "\nch4 is itself a displacement\n" in text
    calm = known.model_copy(update={"tests": [of("sim", 20.0, 9.0)], "note": None})
    assert "yet" not in confirmed_text(calm)


@pytest.mark.parametrize(
    ("fitted", "after", "holds", "figures", "other"),
    [
        (None, 10.9, True, "14.2 -> 10.9 um", ""),
        (14.3, 10.9, True, "14.2 -> 10.9 um", ""),  # nothing else is printed for what says the same
        (19.0, 10.9, True, "19.0 (14.2 once that model is fitted to all open tests) -> 10.9 um", ""),
        (19.0, 15.2, False, "19.0 (14.2 once that model is fitted to all open tests) -> 15.2 um", "leaves more there"),
        (9.0, 10.9, True, "9.00 (14.2 once that model is fitted to all open tests) -> 10.9 um", "leaves less there"),
    ],
)
def test_a_choice_is_told_from_the_model_that_the_user_has(
    fitted: float | None, after: float, holds: bool, figures: str, other: str
) -> None:
    each = {"rmse_um_fitted": fitted, "rmse_um_before": 14.2, "rmse_um_after": after}
    locked = {f"locked_{key}": value for key, value in each.items()}
    test = results.TestConfirmed(campaign="c", test="last", **each)
    said = {"model": "m", "response": "dX", "candidate": "lag:t4", "holds": holds, "parameters": {}, "looks": 1}
    text = confirmed_text(results.Confirmed.model_validate({**said, **locked, "tests": [test]}))
    assert figures in text.splitlines()[0]
    assert ("the model as it is fitted leaves" in text) is bool(other)
    assert other in text
    assert ("as fitted [um]" in text) is ("refitted [um]" in text) is (fitted is not None)


def small(does: float, after: float, most: float | None) -> str:
    """Of an effect that does too little in the locked tests for a verdict."""
    test = results.TestConfirmed(
        campaign="c", test="last", rmse_um_before=1.98, rmse_um_after=after, acts=False, does_um=does
    )
    errors = {"locked_rmse_um_before": 1.98, "locked_rmse_um_after": after}
    said = {"model": "m", "response": "dX", "candidate": "lag:t4", "holds": None, "parameters": {}, "looks": 1}
    return confirmed_text(results.Confirmed.model_validate({**said, **errors, "tests": [test], "most_um": most}))


def test_what_is_small_beside_its_largest_where_the_error_falls_is_not_called_little() -> None:
    said = small(1.8, 0.818, 12.0)
    assert said.startswith("lag:t4 does 1.80 um about the mean of the locked test in which it does most, under a fifth")
    assert "(12.0 um)" in said
    assert "Their error falls all the same, 1.98 -> 0.818 um" in said
    assert "hardly acts" not in said


@pytest.mark.parametrize(("does", "after", "most"), [(0.2, 1.45, 12.0), (1.8, 2.4, 12.0), (1.8, 0.818, None)])
def test_what_is_small_where_the_error_hardly_falls_hardly_acts(does: float, after: float, most: float | None) -> None:
    assert small(does, after, most).startswith("lag:t4 hardly acts in the locked tests")


@pytest.mark.parametrize(("name", "said"), [("lag.tau", True), ("lag.gain", False)])
def test_that_add_may_give_a_second_lag_is_said_of_what_does_not_hold(name: str, said: bool) -> None:
    value = {"value": 40.0, "unit": "min", "low": None, "high": None}
    fell = {"locked_rmse_um_before": 2.26, "locked_rmse_um_after": 2.43, "parameters": {name: value}}
    of = {"model": "m", "response": "dX", "candidate": "lag:t4", "holds": False, "tests": [], "looks": 1}
    assert ("asked with one lag" in confirmed_text(results.Confirmed.model_validate({**of, **fell}))) is said
