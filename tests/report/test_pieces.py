"""Parts of one test are called by their hours, and a whole test by its name alone."""

from __future__ import annotations

from thermodata.report.words.pieces import names_of_pieces
from thermodata.schema.answers.candidate import CandidateCourse, LeftOut
from thermodata.schema.answers.missing_heat import HeatCourse


def left_out(test: str, from_h: float, to_h: float, campaign: str = "c") -> LeftOut:
    return LeftOut(
        campaign=campaign,
        test=test,
        from_s=3600 * from_h,
        to_s=3600 * to_h,
        acts=True,
        rmse_um_before=2.0,
        rmse_um_after=1.0,
    )


def test_parts_of_one_test_are_told_apart() -> None:
    parts = [left_out("head", 0, 2.5), left_out("head", 2.5, 5), left_out("day", 0, 8), left_out("head", 5, 5.25)]
    assert names_of_pieces(parts) == ["head, 0 to 2.5 h", "head, 2.5 to 5 h", "day", "head, 5 to 5.25 h"]


def test_tests_of_one_name_in_two_campaigns_are_no_parts() -> None:
    assert names_of_pieces([left_out("head", 0, 2), left_out("head", 0, 2, "d")]) == ["c/head", "d/head"]


def test_courses_are_named_so_too() -> None:
    runs = [
        CandidateCourse(campaign="c", test="head", t_s=[a, a + 3600], residual_um=[0, 0], contribution_um=[0, 0])
        for a in (0.0, 7200.0)
    ]
    assert names_of_pieces(runs) == ["head, 0 to 1 h", "head, 2 to 3 h"]
    heat = [
        HeatCourse(
            campaign="c",
            test="head",
            from_s=a,
            step_s=1800,
            source_um=[0] * 4,
            contribution_um=[0] * 4,
            residual_um=[0] * 4,
        )
        for a in (0.0, 7200.0)
    ]
    assert names_of_pieces(heat) == ["head, 0 to 2 h", "head, 2 to 4 h"]
