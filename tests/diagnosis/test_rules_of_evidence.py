"""Every rule of a claim (diagnosis/evidence.py), just inside and just outside its limit."""

from __future__ import annotations

import math

import pytest

from thermodata.diagnosis.evidence import (
    Measure,
    enough_together,
    explained,
    fit_of,
    is_promising,
    is_proxy,
    passes,
    remaining,
)

from .hand_made import ROWS, measure, scored

CHANCE = "chance does as well"
FALL = "the squared error on left-out tests falls"
LITTLE = "there is too little to explain"
FEW = "the error falls in"
SMALL = "it explains"
INERTIA = "inertia removed it predicts nothing"


def fails(sentence: str, found: list[str]) -> bool:
    """Whether the sentence is the one reason; False where there is none. Another reason is a wrong case."""
    assert all(sentence in reason for reason in found), found
    return bool(found)


def test_the_plain_case_passes_every_rule() -> None:
    assert passes(scored(), measure()) == []


@pytest.mark.parametrize(("p_value", "refused"), [(0.02, False), (0.0201, True)])
def test_p_limit(p_value: float, refused: bool) -> None:
    assert fails(CHANCE, passes(scored(p_value=p_value), measure())) is refused


@pytest.mark.parametrize(("drop", "refused"), [(0.30, False), (0.299, True)])
def test_drop_limit(drop: float, refused: bool) -> None:
    assert fails(FALL, passes(scored(drop=drop), measure())) is refused


@pytest.mark.parametrize(("drop", "refused"), [(0.50, False), (0.499, True)])
def test_family_drop_limit(drop: float, refused: bool) -> None:
    found = passes(scored(family="feed_x", drop=drop), measure(families=["feed_x"]))
    assert fails(FALL, found) is refused
    assert all("has its family already" in reason for reason in found)
    assert passes(scored(family="feed_x", drop=drop), measure(families=["feed_y"])) == []


@pytest.mark.parametrize(("white_drop", "refused"), [(0.30, False), (0.299, True)])
def test_sharp_white_drop(white_drop: float, refused: bool) -> None:
    """Sharp timing makes a fall of 20 % enough, though the model has the family."""
    for families in ([], ["feed_x"]):
        found = passes(scored(drop=0.2, white_drop=white_drop), measure(families=families))
        assert fails(FALL, found) is refused


@pytest.mark.parametrize(("drop", "refused"), [(0.15, False), (0.149, True)])
def test_sharp_drop_limit(drop: float, refused: bool) -> None:
    assert fails(FALL, passes(scored(drop=drop, white_drop=0.3), measure())) is refused


@pytest.mark.parametrize(("before", "refused"), [(0.201, False), (0.199, True)])
def test_an_error_at_the_floor_is_left_alone(before: float, refused: bool) -> None:
    found = passes(scored(drop=0.6, before=before, after=0.1), measure(floor=0.2))
    assert fails(LITTLE, found) is refused


@pytest.mark.parametrize(("drop", "refused"), [(0.65, False), (0.649, True)])
def test_strong_drop(drop: float, refused: bool) -> None:
    assert fails(LITTLE, passes(scored(drop=drop, before=0.19, after=0.1), measure(floor=0.2))) is refused


@pytest.mark.parametrize(("white_drop", "refused"), [(0.30, False), (0.299, True)])
def test_sharp_timing_is_worth_a_name_at_the_floor(white_drop: float, refused: bool) -> None:
    found = passes(scored(drop=0.6, white_drop=white_drop, before=0.19, after=0.1), measure(floor=0.2))
    assert fails(LITTLE, found) is refused


@pytest.mark.parametrize(("better", "refused"), [(7, False), (6, True)])
def test_tests_limit(better: int, refused: bool) -> None:
    """An error that stays the same has not fallen."""
    after = [40.0] * better + [100.0] * (10 - better)
    assert fails(FEW, passes(scored(before=[100.0] * 10, after=after), measure())) is refused


@pytest.mark.parametrize(("white_drop", "refused"), [(0.30, False), (0.299, True)])
def test_sharp_timing_needs_no_majority_of_tests(white_drop: float, refused: bool) -> None:
    after = [10.0] * 6 + [101.0] * 4
    found = passes(scored(white_drop=white_drop, before=[100.0] * 10, after=after), measure())
    assert fails(FEW, found) is refused


