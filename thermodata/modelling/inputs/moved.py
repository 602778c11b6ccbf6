"""A sensor that stands elsewhere in another campaign of a model: one name, and two drivers."""

from __future__ import annotations

from collections.abc import Collection

from thermodata.schema.words.sentences import listed
from thermodata.view.grid.dataset import Dataset


def said(data: Dataset, names: Collection[str]) -> list[str]:
    """A note for each of the channels that has another declared place in another campaign."""
    notes = []
    for name in sorted(names):
        places: dict[str, list[str]] = {}
        for test in data.tests:
            info = test.channels.get(name)
            if info is not None and info.at is not None and test.campaign not in places.setdefault(info.at, []):
                places[info.at].append(test.campaign)
        if len(places) > 1:
            told = ", ".join(f"at {place} in {listed(campaigns)}" for place, campaigns in places.items())
            notes.append(
                f"{name} is {told}: a sensor that was moved is another driver, and one gain and time constant for both "
                "is of neither; give it another name there, or fit these campaigns apart"
            )
    return notes
