"""A mutant: one change of the code that a test must notice."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    """file: from the root of the checkout. old: text that stands in it exactly once. new: what takes its place.
    why: what would go wrong for a user. tests: what is run; paths from the root."""

    file: str
    old: str
    new: str
    why: str
    tests: tuple[str, ...]
