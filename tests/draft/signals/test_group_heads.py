"""Heads over several columns say what these are; a length that only its unit calls a position is asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.make import draft_files
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of
from thermodata.reader.text.names.header_rows import names_and_units

UNITS = ["s", "°C", "°C", "mm", "mm"]
NAMES = ["Time", "front", "hall", "X", "Z"]


def channels(folder: Path, *heads: list[str]) -> dict[str, DraftChannel]:
    folder.mkdir()
    rows = [[f"{10 * i}", f"{20 + i / 10}", "20.5", f"{i / 1000:.3f}", f"{i / 500:.3f}"] for i in range(40)]
    (folder / "T1.csv").write_text("".join(";".join(row) + "\n" for row in (*heads, NAMES, UNITS, *rows)))
    return {c.signal: c for c in draft_files(folder).draft.channels}


def test_a_head_over_several_columns_says_what_they_are(tmp_path: Path) -> None:
    found = channels(tmp_path / "lab", ["", "Temperatures", "", "Displacements", ""])
    assert {"front", "X", "Z"} <= found.keys(), "signals are called as their own cells are"
    assert (found["X"].said.quantity, found["X"].said.axis, found["X"].said.at) == ("displacement", "X", "tcp")
    assert found["Z"].name == "Displacements_Z"
    assert found["front"].said.quantity == "temperature"


def test_without_a_head_small_positions_are_asked(tmp_path: Path) -> None:
    found = channels(tmp_path / "lab")
    assert found["X"].said.quantity == "position"
    assert found["X"].said.questions == (
        "a position, or a displacement? then quantity: displacement, axis: X, at: tcp",
    )


@pytest.mark.parametrize(("name", "high", "asked"), [("X", 4.9, True), ("X", 400.0, False), ("Position X", 4.9, False)])
def test_what_travels_or_is_called_a_position_is_one(name: str, high: float, asked: bool) -> None:
    import numpy as np

    said = guess(name, "mm", "float64", values_of(np.linspace(0.0, high, 50)))
    assert said.quantity == "position"
    assert any("a displacement?" in q for q in said.questions) is asked


@pytest.mark.parametrize(
    ("above", "over"),
    [
        (
            ["", "Temperatures", "", "Displacements", ""],
            ["", "Temperatures", "Temperatures", "Displacements", "Displacements"],
        ),
        (["", "", "", "Displacements", ""], [""] * 5),  # one alone may be a title
        (["Machine 138", "", "", "", ""], [""] * 5),
        (["", "101", "", "102", ""], [""] * 5),
        (["", "°C", "", "mm", ""], [""] * 5),
        (["a", "b", "c", "d", "e"], [""] * 5),  # of each column, not of several
    ],
)
def test_which_rows_are_heads(above: list[str], over: list[str]) -> None:
    names, units, found = names_and_units([above, NAMES, UNITS], 5, None)
    assert names == NAMES
    assert units == UNITS
    assert found == over


@pytest.mark.parametrize(("name", "asked"), [("Status", True), ("Data Quality", True), ("Program status of NC", False)])
def test_words_that_tell_of_the_readings_are_asked(name: str, asked: bool) -> None:
    said = guess(name, None, "str")
    assert said.quantity == "label"
    assert any("count like all others" in q for q in said.questions) is asked


@pytest.mark.parametrize(
    "head", ["Spostamenti", "Verplaatsingen", "Yer değiştirmeler", "Verlagerungen", "Przemieszczenia"]
)
def test_a_head_of_displacements_in_the_plural_says_so(head: str) -> None:
    found = guess(f"{head}/Asse Y", "mm")
    assert (found.quantity, found.axis, found.at) == ("displacement", "Y", "tcp")


def _tagged(folder: Path, *tags: str) -> dict[str, DraftChannel]:
    """A logger's table whose addresses stand below a row of tags."""
    names = [f"CH{k + 1:04d}" for k in range(len(tags))]
    head = [["Canale", "", "", *names], ["Etichetta", "", "", *tags], ["Unit", "", "", *["degC"] * len(tags)]]
    head += [["Data", "Ora", "ms", *names]]
    rows = [["19/03/2026", f"05:{i:02d}:00", "000", *[f"{20 + i / 10:.2f}"] * len(tags)] for i in range(40)]
    (folder / "ciclo.csv").write_text("".join(";".join(row) + "\n" for row in (*head, *rows)), "utf-8")
    return {c.signal: c for c in draft_files(folder).draft.channels}


def test_the_tag_over_an_address_is_shown_behind_what_is_guessed_by_it(tmp_path: Path) -> None:
    found = _tagged(tmp_path, "Cuscinetto mandrino ant.", "Bussola guida", "Aria officina")
    assert found["CH0001"].said.at == "spindle.bearing.front"
    assert found["CH0001"].note == "called 'Cuscinetto mandrino ant.' in the file"
    assert found["CH0002"].note == "called 'Bussola guida' in the file", "its place is asked"
    assert "called 'Cuscinetto mandrino ant.' in the file" in (tmp_path / "campaign.yaml").read_text("utf-8")


def test_a_head_over_several_columns_is_no_tag(tmp_path: Path) -> None:
    found = channels(tmp_path / "lab", ["", "Temperatures", "", "Displacements", ""])
    assert {found[name].note for name in ("front", "X", "Z")} == {None}
