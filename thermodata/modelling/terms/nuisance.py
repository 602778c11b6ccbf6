"""What nobody knows of a test and no effect may explain: its offset, and how warm it was when it began warm.

Both are taken out of the response and of every column alike, which is to say that they are fitted freely, each test by
itself. Weights of samples go the same way, as their square roots.
"""

from __future__ import annotations

import numpy as np

from thermodata.errors import unknown_name
from thermodata.modelling.inputs.phases import TOLD, phases
from thermodata.modelling.terms.bound import PLACE, BoundResponse
from thermodata.plugin import Bool1D, Float1D, Float2D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

WARM = "warm"
# a machine that was not at rest fades as its own time constants, which are not known before the fit; these span what a
# machine has, and a decay between two of them is within 2 % of their sum
DECAYS_S = (600.0, 1500.0, 3750.0, 9375.0, 23437.0)


def unknown_start(test: TestData, t_s: Float1D) -> Float2D:
    """What fades from the start of a test that began warm, at some of its times [s], shape (m, decays); (m, 0) of one
    that began at balance."""
    taus = DECAYS_S if test.start_state == WARM else ()
    return np.asarray(np.exp(-(t_s - test.t_s[0])[:, None] / np.asarray(taus).reshape(1, -1)), dtype=np.float64)


class Nuisance:
    """Of one test, on the samples that count, shape (m,)."""

    def __init__(self, test: TestData, mask: Bool1D, bound: BoundResponse) -> None:
        self.root = _root_weights(test, mask, bound)
        self.free: Float2D | None = None
        if test.start_state == WARM and mask.sum() > len(DECAYS_S) + 1:
            free = np.column_stack([np.ones(mask.sum()), unknown_start(test, test.t_s[mask])])
            self.free = np.linalg.qr(free if self.root is None else free * self.root[:, None])[0]

    def without(self, values: Float2D) -> Float2D:
        """values, shape (m,) or (m, k), without the test's offset (and start), times the roots of the weights."""
        if not len(values):
            return values
        if self.root is None and self.free is None:
            # the sum that a mean is made of, without what numpy asks first: some ten thousand times a fit
            return np.asarray(values - np.add.reduce(values, axis=0) / len(values))
        root = 1.0 if self.root is None else self.root if values.ndim == 1 else self.root[:, None]
        scaled = values * root
        if self.free is not None:
            return np.asarray(scaled - self.free @ (self.free.T @ scaled))
        assert self.root is not None
        unit = self.root / np.sqrt(self.root @ self.root)
        return np.asarray(scaled - (unit if values.ndim == 1 else unit[:, None]) * (unit @ scaled))


def known_weights(spec: Model, data: Dataset) -> None:
    """Refuses weights that belong to nothing: SpecError names the nearest test or phase."""
    tests = {name for t in data.tests for name in (t.test, f"{t.campaign}/{t.test}")}
    names = tests | {p for t in data.tests for p in t.phases} | set(TOLD)
    for name in spec.weights:
        if name not in names:
            raise unknown_name("test or phase", name, sorted(names), where=f"model '{spec.name}': weights")


def _root_weights(test: TestData, mask: Bool1D, bound: BoundResponse) -> Float1D | None:
    """sqrt(weight) of the samples that count, shape (m,); None where all weigh 1."""
    if not bound.weights:
        return None
    own = next((bound.weights[n] for n in (f"{test.campaign}/{test.test}", test.test) if n in bound.weights), 1.0)
    weights = np.full(len(test.t_s), float(own))
    response = bound.channel_of(test) if PLACE not in test.conditions else bound.name
    for name, inside in phases(test, response).items():
        weights[inside] *= bound.weights.get(name, 1.0)
    # a test without any weight would have no offset
    return np.asarray(np.maximum(np.sqrt(weights[mask]), 1e-9))
