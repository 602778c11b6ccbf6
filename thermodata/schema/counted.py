"""Counts and shares in words."""

from __future__ import annotations


def counted(n: int, one: str, does: str = "", do: str = "") -> str:
    """'1 row', '2 rows', '3 losses'. does, do: what one does, and several: '1 row stands', '2 rows stand'."""
    things = one if n == 1 else f"{one}{'es' if one.endswith('s') else 's'}"
    return " ".join(filter(None, (f"{n} {things}", does if n == 1 else do)))


def in_percent(share: float, digits: int = 0) -> str:
    """'15 %'."""
    return f"{100 * share:.{digits}f} %"
