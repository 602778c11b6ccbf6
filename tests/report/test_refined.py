"""What is offered as a refinement is told with the errors that it is offered for."""

from __future__ import annotations

import pytest

from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.verdict.candidate_errors import left_out_errors
from thermodata.report.verdict.refined import can_be_refined, to_add, told_with_errors
from thermodata.schema.answers.candidate import LeftOut, Rung

from ..answers import candidate, diagnosis

OVER_ALL = "do not tell, for there the effects of the model are foretold by the others, too"


@pytest.mark.parametrize(
    ("left", "acting", "locked", "said"),
    [
        (
            *((1.76, 1.75), (1.33, 1.02), None),
            f": where it acts the error falls (1.33 -> 1.02 um), its size foretold by the other tests; all "
            f"left-out tests (1.76 -> 1.75 um) {OVER_ALL}",
        ),
        (
            *((1.41, 2.46), (1.34, 1.02), (1.52, 1.17)),
            f": where it acts the error falls (1.34 -> 1.02 um), its size foretold by the other tests, and so it does "
            f"on locked tests (1.52 -> 1.17 um about each one's mean); all left-out tests (1.41 -> 2.46 um) {OVER_ALL}",
        ),
        ((1.00, 0.951), (1.34, 1.02), None, f"; all left-out tests (1.00 -> 0.951 um) {OVER_ALL}"),
        ((1.00, 0.949), (1.34, 1.02), None, ", error on left-out tests 1.00 -> 0.949 um"),
        ((1.76, 1.75), (1.00, 0.96), None, ", error on left-out tests 1.76 -> 1.75 um"),
        ((1.76, 1.75), (None, None), None, ", error on left-out tests 1.76 -> 1.75 um"),
    ],
)
def test_a_refinement_is_told_by_the_error_where_it_acts_where_that_over_all_tests_does_not_tell(
    left: tuple[float, float],
    acting: tuple[float | None, float | None],
    locked: tuple[float, float] | None,
    said: str,
) -> None:
    """1.76 -> 1.75 um argued against what let the locked tests fall from 2.69 to 1.95 um."""
    given = {"acting_um_before": acting[0], "acting_um_after": acting[1]}
    if locked is not None:
        given |= {"locked_shape_um_before": locked[0], "locked_shape_um_after": locked[1]}
    mode = candidate("mode:T", refinement=True, rmse_um_before=left[0], rmse_um_after=left[1], **given)
    text = told_with_errors(diagnosis(mode, verdict="refine", rmse_um=left[0], named_rmse_um=left[1]), ": add {them}")
    assert text.startswith("what the model has can be refined by mode (T)")
    assert text.endswith(f"{said}: add it")


def test_of_several_each_is_told_by_where_it_acts() -> None:
    both = [
        candidate(name, refinement=True, acting_um_before=2.0, acting_um_after=after)
        for name, after in (("mode:T", 1.0), ("lead:T", 0.5))
    ]
    text = told_with_errors(diagnosis(*both, verdict="refine", rmse_um=1.76, named_rmse_um=1.75))
    assert "where they act the error falls (mode 2.00 -> 1.00 um, lead 2.00 -> 0.500 um), their size" in text


@pytest.mark.parametrize(
    ("left", "fall", "said"),
    [
        (
            (0.939, 0.938),
            -0.08,
            "mode (T) goes with what is left, but left-out tests are foretold hardly better (0.939 -> 0.938 um, where "
            "it acts 0.730 -> 0.760 um) with it, so adding it is not advised",
        ),
        (
            (1.00, 1.02),
            -0.08,
            "mode (T) goes with what is left, but left-out tests are foretold no better (1.00 -> 1.02 um) with it, "
            "so adding it is not advised",
        ),
        (
            (1.00, 0.949),
            -0.08,
            "what the model has can be refined by mode (T), error on left-out tests 1.00 -> 0.949 um",
        ),
        ((1.00, 1.02), 0.01, "what the model has can be refined by mode (T), error on left-out tests (falls where it "),
        (
            (1.00, 0.999),
            None,
            "what the model has can be refined by mode (T), error on left-out tests 1.00 -> 0.999 um",
        ),
    ],
)
def test_what_lets_no_error_fall_is_offered_to_nobody(left: tuple[float, float], fall: float | None, said: str) -> None:
    rung = Rung(name="fall", asks="", value=fall, limit=0.3, unit="1", at="least", holds=False)
    errors = {"rmse_um_before": left[0], "rmse_um_after": left[1], "acting_um_before": 0.73, "acting_um_after": 0.76}
    mode = candidate("mode:T", refinement=True, rungs=[] if fall is None else [rung], **errors)
    found = diagnosis(mode, verdict="refine", rmse_um=left[0], named_rmse_um=left[1])
    assert told_with_errors(found).startswith(said)
    assert bool(to_add(found)) is bool(can_be_refined(found)) is said.startswith("what the model has")


@pytest.mark.parametrize(
    ("tests", "said"),
    [
        ("abc", "error on left-out tests 1.76 -> 1.75 um"),
        ("aabb", "error on left-out parts of 2 tests 1.76 -> 1.75 um"),
        ("aaa", "error on left-out parts of 1 test 1.76 -> 1.75 um"),
        ("", "error on left-out tests 1.76 -> 1.75 um"),
    ],
)
def test_parts_of_tests_are_no_tests(tests: str, said: str) -> None:
    parts = [
        LeftOut(campaign="c", test=t, from_s=0.0, to_s=1.0, acts=True, rmse_um_before=1.76, rmse_um_after=1.75)
        for t in tests
    ]
    one = candidate("mode:T", claimed=True, left_out=parts)
    assert left_out_errors([one], 1.76, 1.75) == said
    text = diagnosis_text(diagnosis(one, rmse_um=1.76, named_rmse_um=1.75))
    assert said in text
    assert ("left-out tests" in text.partition("\nleft-out: ")[0]) is ("parts" not in said)
