"""What tests show of a machine that decides which effects are asked."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Seen:
    """telling: positions that make steps where they go from one place to another. at_rest: temperatures of tables that
    are as warm where nothing turns them. feedback: axis -> what closes its loop, where that is declared."""

    telling: Container[str] = ()
    at_rest: Container[str] = ()
    feedback: Mapping[str, str] = field(default_factory=dict)


NOTHING = Seen()
