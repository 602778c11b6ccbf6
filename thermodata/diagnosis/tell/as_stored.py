"""Where a model fails by the parameters that it has, as every other command says: the question itself is asked of a fit
to all tests, also those that came since."""

from __future__ import annotations

import math

from thermodata.diagnosis.question.weak import weak_spots
from thermodata.modelling.run import Loaded
from thermodata.schema.diagnosis import Diagnosis


def by_its_own_parameters(found: Diagnosis, stored: Loaded) -> Diagnosis:
    """The answer with weak spots of the model as the store holds it, on its tests as they are now."""
    response = next(r for r in stored.fitted.responses if r.name == found.response)
    tests = [t for t in stored.fitted.tests(stored.data) if response.can_predict(t)]
    noise = math.nan if found.noise_um is None else found.noise_um
    spots = weak_spots([(t, response.residual(t), response.mask(t)) for t in tests], noise)
    return found.model_copy(update={"weak_spots": spots})
