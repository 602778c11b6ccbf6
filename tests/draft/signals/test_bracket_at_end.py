"""A bracket at the end of a name that no header splits off: a unit of its quantity, one that is asked, or a word."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.signals.values import values_of
from thermodata.reader.text import split_unit
from thermodata.schema.units.conversion import linear_conversion


def _said(header: str, low: float, high: float) -> Guess:
    name, unit = split_unit(header)
    return guess(name if unit else header, unit, "float64", values_of(np.linspace(low, high, 360) + 1e-9))


@pytest.mark.parametrize(
    ("header", "high", "quantity", "unit"),
    [
        ("X Position (in)", 11.8, "position", "in"),
        ("Y Axis Position (in.)", 11.8, "position", "in"),
        ("Ram Position (ft)", 1.0, "position", "ft"),
        ("X_pos[in]", 11.8, "position", "in"),
        ("X pos in.", 11.8, "position", "in"),
        ("Z Height Pos, in.", 11.8, "position", "in"),
        ("Position X (Zoll)", 11.8, "position", "Zoll"),
        ("Posición X (pulgadas)", 11.8, "position", "pulgadas"),
        ("Displacement Z (in)", 0.0016, "displacement", "in"),
        ("dX_in", 0.0016, "displacement", "in"),
        ("Spindle Power (HP)", 9.0, "power", "HP"),
        ("Spindle Load (pu)", 0.15, "load", "pu"),
        ("Spindle Load (fraction)", 0.15, "load", "pu"),
        ("load_frac", 0.15, "load", "pu"),
        ("/d.load_ratio", 0.15, "load", "pu"),
    ],
)
def test_a_unit_of_the_quantity_is_taken(header: str, high: float, quantity: str, unit: str) -> None:
    said = _said(header, 0.0, high)
    assert (said.quantity, said.unit) == (quantity, unit)
    assert not any(q.startswith("unit") for q in said.questions)


@pytest.mark.parametrize(
    ("header", "high"),
    [
        ("X_pos_in", 11.8),
        ("X pos in", 11.8),
        ("X pos in", 900.0),
        ("axis_position_in", 11.8),
        ("/plc.axis_position_in", 11.8),
        ("plc/axis_position_in/value", 11.8),
    ],
)
def test_an_in_behind_a_position_may_say_an_input_and_is_asked(header: str, high: float) -> None:
    said = _said(header, 0.0, high)
    assert (said.quantity, said.unit, said.sure) == ("position", "in", False)
    assert "unit: inch, or is 'in' an input? then its own unit" in said.questions
    assert any("or mm?" in q for q in said.questions) is (high > 200.0)


@pytest.mark.parametrize(
    ("header", "low", "high"),
    [
        ("dX_in", 0.0, 0.03),
        ("dX_in", -0.02, 0.0),
        ("dX in", 0.0, 0.11),
        ("/probes.dX_in", 0.0, 0.05),
        ("Displacement_Z_in", 0.1, 0.12),
    ],
)
def test_an_in_behind_a_displacement_is_asked_but_of_what_no_other_unit_fits(
    header: str, low: float, high: float
) -> None:
    said = _said(header, low, high)
    assert (said.quantity, said.unit, said.sure) == ("displacement", "in", False)
    assert any(q.startswith("unit: inch, or is 'in' an input, or inside? then um, mm or V") for q in said.questions)


@pytest.mark.parametrize("header", ["dX [in]", "Displacement Z (in)", "dX_inch", "dX_in [in]"])
def test_an_inch_that_is_written_is_not_asked(header: str) -> None:
    said = _said(header, 0.0, 0.03)
    assert said.unit in ("in", "inch")
    assert not any("input" in q for q in said.questions)


@pytest.mark.parametrize(
    "header",
    [
        "X Position (counts/rev)",
        "Position Y (cts)",
        "Y pos (steps)",
        "X Pos (″)",
        'Y Pos (")',
        "Z Pos (2.5 um)",
        "T_front (°Ra)",
    ],
)
def test_what_reads_as_a_unit_and_is_none_known_is_asked_and_no_other_is_guessed(header: str) -> None:
    said = _said(header, 20.0, 30.0)
    assert said.unit is None or header.endswith(f"({said.unit})")
    assert any(q.startswith("unit: ") for q in said.questions) or said.quantity is None


@pytest.mark.parametrize(
    ("header", "unit"),
    [
        ("Coolant temp (in)", "degC"),
        ("T coolant (out)", "degC"),
        ("X Position (act)", "mm"),
        ("X-Achse Position (Ist)", "mm"),
        ("X position (MCS)", "mm"),
        ("X Position (encoder)", "mm"),
        ("X Position (1)", "mm"),
        ("T bearing (front)", "degC"),
        ("Temp hall (Pt100)", "degC"),
        ("Speed (S1)", "rpm"),
        ("T bearing (1/2)", "degC"),
        ("T bearing (L/R)", "degC"),
        ("T bearing (B)", "degC"),
        ("X Position (A/B)", "mm"),
        ("X Position (2nd)", "mm"),
        ('T ("hall")', "degC"),
    ],
)
def test_a_word_in_brackets_asks_nothing_of_the_unit(header: str, unit: str) -> None:
    said = _said(header, 20.0, 300.0 if unit == "rpm" else 30.0)
    assert said.unit == unit
    assert not any(q.startswith("unit") for q in said.questions)


@pytest.mark.parametrize(
    ("name", "low", "high", "asked"),
    [
        ("spindle_load", 0.0, 0.15, True),
        ("spindle_load", -0.4, 1.2, True),
        ("humidity", 0.31, 0.48, True),
        ("spindle_load", 0.0, 15.0, False),
        ("spindle_load", 0.0, 0.0, False),
        ("humidity", 31.0, 48.0, False),
    ],
)
def test_a_share_without_a_unit_that_stays_within_one_is_asked(name: str, low: float, high: float, asked: bool) -> None:
    said = guess(name, None, "float64", values_of(np.linspace(low, high, 360)))
    assert any("is 1 100 %" in q for q in said.questions) is asked
    assert said.unit == (None if asked else "%")


def test_of_a_share_of_one_1_is_100_per_cent() -> None:
    assert linear_conversion("pu", "%") == pytest.approx((100.0, 0.0))
    assert linear_conversion("%", "p.u.") == pytest.approx((0.01, 0.0))


@pytest.mark.parametrize("name", ["T(:,1)", "T(1, 2)"])
def test_the_index_of_an_array_is_no_unit(name: str) -> None:
    found = guess(name, None, "float64", values_of(np.linspace(20.0, 38.0, 200)))
    assert "no unit" not in found.comment()


def test_so_many_of_a_unit_in_brackets_are_named_in_the_question() -> None:
    found = guess("102 X drift (0.0001 in)", None, "float64", values_of(np.linspace(-0.56, 1.11, 60)))
    assert found.quantity == "displacement"
    assert [q for q in found.questions if q.startswith("unit:")] == [
        'unit: "0.0001 in"? the name says it, of each count, or as a range (values -0.56 to 1.11)'
    ]


@pytest.mark.parametrize(("name", "named"), [("X Abs (in)", "in"), ("X Abs (2)", None)])
def test_a_unit_in_brackets_is_named_where_nothing_tells_the_quantity(name: str, named: str | None) -> None:
    found = guess(name, None, "float64", values_of(np.linspace(1.9, 17.7, 60)))
    assert found.why_not is not None
    assert ("the name says" in found.why_not) is (named is not None)
    assert named is None or f"the name says '{named}'" in found.why_not
