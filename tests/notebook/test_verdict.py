"""A verdict in a notebook: in the unit of its response, and acted on by its own ranks."""

from __future__ import annotations

from typing import Any

from thermodata.notebook.verdict import Verdict

from ..answers import candidate, diagnosis


class Asked:
    """A model that was asked of a temperature, and notes what it is told to do."""

    name = "both"

    def __init__(self) -> None:
        self.told: list[Any] = []

    def unit_of(self, response: str) -> str:
        return {"dZ": "um", "T_nut": "K"}[response]

    def add(self, *candidates: str | int, plain: bool = False) -> None:
        self.told.append((*candidates, plain))

    def confirm(self, candidate: str | int, response: str | None = None) -> Any:
        self.told.append((candidate, response))


def verdict(of: Asked) -> Verdict[None]:
    coolant = candidate("coolant:coolant_on", claimed=True)
    return Verdict(of, diagnosis(coolant, response="T_nut", verdict="none", rmse_um=0.5, explainable=0.0))


def test_a_rank_is_one_of_this_verdict_whatever_was_asked_since() -> None:
    of = Asked()
    one = verdict(of)
    one.confirm(1)
    one.add("1", plain=True)
    one.confirm("lag:T_hall")
    assert of.told == [("coolant:coolant_on", "T_nut"), ("coolant:coolant_on", True), ("lag:T_hall", "T_nut")]
    one.add()
    one.add(1, "lag:T_hall")
    assert of.told[3:] == [("coolant:coolant_on", False), ("coolant:coolant_on", "lag:T_hall", False)]


def test_claims_are_shown_in_a_line_each() -> None:
    (claim,) = verdict(Asked()).claims
    assert repr(claim).startswith("Candidate(rank=1, id='coolant:coolant_on', claimed=True, refinement=False, prob")
    assert len(repr(claim)) < 200


def test_a_verdict_on_a_temperature_is_in_kelvin() -> None:
    one = verdict(Asked())
    assert "0.500 K" in one.sentence
    assert "0.500 K" in one.summary()
    assert " um" not in one.summary()
    assert "[um]" not in one.summary()
