"""Flags of columns that are too many to be held side by side: kept as the rows at which they change."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array


@dataclass(slots=True)
class Changes:
    """By channel the rows at which its flags change, and the flags from there on. Pieces are added in the order of
    their rows, then joined once."""

    _pieces: dict[str, tuple[list[Array], list[Array]]] = field(default_factory=dict)
    _joined: dict[str, tuple[Array, Array]] = field(default_factory=dict)

    def __contains__(self, name: str) -> bool:
        return name in self._joined

    def add(self, name: str, first: int, flags: Array) -> None:
        """flags: shape (n,), of the rows from `first` on."""
        at = np.concatenate([[0], np.flatnonzero(flags[1:] != flags[:-1]) + 1])
        rows, kept = self._pieces.setdefault(name, ([], []))
        rows.append(first + at)
        kept.append(flags[at])

    def join(self) -> None:
        """All pieces of a channel as one; what is added later is not seen."""
        self._joined = {n: (np.concatenate(rows), np.concatenate(kept)) for n, (rows, kept) in self._pieces.items()}
        self._pieces.clear()

    def between(self, name: str, start: int, stop: int) -> Array:
        """The flags of a channel in the rows from start to stop, shape (stop - start,)."""
        at, flags = self._joined[name]
        low, high = int(np.searchsorted(at, start, side="right")) - 1, int(np.searchsorted(at, stop))
        lengths = np.diff(np.concatenate([[start], at[low + 1 : high], [stop]]))
        return np.repeat(flags[low:high], lengths)
