"""What holds on the locked tests: the shape of a choice, and the error as it is scored (locked/held.py)."""

from __future__ import annotations

import pytest

from thermodata.diagnosis.locked import held as rules
from thermodata.diagnosis.locked.held import as_held, despite, held
from thermodata.schema.answers import confirmed as results


def confirmed(*tests: tuple[float, float, bool, int | None], **more: object) -> results.Confirmed:
    """tests: error before and after, whether it acts, samples."""
    return results.Confirmed(
        **{
            "model": "m",
            "response": "dX",
            "candidate": "lag:t4",
            "holds": None,
            "locked_rmse_um_before": 3.02,
            "locked_rmse_um_after": 4.24,
            "locked_shape_um_before": 2.0,
            "locked_shape_um_after": 1.0,
            "parameters": {},
            "tests": [
                results.TestConfirmed(campaign="c", test=f"t{i}", rmse_um_before=b, rmse_um_after=a, acts=acts, n=n)
                for i, (b, a, acts, n) in enumerate(tests)
            ],
            "looks": 1,
            **more,
        }
    )


@pytest.mark.parametrize(
    ("tests", "by_shape", "holds", "why"),
    [
        ([(3.02, 4.24, True, 100)], True, False, rules.IN_SHAPE_ONLY),
        ([(3.02, 3.09, True, 100)], True, False, rules.IN_SHAPE_ONLY),
        ([(3.02, 3.07, True, 100)], True, True, rules.HOLDS + rules.AS_SCORED),
        ([(3.02, 3.01, True, 100)], True, True, rules.HOLDS),
        ([(3.02, 1.0, True, 100)], True, True, rules.HOLDS),
        ([(3.02, 1.0, True, 100)], False, False, rules.FALLS_SHORT),
        ([(3.02, 4.24, True, 100)], None, None, rules.RESTS),
        # it rises where it rests only: other effects move when one is added
        ([(3.0, 2.0, True, 100), (3.0, 5.0, False, 100)], True, True, rules.HOLDS + rules.RISES_ELSEWHERE),
        # tests weigh by their samples
        ([(3.0, 2.0, True, 1000), (3.0, 4.0, True, 10)], True, True, rules.HOLDS),
        ([(3.0, 2.0, True, 10), (3.0, 4.0, True, 1000)], True, False, rules.IN_SHAPE_ONLY),
    ],
)
def test_it_holds_by_its_shape_and_as_scored(
    tests: list[tuple[float, float, bool, int | None]], by_shape: bool | None, holds: bool | None, why: str
) -> None:
    found = held(confirmed(*tests), by_shape)
    assert (found.holds, found.holds_by_shape, found.why) == (holds, by_shape, why)
    assert as_held(found) == found


def test_an_error_that_rises_about_the_mean_is_said() -> None:
    found = held(confirmed((3.0, 4.0, True, 9), locked_shape_um_after=2.5), by_shape=False)
    assert (found.holds, found.why) == (False, rules.RISES)


def test_a_kept_answer_that_went_by_the_shape_alone_is_told_as_one_of_today() -> None:
    found = as_held(confirmed((3.02, 4.24, True, None), holds=True))
    assert (found.holds, found.holds_by_shape, found.why) == (False, True, rules.IN_SHAPE_ONLY)


@pytest.mark.parametrize(
    ("holds", "by_shape", "probability", "said"),
    [
        (False, False, 0.84, rules.OUTWEIGHED),
        (False, True, 0.84, rules.BY_SHAPE),
        (False, False, None, None),
        (True, True, 0.84, None),
        (None, None, 0.84, None),
    ],
)
def test_why_a_diagnosis_claims_what_does_not_hold_is_told_by_itself(
    holds: bool | None, by_shape: bool | None, probability: float | None, said: str | None
) -> None:
    """`holds: false` stood in the JSON beside a claim at 84 %, and the reason in the text alone."""
    result = confirmed(holds=holds, holds_by_shape=by_shape, probability=probability, despite="as it was once")
    assert despite(result).despite == said
