"""What an ingest says of tests that the store held and the campaign file no longer has."""

from __future__ import annotations

from collections.abc import Collection

from thermodata.schema.words.sentences import with_count

_NAMED = 4


def taken_out(tests: Collection[str]) -> list[str]:
    """One note on all of them; none where there are none."""
    if not tests:
        return []
    logs, them, they = ("its logs are", "it", "it is") if len(tests) == 1 else ("their logs are", "them", "they are")
    return [
        f"no longer in the campaign file: {with_count(sorted(tests), _NAMED)}; {logs} out of the store, and what "
        f"models said of {them} stays in their results, for when {they} back"
    ]
