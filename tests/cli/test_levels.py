"""From where errors count, said below every table of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from ..commands import Said


@pytest.mark.parametrize(
    "words",
    [
        ["fit", "baseline"],
        ["compare", "baseline"],
        ["compare", "baseline", "baseline"],
        ["compare", "baseline", "--against", "baseline"],
        ["history", "baseline"],
    ],
)
def test_a_table_of_errors_says_from_where_they_count(
    say: Callable[..., Said], campaign: Path, words: list[str]
) -> None:
    told = say("--store", campaign / "thermodata.store", *words).out
    assert told.count("level: the error of a calibration test is about a level fitted to it") == 1


def test_a_table_for_a_paper_is_that_table_alone(say: Callable[..., Said], campaign: Path) -> None:
    words = ("compare", "baseline", "--against", "baseline", "--layout", "csv")
    told = say("--store", campaign / "thermodata.store", *words)
    assert "level:" not in told.out
    assert told.err.count("level: the error of a calibration test is about a level fitted to it") == 1


def test_a_prediction_says_that_all_count_from_their_first_samples(say: Callable[..., Said], campaign: Path) -> None:
    told = say("--store", campaign / "thermodata.store", "predict", "baseline", "campaign:small").out
    assert "level: the error of every test counts from its first samples" in told


@pytest.mark.parametrize(
    "words", [["compare", "baseline"], ["compare", "baseline", "baseline"], ["history", "baseline"]]
)
def test_on_a_narrow_screen_no_line_is_wider_than_it(
    say: Callable[..., Said], campaign: Path, words: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    told = say("--store", campaign / "thermodata.store", *words).out.splitlines()
    assert max(map(len, told)) <= 60
    assert "level: the error of a calibration test is about a level" in told
