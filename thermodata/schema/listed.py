"""Names in a sentence: all of them, or the first few of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def listed(names: Sequence[str], last: str = "and") -> str:
    """'a', 'a and b', 'a, b and c'. last: the word before the last of several."""
    return f" {last} ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def with_count(names: Iterable[str], most: int, before: str = " and") -> str:
    """The first `most`, and how many there are beside them: 'a, b and 3 more'. before: what leads to the count."""
    shown, left = _parted(names, most)
    return shown + (f"{before} {left} more" if left > 0 else "")


def with_dots(names: Iterable[str], most: int) -> str:
    """The first `most`, and dots where there are others: 'a, b, ...'."""
    shown, left = _parted(names, most)
    return shown + (", ..." if left > 0 else "")


def _parted(names: Iterable[str], most: int) -> tuple[str, int]:
    every = list(names)
    return ", ".join(every[:most]), len(every) - most
