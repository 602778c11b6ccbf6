"""Counts in words."""

from __future__ import annotations


def counted(n: int, one: str) -> str:
    """'1 row', '2 rows', '3 losses'."""
    return f"{n} {one}" if n == 1 else f"{n} {one}{'es' if one.endswith('s') else 's'}"
