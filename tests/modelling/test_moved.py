"""A channel that has another declared place in another campaign of a model is told."""

from __future__ import annotations

from dataclasses import replace

from thermodata.modelling.inputs.moved import said
from thermodata.view.grid.dataset import Dataset


def test_a_sensor_that_was_moved_between_campaigns_is_told(world: Dataset) -> None:
    there = []
    for k, test in enumerate(world.tests):
        bed = replace(test.channels["T_hall"], at="bed" if k < 4 else "column.rear")
        there.append(replace(test, campaign="spring" if k < 4 else "autumn", channels={**test.channels, "T_hall": bed}))
    data = replace(world, tests=tuple(there))
    (told,) = said(data, ["T_hall", "T_bearing", "dZ"])
    assert told.startswith("T_hall is at bed in spring, at column.rear in autumn: a sensor that was moved")
    assert said(data, ["T_bearing"]) == [], "what the model does not read is not told"
    assert said(world, ["T_hall"]) == []
