"""The zone of a test's start, which is a local time of its source: what is asked where logs have no times of their own
that would ask it."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.times.zone_of_names import named_zone


def zone_of_start_question(group: Group, groups: Sequence[Group], started: Collection[str]) -> str | None:
    """What to ask of a source without dates, whose zone is that of starts; None where another source of its tests is
    asked. started: tests with a start that names no offset."""
    test = next((t for t in group.tests if t in started and _is_asked(group, t, groups)), None)
    if test is None:
        return None
    likely = named_zone(None, [f.path for f in group.files])
    return f"timezone? the start of {test} is a local time, and names no zone; taken as UTC. {likely}"


def _is_asked(group: Group, test: str, groups: Sequence[Group]) -> bool:
    of_test = [g for g in groups if test in g.tests]
    if any(f.local for g in of_test for f in g.files):
        return False
    return group is next((g for g in of_test if all(f.recording.is_undated for f in g.tests[test])), None)
