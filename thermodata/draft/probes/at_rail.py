"""A probe that shows nothing in any of its files: at the end of its range all along, or not connected. No jump test
could turn it, so none is asked for."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.draft.signals.values import Values

_LEAST = 100  # rows that show it
_ALIKE = 2e-4  # of its reading: what a converter adds at a rail; a probe that measures goes through more in one test


def at_rail(seen: Sequence[Values | None], unit: str | None) -> str | None:
    """What to ask of a probe whose files hold one reading, within a converter's noise; None of another. seen: its
    values in each of them; unit: of these."""
    known = [v for v in seen if v is not None]
    if not known or len(known) < len(seen) or sum(v.n for v in known) < _LEAST:
        return None
    low, high = min(v.low for v in known), max(v.high for v in known)
    if high - low > _ALIKE * max(abs(low), abs(high)):
        return None
    level = f"{known[0].median:.4g} {unit or ''}".rstrip()
    many = "all its files" if len(known) > 1 else "its file"
    return f"stands at {level} in {many}: at the end of its range, or not connected? then leave this line out"
