"""Names, counts and shares in a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

A_HAIR = 0.02  # of a limit: what misses it by no more was decided by little


def listed(names: Sequence[str], last: str = "and") -> str:
    """'a', 'a and b', 'a, b and c'. last: the word before the last of several."""
    return f" {last} ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def with_count(names: Iterable[str], most: int, before: str = " and") -> str:
    """The first `most`, and how many there are beside them: 'a, b and 3 more'. before: what leads to the count."""
    shown, left = _shown_and_left(names, most)
    return shown + (f"{before} {left} more" if left > 0 else "")


def with_dots(names: Iterable[str], most: int) -> str:
    """The first `most`, and dots where there are others: 'a, b, ...'."""
    shown, left = _shown_and_left(names, most)
    return shown + (", ..." if left > 0 else "")


def counted(n: int, one: str, does: str = "", do: str = "") -> str:
    """'1 row', '2 rows', '3 losses'. does, do: what one does, and several: '1 row stands', '2 rows stand'."""
    things = one if n == 1 else f"{one}{'es' if one.endswith('s') else 's'}"
    return " ".join(filter(None, (f"{n} {things}", does if n == 1 else do)))


def in_percent(share: float, digits: int = 0) -> str:
    """'15 %'."""
    return f"{100 * share:.{digits}f} %"


def apart(value: float, limit: float) -> str:
    """'14.9 %' beside a limit of 15 %: with as many digits as tell the two."""
    texts = [in_percent(value, digits) for digits in range(3)]
    return next((t for digits, t in enumerate(texts) if t != in_percent(limit, digits)), texts[0])


def beside(value: float, limit: float, digits: int = 0) -> str:
    """'limit 65 %', behind a value that misses it; 'just under the limit of 65 %' where it does so by a hair."""
    said = in_percent(limit, digits)
    if abs(value - limit) > A_HAIR * abs(limit) * (1 + 1e-9):
        return f"limit {said}"
    return f"just {'under' if value < limit else 'over'} the limit of {said}"


def _shown_and_left(names: Iterable[str], most: int) -> tuple[str, int]:
    every = list(names)
    return ", ".join(every[:most]), len(every) - most
