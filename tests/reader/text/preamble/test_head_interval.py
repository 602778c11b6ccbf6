"""The time from row to row that stands above rows which nothing dates: proposed, to be confirmed."""

from __future__ import annotations

import pytest

from thermodata.errors import QuestionError
from thermodata.reader.text.page.layout import find_layout

ROWS = [[str(k), f"{21 + k / 10:.1f}", "0.5"] for k in range(1, 40)]
HEAD = [["Scan", "T front", "dZ"]]


@pytest.mark.parametrize(
    ("line", "period"),
    [
        (["Sample interval: 2 s"], "2 s"),
        (["Sampling rate", "10 Hz"], "0.1 s"),
        (["Intervall [min]", "5"], "300 s"),
        (["# Interval = 00:00:30"], "30 s"),
        (["Messintervall", "500", "ms"], "0.5 s"),
        (["Storage cycle", "2000 ms"], "2 s"),
    ],
)
def test_an_interval_above_the_rows_is_proposed(line: list[str], period: str) -> None:
    with pytest.raises(QuestionError) as asked:
        find_layout([["Logger XY"], line, *HEAD, *ROWS], None, "here")
    assert asked.value.declare == {"time": {"period": period}}
    assert "above them says" in asked.value.ask
    assert find_layout([["Logger XY"], line, *HEAD, *ROWS], asked.value.declare, "here").groups[0].counted


@pytest.mark.parametrize("line", [["Spindle speed: 2 s"], ["Sample interval: auto"], ["Cycle: 2 s"], ["Interval: 0 s"]])
def test_what_says_no_interval_leaves_the_question_open(line: list[str]) -> None:
    with pytest.raises(QuestionError) as asked:
        find_layout([["Logger XY"], line, *HEAD, *ROWS], None, "here")
    assert asked.value.declare == {"time": {"period": "unknown"}}


def _notes(line: str, step: float, said: dict[str, object] | None = None, unit: str = "s") -> list[str]:
    rows = [[f"{k * step:g}", f"{21 + k / 10:.1f}", "0.5"] for k in range(40)]
    layout = find_layout([[line], [f"Time [{unit}]", "T front", "dZ"], *rows], {"time": said} if said else None, "here")
    return [note for note in layout.notes if "which one is it?" in note]


@pytest.mark.parametrize(
    ("line", "step"), [("# Sample interval: 10 s", 1), ("Sampling interval: 0.2 s", 1), ("Scan interval: 2 s", 0.5)]
)
def test_a_time_that_an_interval_above_it_contradicts_is_told_until_one_is_declared(line: str, step: float) -> None:
    (note,) = _notes(line, step)
    assert line.lstrip("# ") in note
    assert not _notes(line, step, {"column": 1})
    assert not _notes(line, step, {"period": 10.0})


@pytest.mark.parametrize(
    ("line", "step"), [("Sample interval: 10 s", 10), ("Sampling rate: 10 Hz", 60), ("Interval: 1 s", 1.02)]
)
def test_rows_at_their_interval_and_means_over_several_are_not_told(line: str, step: float) -> None:
    assert not _notes(line, step)


@pytest.mark.parametrize(
    ("line", "unit"),
    [
        ("Sample rate: 100 Hz", "s"),
        ("Abtastrate: 10 Hz", "s"),
        ("Abtastfrequenz: 5 Hz", "s"),
        ("Sample interval: 10 s", "min"),
        ("Messintervall: 1 min", "h"),
    ],
)
def test_means_of_each_second_minute_or_hour_are_not_told(line: str, unit: str) -> None:
    assert not _notes(line, 1, unit=unit)
