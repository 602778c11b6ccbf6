"""What a stratum is, and which seeds are for making rules and which for judging one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

# Rules of the diagnosis are made on the first seeds only. The others are opened once a rule is frozen, so that a figure
# of theirs is worth something; whoever has tuned on one has spent it, and moves SEALED on.
DEVELOPMENT = range(0, 100_000)
SEALED = range(200_000, 300_000)


@dataclass(frozen=True, slots=True)
class Stratum:
    """hidden: how many causes the model lacks; more: others beside them, as many as are drawn. strength: times the
    usual size. base: what the model knows; "either" is drawn. tests: open ones; locked ones come beside them. The rest:
    what is wrong with the logs."""

    meaning: str
    hidden: int = 1
    more: bool = False
    strength: float = 1.0
    base: Literal["thin", "full", "either"] = "either"
    tests: int = 8
    idle: bool = False
    decoy: bool = False
    blind: bool = False
    outside: bool = False
    sensor_fault: bool = False
    steps: bool = False
    staircase: bool = False
    coarse: bool = False
    gaps: bool = False
    clock: bool = False
