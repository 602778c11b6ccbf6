"""The kinds of lathe and laboratory that the diagnosis is judged on, one difficulty each."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.virtual.truth.strata import Stratum

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
