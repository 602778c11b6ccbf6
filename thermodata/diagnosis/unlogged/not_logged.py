"""How probable it is that nothing logged reads the cause of what is left."""

from __future__ import annotations

import numpy as np

# a logistic curve over the share of the squared error that the best candidate takes away by itself, of answers that
# name nothing, where the causes of one machine in five are not logged (docs/missing_heat.md)
NOT_LOGGED = (1.3, -3.9)


def not_logged(explainable: float | None, likeliest: float) -> float | None:
    """That no channel reads what is missing; None where no candidate was weighed. What is heated elsewhere goes with
    nothing that is logged, while a cause that cannot be told from others, or hardly acts, has channels that take much
    of the error away.

    explainable: the largest fall of the squared error that one candidate gives, 0 to 1. likeliest: the probability of
    the likeliest cause that was logged, which leaves the rest at most.
    """
    if explainable is None:
        return None
    level, by_fall = NOT_LOGGED
    return min(float(1 / (1 + np.exp(-(level + by_fall * explainable)))), 1 - likeliest)
