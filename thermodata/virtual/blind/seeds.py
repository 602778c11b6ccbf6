"""Which seeds a run may use: those for making rules, or those for judging a rule that is frozen; never both."""

from __future__ import annotations

from thermodata.errors import UsageError
from thermodata.virtual.truth.strata import DEVELOPMENT, SEALED


def seeds_of(first: int | None, count: int, sealed: bool) -> range:
    """Seeds from `first` (by default the set's own first). UsageError where one lies outside of the set."""
    allowed = SEALED if sealed else DEVELOPMENT
    start = allowed.start if first is None else first
    found = range(start, start + count)
    if found.start < allowed.start or found.stop > allowed.stop:
        other = "development" if sealed else "sealed"
        raise UsageError(
            f"seeds of the {other} set, or of none",
            expected=f"{allowed.start} to {allowed.stop - 1}, the {set_name(sealed)} set",
            got=f"{found.start} to {found.stop - 1}",
            hint="leave --sealed out"
            if sealed
            else "rules are made on development seeds; --sealed judges a frozen one",
        )
    return found


def set_name(sealed: bool) -> str:
    return "sealed" if sealed else "development"
