"""What the library calls a cause: the table that answers are marked by, filled for each machine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

Mark = Literal["exact", "equivalent", "family", "wrong"]


@dataclass(frozen=True, slots=True)
class Right:
    """exact: (effect, channels in the order of its roles), the nearest first. equivalent: another effect whose channels
    are all among `drivers`, the cause's own, for the data of such a driver can't say how it acts. family: what the
    library files under the same heading, one of `families`. All else is wrong, and so is the right effect on a channel
    of another body. places: of the cause's sensors, where the library can hold it."""

    exact: tuple[tuple[str, tuple[str, ...]], ...]
    drivers: frozenset[str]
    families: frozenset[str]
    places: tuple[str, ...] = ()

    def mark(self, effect: str, channels: Sequence[str], family: str) -> Mark:
        """An effect on its channels against the cause."""
        if (effect, tuple(channels)) in self.exact:
            return "exact"
        if channels and self.drivers.issuperset(channels):
            return "equivalent"
        return "family" if family in self.families else "wrong"

    def among(self, twins: Iterable[str]) -> bool:
        """Whether the cause is named among ids (effect:channels) that a claim can't be told from."""
        split = [name.partition(":") for name in twins]
        return any(self.mark(effect, channels.split(","), "") == "exact" for effect, _, channels in split)

    def told_by(self, channel: str) -> bool:
        """Whether a channel alone names the cause, for methods that rank channels."""
        return channel in self.drivers or any(channel in channels for _, channels in self.exact)


Names = Mapping[str, Right]


def right(exact: Sequence[tuple[str, str]], drivers: str, families: str, places: Sequence[str] = ()) -> Right:
    """From words: channels with commas, drivers and families with blanks between."""
    pairs = tuple((effect, tuple(channels.split(","))) for effect, channels in exact)
    return Right(pairs, frozenset(drivers.split()), frozenset(families.split()), tuple(places))
