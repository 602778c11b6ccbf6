"""What `tests/benchmarks/worth.py` prints of trials."""

from __future__ import annotations

from ..benchmarks.worth import best_rival


def test_trials_that_no_simple_method_was_tried_on_have_no_best_one() -> None:
    assert best_rival([]) == "-"
    assert best_rival([{"rivals": None}, {"rivals": {}}]) == "-"
