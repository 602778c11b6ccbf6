"""The band of a prediction: what is left on tests that no fit has seen, the parameters, and the calibration.

    half^2 = (1.96 sd)^2 + (1.96 u y)^2 + (t s max(1, |y| / Y))^2

sd: of the parameters, carried to the prediction (`predictions.bands`). u: of the probe's sensitivity, a factor on all.
s: root mean square of what is left on unseen tests, each from its first samples, as a prediction is; t: of Student's
distribution with as many degrees of freedom as what is left there has independent values, one a test at least. Y: the
largest that the model predicts in any open test: beyond it what is left is taken to grow in proportion.

Source: docs/model.md#the-band-of-a-prediction
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.compare.left_out_error import LeftOut, counts
from thermodata.modelling.inputs.roles import Key, in_full
from thermodata.modelling.model_file.nested import ModelOutput
from thermodata.modelling.predictions.predict import Predicted
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.trust.memory import effective_count
from thermodata.plugin import Float1D
from thermodata.schema.agreed.certainty import Z95
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

ENOUGH = 3  # verification tests that took no part; of fewer, each open test is left out in turn instead
FEWEST = 2  # tests that say what is left


@dataclass(frozen=True, slots=True)
class UnseenError:
    """What is left of a response on unseen tests. rms: in its unit, each test alike; reach: the largest prediction in
    the open ones; refitted: they were left out in turn, else they are verification tests; worth: independent values."""

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

    left: Mapping[str, UnseenError]
    scale: Mapping[str, float]
    machines: tuple[str, ...]
    why_not: str | None = None

    def elsewhere(self, p: Predicted) -> bool:
        """Whether it is of another machine, of which the tests of the model say nothing."""
        return not _is_one_of(p.machine, self.machines)

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
    left: dict[str, UnseenError] = {}
    reach = {r.name: _reach(r, fitted.tests(data)) for r in fitted.responses}
    for response in fitted.responses:
        apart = [t for t in fitted.tests(data, "verification") if _took_no_part(fitted, response, t, machines)]
        if len(apart) >= ENOUGH:
            left[response.name] = _unseen_error([(response, t) for t in apart], reach[response.name], refitted=False)
    if len(left) < len(fitted.responses):
        try:
            unseen = list(LeftOut(_of_own_machine(fitted, data, machines), data).unseen(fitted.spec))
        except UsageError as error:
            return Ahead({}, scale, machines, f"the model can't be fitted without one of its tests ({error.what})")
        for name in (r.name for r in fitted.responses if r.name not in left):
            own = [
                (r, t)
                for r, t in unseen
                if r.name == name and t.key not in _tests_seen(r) and _is_one_of(t.machine, machines)
            ]
            if len(own) >= FEWEST:
                left[name] = _unseen_error(own, reach[name], refitted=True)
    few = f"fewer than {FEWEST} open tests say what the model leaves on one that it has not seen"
    return Ahead(left, scale, machines, None if left else few)


def _took_no_part(fitted: FittedModel, response: FittedResponse, test: TestData, machines: Sequence[str]) -> bool:
    seen = any(test.key in _tests_seen(r) for r in fitted.responses) or test.key in fitted.overlaps
    return not seen and _is_one_of(test.machine, machines) and counts(response, test)


def _tests_seen(response: FittedResponse) -> frozenset[Key]:
    """The tests that its parameters come from, those of a model inside too."""
    inside = [t.effect.response for t in response.terms if isinstance(t.effect, ModelOutput)]
    return response.fitted_on.union(*map(_tests_seen, inside))


def _is_one_of(machine: str, machines: Sequence[str]) -> bool:
    """Or may be: where none is known, all are one."""
    return not (machines and machine) or machine in machines


def _of_own_machine(fitted: FittedModel, data: Dataset, machines: Sequence[str]) -> Model:
    """The model without what it is only verified on elsewhere."""
    own = [key for key in fitted.roles.verify if _is_one_of(data.test(*key).machine, machines)]
    roles = {"calibrate_on": in_full(fitted.roles.calibrate), "verify_on": in_full(own)}
    return fitted.spec.model_copy(update=roles)


def _reach(response: FittedResponse, tests: Iterable[TestData]) -> float:
    """The largest prediction in the open tests."""
    sizes = (np.abs(response.predict(t)[response.mask(t)]).max() for t in tests if counts(response, t))
    return max(map(float, sizes), default=0.0)


def _unseen_error(unseen: Sequence[tuple[FittedResponse, TestData]], reach: float, refitted: bool) -> UnseenError:
    found = [_error_in_unseen(response, test) for response, test in unseen]
    squares, worth = np.array([one.square for one in found]), np.array([one.worth for one in found])
    return UnseenError(
        unseen[0][0].unit,
        float(np.sqrt(np.mean(squares))),
        max(reach, *(one.reach for one in found)),
        tuple(one.test for one in found),
        refitted,
        values_worth(squares, worth),
    )


def values_worth(squares: Float1D, worth: Float1D) -> float:
    """How many independent values say the mean of some mean squares, each of so many ([satterthwaite1946])."""
    return float(squares.sum() ** 2 / np.sum(squares**2 / worth)) if squares.any() else float(worth.sum())


class _Unseen(NamedTuple):
    """square: mean square of what is left, from the test's first samples; reach: the largest prediction; worth: how
    many independent values."""

    test: str
    square: float
    reach: float
    worth: float


def _error_in_unseen(response: FittedResponse, test: TestData) -> _Unseen:
    mask, predicted = response.mask(test), response.predict(test)
    gap = (response.measured(test) - predicted - response.offset(test, "zero"))[mask]
    worth = effective_count(gap, [slice(0, len(gap))])
    return _Unseen(test.test, float(np.mean(gap**2)), float(np.abs(predicted[mask]).max()), worth)
