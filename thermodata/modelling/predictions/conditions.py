"""Logs that no campaign file describes, under conditions that are said of all of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from thermodata.view.grid.dataset import Dataset


def under(data: Dataset, conditions: Mapping[str, str | float]) -> Dataset:
    """The tests with these conditions beside their own, or in place of them; 'machine' is the machine's. A name may
    begin with 'conditions.', as gain_by has it."""
    more = {name.removeprefix("conditions."): value for name, value in conditions.items()}
    machine = more.pop("machine", None)
    tests = (
        replace(t, conditions={**t.conditions, **more}, machine=t.machine if machine is None else str(machine))
        for t in data.tests
    )
    return replace(data, tests=tuple(tests))
