"""What stops the likeliest cause is told in the head."""

from __future__ import annotations

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
