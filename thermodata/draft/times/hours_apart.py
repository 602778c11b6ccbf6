"""Two logs that tell times of day without a date and begin whole hours apart: in two zones, or at two times."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.reader.times.step_back import in_words
from thermodata.store.tidy.clock.times_of_day import apart_ns, first_of, hours_apart


def hours_question(group: Group, groups: Sequence[Group]) -> str | None:
    """What to ask of a source beside one that stands before it; None where they begin together or at other minutes."""
    for other in groups[: next(k for k, g in enumerate(groups) if g is group)]:
        for test, files in group.tests.items():
            own, there = _of_day_ns(files), _of_day_ns(other.tests.get(test, ()))
            if own is None or there is None or not hours_apart(by := apart_ns(own, there)):
                continue
            return (
                f"when did it begin? it tells times of day without a date, and begins {in_words(by)} "
                f"{'after' if by > 0 else 'before'} '{other.source}' in {test} by them: timezone: Europe/Prague here "
                "and there where both clocks show one time, or clock: {offset: 0 s} if they begin together"
            )
    return None


def _of_day_ns(files: Sequence[RawFile]) -> int | None:
    return first_of([f.recording.of_day_ns if f.recording.is_undated else None for f in files])
