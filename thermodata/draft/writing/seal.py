"""A draft that can tell whether somebody has changed it since: its last line has a sum of the others."""

from __future__ import annotations

import hashlib

_SEAL = "# as drafted for as long as nothing above differs: "
_LENGTH = 12


def sealed(text: str) -> str:
    """The text with that line below."""
    return f"{text}{_SEAL}{_sum(text)}\n"


def is_as_sealed(text: str) -> bool:
    """Whether a text stands as it was drafted, whatever it was drafted from."""
    above, found, told = text.rpartition(_SEAL)
    return bool(found) and told.strip() == _sum(above)


def _sum(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:_LENGTH]
