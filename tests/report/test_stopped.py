"""What stops the likeliest cause is told in the head, and how the locked tests are asked of it."""

from __future__ import annotations

import pytest

from thermodata.report.verdict.verdict import verdict_sentence
from thermodata.schema.answers.candidate import Candidate, Rung

from ..answers import candidate, diagnosis


def rung(name: str, fails: str | None = None) -> Rung:
    holds = fails is None
    return Rung(name=name, asks="", value=1.0, limit=0.65, at="least", asked=True, holds=holds, unit="1", fails=fails)


def oil(probability: float, *broken: str, **more: object) -> Candidate:
    sure = rung("probability", None if probability >= 0.65 else "causes like it were right in few cases")
    rungs = [*(rung(name, f"it breaks {name}") for name in broken), sure]
    return candidate("sun:T_oil", probability=probability, rungs=rungs, **more)


def head(*candidates: Candidate) -> str:
    text = verdict_sentence(diagnosis(*candidates, verdict="unknown"))
    return text.partition("the likeliest that was logged is ")[2]


def test_the_rule_that_stops_what_is_as_probable_as_a_claim_asks_stands_in_the_head() -> None:
    said = head(oil(0.85, "tests", "worth"))
    assert said.startswith("sun (T_oil), probability 85 %: enough for a claim, which asks 65 %, but it breaks tests")
    assert "worth" not in said
    locked = {"locked_tests_asked": 1, "locked_shape_um_before": 1.0, "locked_shape_um_after": 1.2}
    assert head(oil(0.85, "tests", **locked)).endswith(
        "but it breaks tests and the locked tests do not bear it out (1.00 -> 1.20 um about each one's mean)"
    )
    assert "enough" not in head(oil(0.64, "tests"))


@pytest.mark.parametrize(
    ("probability", "broken", "asked", "names"),
    [
        (0.85, ("tests", "worth"), None, True),  # as probable as a claim asks
        (0.3, (), None, True),  # its probability alone stops it
        (0.29, (), None, False),
        (0.5, ("worth",), None, False),  # two rules do
        (0.85, ("worth",), 1, False),  # they were asked already
    ],
)
def test_what_one_rule_alone_stops_has_the_command_that_asks_the_locked_tests(
    probability: float, broken: tuple[str, ...], asked: int | None, names: bool
) -> None:
    said = head(oil(probability, *broken, locked_tests_asked=asked))
    assert ("thermodata confirm m sun:T_oil asks the locked tests of it, where there are some" in said) is names
    assert ("thermodata" in said) is names


@pytest.mark.parametrize(("after", "told"), [(2.0, True), (2.4, False), (2.7, False)])
def test_what_lets_locked_tests_get_better_and_a_rule_stops_is_told_beside_the_likeliest(
    after: float, told: bool
) -> None:
    """A claim by a turret of 7.65 -> 2.58 um stood in the table alone."""
    turret = candidate(
        "lag:T_turret",
        equivalent=["turret_heat:T_turret"],
        locked_tests_asked=2,
        locked_shape_um_before=2.55,
        locked_shape_um_after=after,
        rungs=[rung("worth", "it explains 0.72 um where it acts"), rung("probability", "right in 61 % of cases only")],
    )
    said = head(oil(0.35), turret)
    assert (
        "; the locked tests were opened for lag (T_turret), which may be turret_heat, and get better with it (2.55 -> "
        "2.00 um about each one's mean), but it explains 0.72 um where it acts: thermodata confirm m lag:T_turret "
        "tells what each says" in said
    ) is told
    assert ("get better" in said) is told
    assert "asks the locked tests of it" in said
    assert "where there are some" not in said, "some were opened"
