"""How a version of a model says what the one before leaves, fitted to the same tests: where it is made and told."""

from __future__ import annotations

from collections.abc import Iterable

THE_ONE_BEFORE = "the version before"
SAME_TESTS = f"fitted to the same tests, {THE_ONE_BEFORE}"
"""Begins the note."""
UNSEEN = f"{THE_ONE_BEFORE} was not fitted to all of these tests: part of the change is that they are fitted now"
"""Of a version that has no such note, for it was made by an older program, or is beside any other one."""


def note_on_the_same_tests(notes: Iterable[str]) -> str:
    """Of the notes of a version the one that `on_the_same_tests` made; '' where there is none."""
    return next((note for note in notes if note.startswith(SAME_TESTS)), "")
