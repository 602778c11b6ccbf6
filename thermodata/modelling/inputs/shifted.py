"""Drivers whose sensor is off by one number through a test: they count from the test's start, and so are read."""

from __future__ import annotations

from collections.abc import Collection

from thermodata.view.grid.dataset import Dataset


def said(data: Dataset, names: Collection[str]) -> list[str]:
    """What is read as it stands though it is flagged, in a sentence a channel."""
    tests = {n: [t.test for t in data.tests if n in t.channels and t.channels[n].shifted] for n in sorted(names)}
    return [
        f"{name} is flagged 'offset' through all of {', '.join(some)}, by one number: a driver counts from the test's "
        "start, so it is read there as it stands"
        for name, some in tests.items()
        if some
    ]
