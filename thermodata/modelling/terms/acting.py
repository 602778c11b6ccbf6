"""Effects that act in some phases only: heating has a function of its own, and cooling has ([horejs2010]).

Both run over the whole test, so that each knows its state; what counts is how much each moves while its phase lasts.
The sum of both then goes on from where the other one stopped, without a step.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.modelling.inputs.phases import activity, activity_is_known
from thermodata.plugin import Bool1D, Float2D
from thermodata.view.grid.dataset import TestData


def acting(test: TestData, phases: Sequence[str]) -> Bool1D | None:
    """Where the test is in one of the phases, shape (n,); None where nothing tells.

    Declared phases alone where there are any. Else heating (steady with it) is while the machine works, and cooling
    after it: told by drivers only, for an unseen log has no displacement.
    """
    out = np.zeros(len(test.t_s), bool)
    if test.phases:
        for name, (a, b) in test.phases.items():
            if name in phases:
                out |= (test.t_s >= a) & (test.t_s <= b)
        return out
    if not activity_is_known(test):
        return None
    working = activity(test)
    if working is None:
        return out
    if "heating" in phases or "steady" in phases:
        out |= working
    if "cooling" in phases:
        out |= ~working & (np.cumsum(working) > 0)
    return out


def moved_while(columns: Float2D, where: Bool1D) -> Float2D:
    """shape (n, gains): the columns' movement where the phase lasts; held elsewhere."""
    steps = np.diff(columns, axis=0, prepend=columns[:1])
    return np.asarray(np.cumsum(np.where(where[:, None], steps, 0.0), axis=0))
