"""The benchmark of evidence against rules that are set by hand: one machine, and what exchanged histories are."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def hand_rules(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(BENCHMARKS)
    return import_module("hand_rules")


def test_both_are_asked_about_one_machine_and_marked_alike(hand_rules: Any) -> None:
    trial = hand_rules.judge("tests_3", 40_000)
    assert trial["hidden"] == ("probe_bracket",)
    assert trial["evidence"]["claims"] == ["probe_temperature:C09_bracket"]
    assert trial["by_hand"]["first"] == "probe_temperature:C09_bracket"
    assert trial["no_null"]["outcome"] == "right"
    (claim,) = trial["claims"]
    assert claim["right"]
    assert 0 < claim["promised"] < hand_rules.STEADIES
    assert 0.01 <= claim["p"] <= 1
    said = hand_rules.report([trial])
    assert "| tests_3 | 1 | evidence | 1 of 1 | 0 of 1 |" in said
    assert "by evidence: 1 claims right, 0 not" in said


def test_no_test_keeps_its_own_history(hand_rules: Any) -> None:
    exchanged = import_module("by_hand.exchanged")
    orders = list(exchanged.derangements(4, np.random.default_rng(0), 50))
    assert len(orders) == 50
    assert all(sorted(o) == [0, 1, 2, 3] and (o != np.arange(4)).all() for o in orders)


def test_a_longer_test_ends_where_the_one_does_whose_rest_it_is_given(hand_rules: Any) -> None:
    exchanged = import_module("by_hand.exchanged")
    times = [np.arange(6.0), np.arange(4.0)]
    blocks = tuple(SimpleNamespace(t_s=t) for t in times)
    rest = [np.full(6, 10.0), np.array([1.0, 2.0, 3.0, 4.0])]
    problem = SimpleNamespace(blocks=blocks, parts=[slice(0, 6), slice(6, 10)], response_blocks=rest)
    explained = np.arange(10.0)
    pair = exchanged.pairs(problem, np.ones((10, 2)), explained, lambda test, columns: columns)
    columns, response = pair(0, 1)
    # what is known there, and what the other test has beyond its own
    assert columns.shape == (4, 2)
    assert response.tolist() == (np.arange(4) + rest[1] - explained[6:]).tolist()
    assert pair(1, 0)[1].tolist() == (explained[6:] + 10.0 - np.arange(4)).tolist()
