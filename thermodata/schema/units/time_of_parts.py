"""A time as people say it, in several parts: '1 h 30 min', '-61365 h 1 s'."""

from __future__ import annotations

import re

_SECONDS = {"d": 86400.0, "h": 3600.0, "min": 60.0, "s": 1.0}
_PARTS = " ?".join(rf"(?:(\d+(?:\.\d+)?) ?{unit}(?![^\W\d_]))?" for unit in _SECONDS)
_TEXT = re.compile(rf"([+-]?) ?{_PARTS}")  # of a text whose blanks are single ones, or many blanks take it for ever


def time_of_parts(text: str | float | int) -> float | None:
    """The time [s], whose sign is that of all parts; None of anything else, and of a single part."""
    match = _TEXT.fullmatch(" ".join(text.split())) if isinstance(text, str) else None
    if match is None:
        return None
    parts = [float(n) * one_s for n, one_s in zip(match.groups()[1:], _SECONDS.values(), strict=True) if n]
    if len(parts) < 2:
        return None
    return -sum(parts) if match[1] == "-" else sum(parts)