@pytest.mark.parametrize(("taken", "refused"), [(0.301, False), (0.299, True)])
def test_share_limit(taken: float, refused: bool) -> None:
    """3 % of a spread of 10."""
    after = math.sqrt(1.0 - taken**2)
    assert fails(SMALL, passes(scored(before=1.0, after=after), measure(spread=10.0))) is refused


@pytest.mark.parametrize(("white_drop", "refused"), [(0.001, False), (0.0, True), (-0.1, True)])
def test_without_the_residuals_inertia_something_is_left(white_drop: float, refused: bool) -> None:
    assert fails(INERTIA, passes(scored(white_drop=white_drop), measure())) is refused


def test_reasons_are_given_with_their_numbers() -> None:
    found = passes(scored(p_value=0.25, drop=0.1, white_drop=-0.1), measure())
    assert [CHANCE in found[0], FALL in found[1], INERTIA in found[2]] == [True] * 3
    assert "25%" in found[0]
    assert "2%" in found[0]
    assert "10%" in found[1]
    assert "30%" in found[1]
    little = passes(scored(drop=0.6, before=0.19, after=0.1), measure(floor=0.2))
    assert "FIT 90" in little[0]


@pytest.mark.parametrize(
    ("noise", "spread", "floor"),
    [(0.1, 4.9, 0.5), (0.1, 5.1, 0.51), (float("nan"), 4.0, 0.4), (0.0, 4.0, 0.4)],
)
def test_the_floor_is_five_times_the_noise_or_a_tenth_of_the_spread(noise: float, spread: float, floor: float) -> None:
    assert Measure(ROWS, spread, noise, frozenset()).floor == pytest.approx(floor)


@pytest.mark.parametrize(
    ("evidence", "promising"),
    [
        ({"p_value": 0.02}, True),
        ({"p_value": 0.0201}, False),
        ({"white_drop": 0.001}, True),
        ({"white_drop": 0.0}, False),
        ({"drop": 0.15}, True),
        ({"drop": 0.149}, False),
    ],
)
def test_is_promising(evidence: dict[str, float], promising: bool) -> None:
    assert is_promising(scored(**evidence), measure()) is promising


@pytest.mark.parametrize(
    ("rule", "floor", "white_drop", "after", "proxy"),
    [
        ("half of the error", 0.001, 0.0, 0.499, False),
        ("half of the error", 0.001, 0.0, 0.501, True),
        ("0.6 of the error near the floor", 0.45, 0.0, 0.599, False),
        ("0.6 of the error near the floor", 0.45, 0.0, 0.601, True),
        ("1.5 floors, where that is less", 0.36, 0.0, 0.539, False),
        ("1.5 floors, where that is less", 0.36, 0.0, 0.541, True),
        ("0.7 of the floor", 0.9, 0.299, 0.629, False),
        ("0.7 of the floor", 0.9, 0.299, 0.631, True),
        ("the whole floor with sharp timing", 0.9, 0.3, 0.899, False),
        ("the whole floor with sharp timing", 0.9, 0.3, 0.901, True),
    ],
)
def test_is_proxy(rule: str, floor: float, white_drop: float, after: float, proxy: bool) -> None:
    assert is_proxy(scored(before=1.0, after=after, white_drop=white_drop), measure(floor=floor)) is proxy, rule


def test_a_lag_of_a_channel_without_a_place_is_claimed_as_what_it_is() -> None:
    assert not is_proxy(scored(before=1.0, after=0.99, placeless=True), measure(floor=0.001))


@pytest.mark.parametrize(
    ("floor", "left", "enough"), [(0.001, 0.349, True), (0.001, 0.351, False), (0.6, 0.419, True), (0.6, 0.421, False)]
)
def test_enough_together(floor: float, left: float, enough: bool) -> None:
    """0.35 of the error, or 0.7 of the floor."""
    assert enough_together(left, 1.0, measure(floor=floor)) is enough


def test_errors_are_counted_over_all_rows() -> None:
    one = scored(before=2.0, after=1.0)
    assert remaining(one.sse_before, measure()) == pytest.approx(2.0)
    assert fit_of(one.sse_before, measure(spread=8.0)) == pytest.approx(75.0)
    assert fit_of(one.sse_before, measure(spread=0.0)) == 0.0
    assert explained(one, ROWS) == pytest.approx(math.sqrt(3.0))
    assert explained(scored(before=1.0, after=2.0), ROWS) == 0.0
