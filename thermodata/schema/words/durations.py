"""How long something lasts, in the unit in which people say it."""

from __future__ import annotations

_UNITS = ((2 * 86400.0, 86400.0, "days"), (5400.0, 3600.0, "h"))  # from which length on, [s] of one, its name


def how_long(seconds: float) -> str:
    """'25 min', '74 min', '2.5 h', '4.7 days'. seconds: [s], none below 0."""
    one, name = next(((one, name) for least, one, name in _UNITS if seconds >= least), (60.0, "min"))
    return f"{seconds / one:.3g} {name}"
