"""A log of changes that somebody wrote by hand, whose values are none that anybody sets: asked whether they stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.store.tidy.rows.on_change import BY_HAND, DENSER, written_by_hand

_HELD = "held: true, or false? its rows lie far apart beside a log that is much denser: does each stand until the next"


def asked_whether_held(channels: Sequence[DraftChannel], group: Group, groups: Sequence[Group]) -> list[DraftChannel]:
    """The channels of a source, with a question where `ingest` would draw ramps between what somebody wrote down."""
    return [_asked(c, group, groups) if c.said.quantity in BY_HAND else c for c in channels]


def _asked(channel: DraftChannel, group: Group, groups: Sequence[Group]) -> DraftChannel:
    for test, files in group.tests.items():
        own = {id(f) for f in files}
        beside = [f for g in groups for f in g.tests.get(test, ()) if id(f) not in own]
        if any(_is_asked(channel, f, beside) for f in files):
            said = channel.said
            return replace(channel, said=replace(said, sure=False, questions=(*said.questions, _HELD)))
    return channel


def _is_asked(channel: DraftChannel, file: RawFile, beside: Sequence[RawFile]) -> bool:
    course = next(
        (c for (stream, name), c in file.sample.courses.items() if channel.signal in (name, f"{stream}:{name}")), None
    )
    if course is None or any(s.held for s in file.signals):
        return False
    denser = [step for f in beside if f.sample.rows > DENSER * file.sample.rows and (step := _step_ns(f)) > 0]
    told = written_by_hand(channel.said.quantity or "", course.t_ns, course.values, min(denser, default=0))
    return told == "asked"


def _step_ns(file: RawFile) -> int:
    """Between two rows of a file, as far as it was looked at."""
    s = file.sample
    return 0 if s.first_ns is None or s.last_ns is None else (s.last_ns - s.first_ns) // max(1, s.rows - 1)
