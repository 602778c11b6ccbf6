"""The kinds of machine and laboratory that the diagnosis is judged on, one difficulty each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

# Rules of the diagnosis are made on the first seeds only. The others are opened once a rule is frozen, so that a figure
# of theirs is worth something; whoever has tuned on one has spent it, and moves SEALED on.
DEVELOPMENT = range(0, 100_000)
SEALED = range(200_000, 300_000)


@dataclass(frozen=True, slots=True)
class Stratum:
    """hidden: how many causes the model lacks. strength: times the usual size. base: what the model knows; "either"
    is drawn. tests: open ones; locked ones come beside them. The rest: what is wrong with the logs."""

    meaning: str
    hidden: int = 1
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


STRATA: Mapping[str, Stratum] = {
    "strong": Stratum("one cause hidden, 5 to 12 um in its best test"),
    "weak_half": Stratum("one hidden, half as strong", strength=0.5),
    "weak_quarter": Stratum("one hidden, a quarter as strong", strength=0.25),
    "decoy": Stratum("one hidden; a logged channel goes with its sensor above 0.97", decoy=True),
    "two": Stratum("two hidden", hidden=2),
    "three": Stratum("three hidden", hidden=3),
    "none_thin": Stratum("nothing hidden, the model knows one cause", hidden=0, base="thin"),
    "none_full": Stratum("nothing hidden, the model knows four causes", hidden=0, base="full"),
    "not_logged": Stratum("one hidden, none of its sensors logged", blind=True),
    "outside": Stratum("one hidden that no lag of a channel can hold", outside=True),
    "sensor_fault": Stratum("one hidden; another temperature breaks", sensor_fault=True),
    "steps": Stratum("one hidden or, in half, none; the probe slips by 3 to 16 um", steps=True),
    "tests_3": Stratum("one hidden, 3 open tests", tests=3),
    "tests_5": Stratum("one hidden, 5 open tests", tests=5),
    "tests_16": Stratum("one hidden, 16 open tests", tests=16),
    "idle": Stratum("one hidden, 7 of 10 tests idle", idle=True),
    "staircase": Stratum("one hidden, displacement in treads of 2 um", staircase=True),
    "coarse": Stratum("one hidden, every temperature in steps of 1 K", coarse=True),
    "gaps": Stratum("one hidden, every logger has gaps", gaps=True),
    "clock": Stratum("one hidden, the control's clock is off by 2 to 8 min", clock=True),
}
