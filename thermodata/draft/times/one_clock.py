"""The clocks of sources on that of one of them, by what was guessed of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from thermodata.draft.times.clocks import Alignment


@dataclass(frozen=True, slots=True)
class OneClock:
    """of: the source whose clock it is; shift_ns: what turns times of another one to it."""

    of: str
    shift_ns: int = 0

    def to(self, other: OneClock) -> int | None:
        """What turns times of this source to those of another [ns]; None where nobody knows, or they are the same."""
        known = self.of == other.of and self.shift_ns != other.shift_ns
        return self.shift_ns - other.shift_ns if known else None


def on_one_clock(sources: Iterable[str], aligned: Mapping[str, Alignment]) -> dict[str, OneClock]:
    """Source -> its clock. aligned: source -> what is guessed of it, where something is."""
    return {source: _clock(source, aligned) for source in sources}


def _clock(source: str, aligned: Mapping[str, Alignment]) -> OneClock:
    shift_s, at = 0.0, source
    seen = {source}
    while (found := aligned.get(at)) is not None and found.offset_s is not None and found.there not in seen:
        shift_s += found.offset_s
        at = found.there
        seen.add(at)
    return OneClock(at, round(shift_s * 1e9))
