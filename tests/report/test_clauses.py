"""A sentence of several figures is told a clause a line, and none is cut within its brackets."""

from __future__ import annotations

import pytest

from thermodata.report.text.clauses import clauses, in_lines


@pytest.mark.parametrize(
    ("sentence", "parts"),
    [
        ("", [""]),
        ("missing: screw (T)", ["missing: screw (T)"]),
        ("missing: screw (T); error 4 -> 1 um", ["missing: screw (T)", "error 4 -> 1 um"]),
        (
            "none could be asked (a: no 'dZ'; b: no 'v'): see; why",
            ["none could be asked (a: no 'dZ'; b: no 'v'): see", "why"],
        ),
        ("1) first; 2) second", ["1) first", "2) second"]),
        ("a (b [c; d]; e); f", ["a (b [c; d]; e)", "f"]),
    ],
)
def test_clauses_are_what_semicolons_part_outside_of_brackets(sentence: str, parts: list[str]) -> None:
    assert clauses(sentence) == parts
    assert "; ".join(clauses(sentence)) == sentence, "nothing is lost"


def test_each_further_clause_has_a_line_put_in_by_two() -> None:
    assert in_lines("a; b (c; d); e") == "a\n  b (c; d)\n  e"
