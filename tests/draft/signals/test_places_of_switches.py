"""The place of a switch: as its name says, or asked, but for what a control says of itself."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.draft.files.sample import _take
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import Values, values_of
from thermodata.plugin import Block

ON_OFF = values_of(np.tile([0.0, 0.0, 1.0, 1.0], 20))


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("Pompe_lub", "lubrication"),
        ("Schmierpumpe", "lubrication"),
        ("Hydraulik Ein", "hydraulics"),
        ("coolant on", "coolant"),
        ("MQL on", "coolant"),
        ("Lüfter ein", "fan"),
        ("spindle_alarm", "spindle"),
        ("State", None),
        ("Alarm aktiv", None),
        ("AtProbe", None),  # it switches nothing
    ],
)
def test_a_switch_stands_where_its_name_says(name: str, at: str | None) -> None:
    said = guess(name, None, "float64", ON_OFF)
    assert (said.quantity, said.at, said.questions) == ("state", at, ())


@pytest.mark.parametrize(
    ("name", "at", "asked"),
    [
        ("Niebla activada", "coolant", "at: coolant, or lubrication"),
        ("Pumpe ein", "pump", "at: whose pump? coolant, hydraulics"),
        ("Abrichten aktiv", None, "at: what does it switch? e.g. coolant"),
        ("TripActive", None, "at: what does it switch?"),
    ],
)
def test_a_switch_whose_name_does_not_say_where_is_asked(name: str, at: str | None, asked: str) -> None:
    said = guess(name, None, "float64", ON_OFF)
    assert (said.quantity, said.at, said.sure) == ("state", at, False)
    assert said.questions[0].startswith(asked)


@pytest.mark.parametrize(("empty", "switch"), [(None, True), ("", True), (float("nan"), True), ("none", False)])
def test_an_empty_cell_keeps_no_words_from_being_a_switch(empty: object, switch: bool) -> None:
    found = values_of(np.array(["ON", empty, "OFF", "ON"] * 20, dtype=object))
    assert (found is not None and found.text and found.switch) is switch


@pytest.mark.parametrize("block", [("ON", None, "OFF"), (None, None, None)])
def test_a_block_of_empty_cells_keeps_no_words_from_being_a_switch(block: tuple[object, ...]) -> None:
    values: dict[tuple[str, str], Values] = {}
    worded: dict[tuple[str, str], frozenset[str]] = {}
    for cells in (("ON", "OFF", "ON"), block, ("OFF", "ON", "ON")):
        made = {"pump": np.array(cells, dtype=object)}
        _take(Block("main", np.arange(3), made), values, {}, set(), worded)
    assert values["main", "pump"].switch
    assert not worded
