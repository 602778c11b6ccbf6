"""How a version of a model says which tests it is made without, where it is made and where it is told."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

MADE_WITHOUT = "made without"
"""Begins the note of each test that is left out, before its id."""


def still_without(chain: Iterable[Sequence[str]], fitted: Collection[str]) -> list[str]:
    """The notes of tests that a version, or one that it came from, was made without, each test once and the last note
    of it; not of those that are back. chain: notes of each version, oldest first. fitted: names of its tests now."""
    of_test = {_test(note): note for notes in chain for note in notes if note.startswith(MADE_WITHOUT)}
    return [note for test, note in of_test.items() if test not in fitted]


def _test(note: str) -> str:
    return note.removeprefix(MADE_WITHOUT).partition(":")[0].strip()
