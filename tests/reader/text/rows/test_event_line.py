"""Lines between the rows of a table of numbers that say in words what happened; rows that are cut are none."""

from __future__ import annotations

import pytest

from thermodata.reader.text.rows.event_line import event_notes, is_event_line

NUMBERS = [False, False, False, False]


@pytest.mark.parametrize(
    "cells",
    [
        ["02.03.2026 08:25:30", "EREIGNIS: Spindel ein M3 S4000"],
        ["2026-03-02T08:25:30Z", "EVENT: M3", "", ""],
        ["02.03.2026", "08:25:30", "spindle on"],
        ["8:25:30 AM", "# door opened"],
        ["1530.5", "ALARM 700016 drive not ready"],
    ],
)
def test_a_time_and_words_are_an_event(cells: list[str]) -> None:
    assert is_event_line(cells, NUMBERS)


@pytest.mark.parametrize(
    "cells",
    [
        ["02.03.2026 08:25:30", "400"],
        ["02.03.2026 08:25:30", "NaN"],
        ["02.03.2026 08:25:30", "Overflow"],  # of a row that is cut
        ["02.03.2026 08:25:30", "4000", "spindle on"],
        ["02.03.2026 08:25:30", "spindle on", "21,5"],
        ["02.03.2026 08:25:30", "1 000"],
        ["02.03.2026 08:25:30"],
        ["spindle on"],
        ["", ""],
        ["02.03.2026", "08:25:30", "4000", "spindle on"],  # as many cells as a row
    ],
)
def test_what_may_be_a_row_is_none(cells: list[str]) -> None:
    assert not is_event_line(cells, NUMBERS)


def test_words_in_a_column_of_text_are_none() -> None:
    assert not is_event_line(["02.03.2026 08:25:30", "spindle on"], [False, True, False])


def test_they_are_told() -> None:
    lines = [["8:00", "1", "2", "3"], ["8:01", "spindle on"], ["8:02", "spindle on"], ["8:03", "door open"]]
    said = "lines that say what happened are no rows, and are not read"
    shown = "'spindle on', 'door open'"
    assert event_notes(lines, NUMBERS, 30) == [f"{said} (3 lines, the first is line 31): {shown}"]
    assert event_notes(lines, NUMBERS, 30, whole=False) == [f"{said} (at least 3 lines, the first is line 31): {shown}"]
    assert event_notes(lines[1:2], NUMBERS, 2) == [f"{said} (1 line, the first is line 2): 'spindle on'"]
    assert event_notes(lines[:1], NUMBERS, 1) == []
