"""What a refinement refines, in words."""

from __future__ import annotations

from collections.abc import Sequence

PART = (
    "the model reads it already, together with others: another share of that, or a cause of its own, "
    "which these tests can't tell"
)
LITTLE = "it is little beside what the model has of that family"
HAS = "which the model has"
CANT_TELL = "these tests can't tell a cause of its own from that"
TRY = "add it, or confirm it on locked tests, to see what it takes away"


def mode_of(terms: Sequence[str], unmodelled: Sequence[str] = ()) -> str:
    """terms: ids of the effects of the model. unmodelled: ids of what it may be by a name, of whose heat the model has
    nothing."""
    of = f"{' and '.join(terms)}, {HAS}" if terms else "what the model has"
    if unmodelled and not terms:
        of = f"what the model reads at its place, though of the heat of {' and '.join(unmodelled)} it has nothing"
    return f"it is taken for another mode of {of}: {CANT_TELL} ({TRY})"


def elsewhere_of(terms: Sequence[str]) -> str:
    """terms: ids of the effects of the model that stand for the same cause, each by another sensor."""
    return (
        f"it is {' and '.join(terms)}, which the model has, by another sensor: what that part does otherwise than the "
        f"sensor of the model tells, or another such part ({TRY})"
    )


def by_kind(refines: str, left_out: str) -> str:
    """The same of what no other candidate is like in these tests, which do tell it apart: its kind makes it a mode.
    left_out: what the error on left-out tests does with it: 'from 1.20 to 0.635 um'."""
    told = f"{HAS}, by its kind: no other candidate does the same here, and with it the error on left-out tests goes "
    return refines.replace(f"{HAS}: {CANT_TELL}", f"{told}{left_out}")


def not_advised(refines: str, against: str) -> str:
    """The same without the advice to add it, where something speaks against that. against: what; '' where nothing
    does."""
    return f"{refines.removesuffix(f' ({TRY})')}; adding it is not advised, for {against}" if against else refines
