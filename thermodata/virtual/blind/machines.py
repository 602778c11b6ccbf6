"""The machines that the diagnosis is judged on. A stratum's name is of one machine only, so that it says which."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from thermodata.virtual.gantry import case as gantry
from thermodata.virtual.lathe import case as lathe
from thermodata.virtual.lathe import strata as lathes
from thermodata.virtual.truth.case import Case
from thermodata.virtual.truth.strata import Stratum

MACHINES: Mapping[str, Mapping[str, Stratum]] = {"lathe": lathes.STRATA, "gantry": gantry.STRATA}
STRATA: Mapping[str, Stratum] = {**lathes.STRATA, **gantry.STRATA}
_CASES: Mapping[str, Callable[[str, int], Case]] = {
    **dict.fromkeys(lathes.STRATA, lathe.case_of),
    **dict.fromkeys(gantry.STRATA, gantry.case_of),
}


def case_of(stratum: str, seed: int) -> Case:
    """The machine of a seed in a stratum of any machine."""
    return _CASES[stratum](stratum, seed)
