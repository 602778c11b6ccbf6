"""A channel without a single value in a test, while other tests have it: cells that slipped, a cable that was off."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.schema.campaign import Campaign
from thermodata.store.ingest.left_alone import TestNote
from thermodata.store.ingest.losses import Losses, loss_row


def empty_channels(campaign: Campaign, tests: Mapping[str, TestNote]) -> Losses:
    """A loss for each that is not declared as missing; one that no test has a value of is none, for then nothing says
    that it should have some."""
    having: dict[tuple[str, str], list[str]] = {}
    for name, note in tests.items():
        empty = {channel for _, _, channel in note.empty}
        for source, _, channel, _ in note.channels if note.tidied else ():
            if channel not in empty:
                having.setdefault((source, channel), []).append(name)
    return [
        loss_row(
            f"channel '{channel}' has no value in the whole of {name}, and has in {_some(having[source, channel])}: "
            f"were cells shifted there? If it was not logged, say so: missing_in: [{name}]",
            test=name,
            source=source,
        )
        for name, note in tests.items()
        for source, _, channel in note.empty
        if (source, channel) in having and not campaign.channels[channel].may_lack(name)
    ]


def _some(tests: list[str]) -> str:
    return ", ".join(tests[:3]) + (f" and {len(tests) - 3} more" if len(tests) > 3 else "")
