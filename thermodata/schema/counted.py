"""Counts and shares in words."""

from __future__ import annotations


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
