"""Which lines of a table are statistics over its columns, or say that it ends."""

from __future__ import annotations

import pytest

from thermodata.reader.text.rows.footer import footer_notes, is_footer


@pytest.mark.parametrize(
    "cells",
    [
        ["Max", "", "24.1"],
        ["", "Mittelwert:", "22,5", "--"],
        ["Std.Abw.", "0.1"],
        ["Max", "32,21", "5 000", "1\u202f317,5"],
        ["最大値", "25.1"],
        ["Standard deviation", 0.25],
        ["Grenzwertverletzungen", "", "0", "3"],
        ["Limit violations", "0"],
        ["$RT_COUNT$", "5965", "", ""],
        ["--- END ---"],
        ["Fin de fichier"],
        ["Last", "", "24.1"],
        ["Letzter Wert", "22,5"],
    ],
)
def test_statistics_and_marks_of_the_end_are_footers(cells: list[object]) -> None:
    assert is_footer(cells)


@pytest.mark.parametrize(
    "cells",
    [
        [],
        ["", ""],
        ["Max"],
        ["Max", "broken", "24.1"],
        ["Max", "5 00 24.1"],
        ["Max", "2026-03-02", "24.1"],
        ["08:00:00", "max", "24.1"],
        ["END", "of the line, 3000 rpm"],
        ["Maxwell", "24.1"],
        ["Grenzwert", "24.1"],
        ["Fin de cycle"],
        ["24.1", "Max"],
    ],
)
def test_rows_words_and_damage_are_none(cells: list[object]) -> None:
    assert not is_footer(cells)


def test_each_kind_of_line_is_noted_once() -> None:
    lines = [["0", "20.5"], ["Min", "20"], ["Max", "25"], ["Max", "26"], ["Sum", "1"], ["Avg", "2"], ["RMS", "3"]]
    assert footer_notes(lines) == [
        "lines of statistics or of the end of the table are not read: 'Min', 'Max', 'Sum', 'Avg', ..."
    ]
    assert footer_notes(lines[:1]) == []
