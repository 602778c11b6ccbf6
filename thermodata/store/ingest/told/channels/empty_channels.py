"""A channel without a single value in a test, while other tests have it: cells that slipped, a cable that was off."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from thermodata.schema.files.campaign import Campaign
from thermodata.schema.words.sentences import counted, with_count
from thermodata.store.ingest.known.left_alone import TestNote
from thermodata.store.ingest.told.losses import Losses, loss_row
from thermodata.store.tidy.plan.derive import names


def empty_channels(campaign: Campaign, tests: Mapping[str, TestNote]) -> Losses:
    """A loss for each that is not declared as missing; one that no test has a value of is none, for then nothing says
    that it should have some."""
    having: dict[tuple[str, str], list[str]] = {}
    for name, note in tests.items():
        empty = {channel for _, _, channel in note.empty}
        for source, _, channel, _ in note.channels if note.tidied else ():
            if channel not in empty:
                having.setdefault((source, channel), []).append(name)
    return _nothing_derived(campaign, tests, {channel for _, channel in having}) + [
        loss_row(
            f"channel '{channel}' has no value in the whole of {name}, and has in {_first_3(having[source, channel])}: "
            f"were cells shifted there? If it was not logged, say so: missing_in: [{name}]",
            test=name,
            source=source,
        )
        for name, note in tests.items()
        for source, _, channel in note.empty
        if (source, channel) in having and not campaign.channels[channel].may_lack(name)
    ]


def nothing_brought(campaign: Campaign, tests: Mapping[str, TestNote]) -> Losses:
    """A loss where files were read, and not one sample of them stands in the store."""
    files = {file for note in tests.values() for file in note.files}
    if not files or any(note.samples for note in tests.values()):
        return []
    of = f"{counted(len(files), 'file')} of {counted(len(tests), 'test')}"
    if not campaign.channels:
        return [
            loss_row(f"no sample of {of} is in the store: no channel is declared; try: answer the '# ?' below channels")
        ]
    names = list(campaign.channels)
    return [loss_row(f"no sample of {of} is in the store: none of the channels has a value in any: {_first_3(names)}")]


def _nothing_derived(campaign: Campaign, tests: Mapping[str, TestNote], having: Collection[str]) -> Losses:
    """A loss for each derived channel that no test has a value of, though they have values of all that it derives
    from: it divides by nothing."""
    empty = {channel for note in tests.values() if note.tidied for _, _, channel in note.empty}
    return [
        loss_row(
            f"channel '{name}': its derivation '{channel.derive}' gives no number in any test; try: correct 'derive', "
            "for its operands have values"
        )
        for name, channel in campaign.channels.items()
        if channel.derive is not None and name in empty - set(having) and names(channel.derive) <= set(having)
    ]


def _first_3(tests: list[str]) -> str:
    return with_count(tests, 3)
