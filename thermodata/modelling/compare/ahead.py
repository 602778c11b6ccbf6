"""The band of a prediction: what is left on tests that no fit has seen, the parameters, and the calibration.

    half^2 = (1.96 sd)^2 + (1.96 u y)^2 + (t s max(1, |y| / Y))^2

sd: of the parameters, carried to the prediction (`predictions.bands`). u: of the probe's sensitivity, a factor on all.
s: root mean square of what is left on unseen tests, each from its first samples, as a prediction is; t: of Student's
distribution with as many degrees of freedom as what is left there has independent values, one a test at least. Y: the
largest that the model predicted in them: beyond it what is left is taken to grow in proportion.

Source: docs/model.md#the-band-of-a-prediction
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.compare.left_out_error import LeftOut, counts
from thermodata.modelling.predictions.predict import Predicted
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.trust.memory import effective_count
from thermodata.plugin import Float1D
from thermodata.schema.agreed.certainty import Z95
from thermodata.view.grid.dataset import Dataset, TestData

ENOUGH = 3  # verification tests that took no part; of fewer, each open test is left out in turn instead
FEWEST = 2  # tests that say what is left


@dataclass(frozen=True, slots=True)
class Left:
    """What is left of a response on unseen tests. rms: in its unit, each test alike; reach: the largest prediction in
    them; refitted: they were left out in turn, else they are verification tests; worth: independent values."""

    unit: str
    rms: float
    reach: float
    tests: tuple[str, ...]
    refitted: bool
    worth: float

    @property
    def times(self) -> float:
        """Half of an interval of 95 %, in standard deviations that are known from so many values."""
        from scipy.special import stdtrit

        return float(stdtrit(self.worth, 0.975))

    def half(self, predicted: Float1D) -> Float1D:
        return self.times * self.rms * np.maximum(1.0, np.abs(predicted) / max(self.reach, 1e-9))


@dataclass(frozen=True, slots=True)
class Ahead:
    """What a band is made of. left: response -> what is left of it; scale: response -> standard uncertainty of its
    calibration, as a share. machines: that the model was fitted to. why_not: why there is no band."""

    left: Mapping[str, Left]
    scale: Mapping[str, float]
    machines: tuple[str, ...]
    why_not: str | None = None

    def elsewhere(self, p: Predicted) -> bool:
        """Whether it is of another machine, of which the tests of the model say nothing."""
        return bool(p.machine and self.machines) and p.machine not in self.machines

    def of(self, p: Predicted) -> Predicted:
        """The prediction with its band, where that is known."""
        left = self.left.get(p.response)
        if self.why_not is not None or left is None or p.deviation is None or self.elsewhere(p):
            return p
        scale = self.scale.get(p.response, 0.0)
        square = (Z95 * p.deviation) ** 2 + (Z95 * scale * p.predicted) ** 2 + left.half(p.predicted) ** 2
        return replace(p, half=np.sqrt(square))


def ahead(fitted: FittedModel, data: Dataset, *, kept: bool = False) -> Ahead:
    """data: of the model. kept: its parameters are those of other data, and how they spread is not known."""
    scale = {r.name: r.scale for r in fitted.responses}
    seen = {key for r in fitted.responses for key in r.fitted_on}
    machines = tuple(dict.fromkeys(t.machine for t in data.tests if t.key in seen and t.machine))
    if kept:
        return Ahead(
            {}, scale, machines, "the data changed since the model was fitted, and with them what its tests say of it"
        )
    left: dict[str, Left] = {}
    for response in fitted.responses:
        apart = [t for t in fitted.tests(data, "verification") if _took_no_part(fitted, response, t)]
        if len(apart) >= ENOUGH:
            left[response.name] = _left([(response, t) for t in apart], refitted=False)
    if len(left) < len(fitted.responses):
        try:
            unseen = list(LeftOut(fitted.spec, data).unseen(fitted.spec))
        except UsageError as error:
            return Ahead({}, scale, machines, f"the model can't be fitted without one of its tests ({error.what})")
        for name in (r.name for r in fitted.responses if r.name not in left):
            own = [(r, t) for r, t in unseen if r.name == name]
            if len(own) >= FEWEST:
                left[name] = _left(own, refitted=True)
    few = f"fewer than {FEWEST} open tests say what the model leaves on one that it has not seen"
    return Ahead(left, scale, machines, None if left else few)


def _took_no_part(fitted: FittedModel, response: FittedResponse, test: TestData) -> bool:
    seen = any(test.key in r.fitted_on for r in fitted.responses) or test.key in fitted.overlaps
    return not seen and counts(response, test)


def _left(unseen: Sequence[tuple[FittedResponse, TestData]], refitted: bool) -> Left:
    found = [*_errors(unseen)]
    return Left(
        unseen[0][0].unit,
        float(np.sqrt(np.mean([square for _, square, _, _ in found]))),
        max(reach for _, _, reach, _ in found),
        tuple(name for name, _, _, _ in found),
        refitted,
        sum(worth for _, _, _, worth in found),
    )


def _errors(unseen: Iterable[tuple[FittedResponse, TestData]]) -> Iterator[tuple[str, float, float, float]]:
    """(test, mean square of what is left, largest prediction, independent values), each from its first samples."""
    for response, test in unseen:
        mask = response.mask(test)
        predicted = response.predict(test)
        gap = (response.measured(test) - predicted - response.offset(test, "zero"))[mask]
        yield (
            test.test,
            float(np.mean(gap**2)),
            float(np.abs(predicted[mask]).max()),
            effective_count(gap, [slice(0, len(gap))]),
        )
