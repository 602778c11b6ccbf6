"""Weak spots of a model, by response: also for models that were never diagnosed."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from thermodata.schema.answers.diagnosis import WeakSpot

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.schema.answers.diagnosis import Diagnosis


def weak_spots_of(loaded: Loaded, diagnoses: Iterable[Diagnosis | None]) -> dict[str, list[WeakSpot]]:
    """Response -> weak spots, costliest first. diagnoses: of the model or its ancestors, for the noise they found.

    Tests that are not locked only.
    """
    from thermodata.diagnosis.question.weak import weak_spots

    noises = {d.response: d.noise_um for d in diagnoses if d is not None and d.noise_um is not None}
    tests = loaded.fitted.tests(loaded.data)
    return {
        r.name: weak_spots(
            [(t, r.residual(t), r.mask(t)) for t in tests if r.can_predict(t)], noises.get(r.name, math.nan)
        )
        for r in loaded.fitted.responses
    }
