"""Names that no other has: where one is taken, a number stands behind it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count


def numbered(name: str, is_taken: Callable[[str], bool], mark: str = "#") -> str:
    """The name, or the first of 'name#2', 'name#3', ... that is not taken. mark: what stands before the number."""
    if not is_taken(name):
        return name
    return next(found for n in count(2) if not is_taken(found := f"{name}{mark}{n}"))
