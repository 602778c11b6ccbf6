"""The error of a model on tests that its fit had not seen: each open test is left out in turn, locked ones never."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.fit.orders import leaves_open
from thermodata.modelling.inputs.roles import Key, in_full, resolve_roles
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset, TestData

FOLDS = 6  # more tests than that are left out in groups
Place = tuple[str, Key]
"""A response, and a test of it."""
_Fold = tuple[Sequence[Key], Sequence[Key]]  # the tests that are fitted, and those that are left out


@dataclass(frozen=True, slots=True)
class Errors:
    """Of each response in each left-out test: samples that count, and the mean square of what is left about the test's
    own mean (nobody knows where zero was), in the response's unit squared."""

    samples: Mapping[Place, int]
    squares: Mapping[Place, float]

    def rmse(self, response: str) -> float:
        """Over all samples of a response, in its unit; NaN where none counts."""
        own = [place for place in self.samples if place[0] == response]
        total = sum(self.samples[p] for p in own)
        return float(np.sqrt(sum(self.samples[p] * self.squares[p] for p in own) / total)) if total else float("nan")

    def over(self, before: Errors) -> float:
        """The error as a share of another model's on the same tests; of several responses the root mean square."""
        names = dict.fromkeys(name for name, _ in self.samples)
        shares = [self.rmse(n) / before.rmse(n) for n in names if before.rmse(n) > 0]
        return float(np.sqrt(np.mean(np.square(shares)))) if shares else 1.0

    def typical(self, before: Errors) -> float:
        """The same of the typical left-out test (geometric mean), where a large one counts as any other."""
        pairs = [(square, before.squares[place]) for place, square in self.squares.items()]
        logs = [np.log(after / was) / 2 for after, was in pairs if after > 0 and was > 0]
        return float(np.exp(np.mean(logs))) if logs else 1.0

    def better(self, before: Errors) -> int:
        """In how many left-out tests (of each response) the error is smaller than another model's."""
        return sum(square < before.squares[place] for place, square in self.squares.items())

    def at_least(self, before: Errors) -> float:
        """What `over` comes to at least, where these are some of the tests and the others have an error of 0."""
        shares = []
        for name in dict.fromkeys(name for name, _ in before.samples):
            if (was := before.rmse(name)) > 0:
                total = sum(n for (of, _), n in before.samples.items() if of == name)
                own = sum(n * self.squares[place] for place, n in self.samples.items() if place[0] == name)
                shares.append(own / total / was**2)
        return float(np.sqrt(np.mean(shares))) if shares else 1.0

    def of(self, tests: Sequence[Key]) -> float:
        """The sum of what is left in some tests."""
        return sum(n * self.squares[place] for place, n in self.samples.items() if place[1] in tests)


class LeftOut:
    """The open tests of a model (calibration and verification), in folds."""

    def __init__(self, spec: Model, data: Dataset) -> None:
        self.data = data
        roles = resolve_roles(spec, data)
        self._locked = roles.locked
        opened = (*roles.calibrate, *roles.verify)
        self.whole = self._fit(spec, opened, ())
        usable = [t.key for t in data.tests if t.key in opened and any(counts(r, t) for r in self.whole.responses)]
        self.tests = len(usable)
        self.longest_s = max((float(t.t_s[-1]) for t in data.tests if t.key in usable), default=0.0)
        # interleaved: neighbours in time are alike, and a group of them would take one kind of test away
        groups = [usable[k :: min(FOLDS, len(usable))] for k in range(min(FOLDS, len(usable)))]
        self._folds = [([k for k in usable if k not in group], group) for group in groups]

    def fitted(self, spec: Model) -> FittedModel:
        """A model of the same data, fitted to all open tests."""
        return self._fit(spec, [k for _, group in self._folds for k in group], ())

    def errors(self, spec: Model) -> Errors:
        """UsageError where a fold can't be fitted, as where an effect is identified on the very test."""
        return _joined_errors([self._of_fold(spec, fold) for fold in self._folds])

    def errors_unless(self, spec: Model, before: Errors, hopeless: Callable[[Errors], bool]) -> Errors | None:
        """The same; None as soon as the errors so far are hopeless, whatever comes of the other folds: those in which
        another model leaves most come first."""
        found: dict[int, Errors] = {}
        for k in sorted(range(len(self._folds)), key=lambda k: -before.of(self._folds[k][1])):
            found[k] = self._of_fold(spec, self._folds[k])
            if hopeless(_joined_errors(list(found.values()))):
                return None
        return _joined_errors([found[k] for k in sorted(found)])

    def unseen(self, spec: Model) -> Iterator[tuple[FittedResponse, TestData]]:
        """Each open test with each response as the others give it. UsageError as above."""
        for fold in self._folds:
            yield from self._fitted_without(spec, fold)

    def _of_fold(self, spec: Model, fold: _Fold) -> Errors:
        samples, squares = dict[Place, int](), dict[Place, float]()
        for response, test in self._fitted_without(spec, fold):
            left = response.residual(test)[response.mask(test)]
            samples[response.name, test.key] = len(left)
            squares[response.name, test.key] = float(np.var(left))
        return Errors(samples, squares)

    def _fitted_without(self, spec: Model, fold: _Fold) -> Iterator[tuple[FittedResponse, TestData]]:
        train, group = fold
        for response in self._fit(self._with_orders(spec), train, group).responses:
            for test in (self.data.test(*key) for key in group):
                if counts(response, test):
                    yield response, test

    def _fit(self, spec: Model, train: Sequence[Key], left_out: Sequence[Key]) -> FittedModel:
        roles = {"calibrate_on": in_full(train), "verify_on": in_full(left_out), "locked": in_full(self._locked)}
        return fit_model(spec.model_copy(update={**roles, "in_sample": False}), self.data, uncertainty=False)

    def _with_orders(self, spec: Model) -> Model:
        """Orders and delays that the file leaves open as all tests chose them: chosen anew they cost up to sixteen fits
        a fold."""
        chosen = {
            t.id: {"orders": t.bound.spec.orders, "delay": t.bound.spec.delay}
            for response in reversed(self.whole.responses)
            for t in response.terms
        }
        effects: list[EffectSpec] = []
        for name, effect in zip(term_ids(spec.effects), spec.effects, strict=True):
            found = chosen.get(name) if leaves_open(effect) else None
            effects.append(effect.model_copy(update=found) if found else effect)
        return spec.model_copy(update={"effects": effects})


def _joined_errors(some: Sequence[Errors]) -> Errors:
    samples, squares = dict[Place, int](), dict[Place, float]()
    for one in some:
        samples |= one.samples
        squares |= one.squares
    return Errors(samples, squares)


def counts(response: FittedResponse, test: TestData) -> bool:
    """Whether a test says something of a fitted response."""
    return response.can_predict(test) and bool(response.mask(test).any())
