"""Texts that are no YAML: the line, and what to change in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.load import parse_campaign
from thermodata.schema.strict.lines import parse_document


@pytest.mark.parametrize(
    ("text", "where", "hint"),
    [
        ("s:\n  a: {b: c}\n   d: {e: f}\n", "c.yaml:3", "line 3 is set in by 3, line 2 above it by 2: entries of one"),
        ("m:\n  id: 1\n axes: {}\n", "c.yaml:3", "line 3 is set in by 1, line 2 above it by 2"),
        ("t:\n  - {id: a}\n   - {id: b}\n", "c.yaml:3", "line 3 is set in by 3, line 2 above it by 2"),
        ("id: x\n  m: {id: 1}\n", "c.yaml:2", "line 2 is set in by 2, line 1 above it by 0"),
        ("id: x: y\n", "c.yaml:1", "line 1 has a ':' within a value"),
        ("s:\n\tlog: {a: b}\n", "c.yaml:2", "line 2 has a tab where YAML wants spaces"),
        ("m: {id: 1\ns:\n  a: b\n", "c.yaml:2", "the bracket that opens in line 1 is not closed before line 2"),
        ("s:\n  log: {files: {test}.csv}\n", "c.yaml:2", "the bracket that opens in line 2 is not closed, or a ','"),
        ('id: "x\ns: {}\n', "c.yaml:3", "the quote that opens in line 1 is not closed"),
    ],
)
def test_a_fault_of_yaml_names_its_line_and_what_to_do(text: str, where: str, hint: str) -> None:
    with pytest.raises(SpecError, match="not valid YAML") as told:
        parse_document(text, Path("c.yaml"))
    assert str(told.value.where).startswith(where)
    assert str(told.value.hint).startswith(hint)


@pytest.mark.parametrize(("bad", "code"), [("\0", "U+0000"), ("\x01", "U+0001"), ("\ufffe", "U+FFFE")])
def test_a_character_that_yaml_does_not_take_is_named_with_its_place(bad: str, code: str) -> None:
    """The lines before it are set in as a fault of indentation would be, which has nothing to do with it."""
    with pytest.raises(SpecError, match="not valid YAML") as told:
        parse_document(f"m:\n  id: 1\n  a: x{bad}", Path("c.yaml"))
    assert told.value.where == "c.yaml:3, column 7"
    assert code in str(told.value.got)
    assert str(told.value.hint).startswith(f"delete the character {code} in line 3")
    assert parse_document("m:\n  id: 1\n  a: xž\n", Path("c.yaml")).data["m"]["a"] == "xž"


@pytest.mark.parametrize("text", ["s: x\na: " + "[" * 5000, "s:\n" + "".join(f"{' ' * k}k:\n" for k in range(1, 500))])
def test_what_nests_too_deep_is_told_so_with_its_line(text: str) -> None:
    with pytest.raises(SpecError, match="nests too deep") as told:
        parse_document(text, Path("c.yaml"))
    assert told.value.where == ("c.yaml:2" if "[" in text else "c.yaml:61")
    assert "60 levels" in str(told.value)
    assert "set in by" not in str(told.value)


@pytest.mark.parametrize("levels", [20, 58])
def test_what_nests_less_is_read(levels: int) -> None:
    assert parse_document("a: " + "[" * levels + "]" * levels, Path("c.yaml")).data["a"] is not None


def test_values_of_a_list_that_lack_the_same_are_one_problem() -> None:
    text = (
        "schema: thermodata/campaign/1\nid: x\nmachine: {id: a}\nsources: {log: {reader: table, files: a.csv}}\n"
        "calibrations:\n  j: {kind: jump, axis: Z, source: log, file: a, signal: a, moves: [10, 10, -10, -10]}\n"
    )
    with pytest.raises(SpecError) as told:
        parse_campaign(text, "c.yaml")
    assert told.value.what.startswith("4 values of 'calibrations.j.moves': a value without a unit")
    assert "problems" not in str(told.value)
    with pytest.raises(SpecError, match=r"^'1': a value without a unit"):
        parse_campaign(text.replace("[10, 10, -10, -10]", "[10 um, 10, -10 um]"), "c.yaml")
