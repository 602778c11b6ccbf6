"""The last question to a claim: does it hold on the locked tests, which took no part in the choice?"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.locked.confirmation import Confirmation, Shape, foretold_by
from thermodata.diagnosis.question.problem import freed
from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.diagnosis.weigh.scored import ACTS
from thermodata.errors import ThermodataError
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.trust.checks.bound_checks import IMPLAUSIBLE
from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.answers.result import Check
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

AS_REFITTED = 0.1  # of an error: a model whose refit to all open tests leaves as much is not told beside it


def extended(spec: Model, candidates: Sequence[CandidateEffect]) -> Model:
    """The model with candidates: as further effects, or as further gains of those that it has."""
    for one in candidates:
        spec = one.added_to(spec)
    return spec


def on_all_open(spec: Model, tests: Sequence[TestData], locked: Sequence[TestData]) -> Model:
    """The model calibrated on every test that took part in the choice; the locked ones stay locked."""

    def names(some: Sequence[TestData]) -> list[str]:
        return [f"{t.campaign}/{t.test}" for t in some]

    return spec.model_copy(update={"calibrate_on": names(tests), "verify_on": [], "locked": names(locked)})


def confirm(
    spec: Model,
    index: int,
    data: Dataset,
    candidates: Sequence[CandidateEffect],
    tests: Sequence[TestData],
    locked: Sequence[TestData],
    base: FittedModel | None = None,
    stands: FittedResponse | None = None,
) -> Confirmation:
    """Fit without and with the candidates, all together, on all open tests, and score both on the locked ones.

    index: of the response among the model's responses. base: the fit without, where it is made. stands: the response as
    the model is fitted.
    """
    spec = on_all_open(spec, tests, locked)
    base = fit_model(spec, data, uncertainty=False) if base is None else base
    terms = _terms_by_candidate(with_them := extended(spec, candidates), base, candidates)
    # of the other effects nothing is told here
    more = fit_model(with_them, data, profiled=[name for some in terms.values() for name in some])
    ours, theirs = base.responses[index], more.responses[index]
    usable = [t for t in locked if ours.can_predict(t) and theirs.can_predict(t)]
    found = more.parameters()
    own = None if stands is None else _told_apart(rmse(stands, usable), rmse(ours, usable))
    does, most = _sizes_of_added(ours, theirs, [name for c in candidates for name in c.becomes], tests, usable)
    return Confirmation(
        rmse(ours, usable),
        rmse(theirs, usable),
        rmse(ours, usable, free=True),
        rmse(theirs, usable, free=True),
        _rms_changed(ours, theirs, usable),
        {c: {n: p for n, p in found.items() if set(some) & set(n.split("."))} for c, some in terms.items()},
        tuple(
            (t.key, a, b) for t in usable if (a := rmse(ours, [t])) is not None and (b := rmse(theirs, [t])) is not None
        ),
        tuple(_shape(ours, theirs, t) for t in usable),
        acts=frozenset(key for key, size in does.items() if most > 0 and size >= ACTS * most),
        does=does,
        most=most,
        implausible={c: _implausible_gains(theirs.checks, some) for c, some in terms.items()},
        fitted=theirs,
        stands=own,
        stands_each={} if own is None or stands is None else _each_error(stands, usable),
    )


def _each_error(response: FittedResponse, tests: Sequence[TestData]) -> dict[tuple[str, str], float]:
    return {t.key: error for t in tests if (error := rmse(response, [t])) is not None}


def _told_apart(stands: float | None, refitted: float | None) -> float | None:
    """The error of the model as it is fitted; None where its refit leaves as much."""
    if stands is None or refitted is None or math.isclose(stands, refitted, rel_tol=AS_REFITTED):
        return None
    return stands


class Fits:
    """Of a model with candidates, to all open tests, each made once; and what they leave on the locked tests."""

    def __init__(
        self,
        spec: Model,
        index: int,
        data: Dataset,
        tests: Sequence[TestData],
        locked: Sequence[TestData],
        base: FittedModel,
    ) -> None:
        """index: of the response among the model's responses. base: the fit without any candidate."""
        self.spec, self.index, self.data = on_all_open(spec, tests, locked), index, data
        self.tests, self.locked = tests, locked
        self._kept = {frozenset[str](): base.responses[index]}

    def foretold(
        self, others: Sequence[CandidateEffect], one: CandidateEffect, tests: frozenset[tuple[str, str]] | None
    ) -> Foretold | None:
        """What one adds to the model with others, by shape on some of the locked tests (None: all); alone where the
        others were not logged there. None where none of them can be predicted."""
        asked = [t for t in self.locked if tests is None or t.key in tests]
        for beside in (others, ()):
            try:
                ours, theirs = self.of(beside), self.of([*beside, one])
            except ThermodataError:
                continue  # no open test has all of their channels
            usable = [t for t in asked if ours.can_predict(t) and theirs.can_predict(t)]
            if usable:
                return foretold_by([_shape(ours, theirs, t) for t in usable], tests)
        return None

    def together(self, candidates: Sequence[CandidateEffect]) -> Foretold | None:
        """What they all add to the model, by shape on all locked tests; None where none of them can be predicted."""
        try:
            ours, theirs = self.of(()), self.of(candidates)
        except ThermodataError:  # no open test has all of their channels
            return None
        usable = [t for t in self.locked if ours.can_predict(t) and theirs.can_predict(t)]
        return foretold_by([_shape(ours, theirs, t) for t in usable], None)

    def of(self, candidates: Sequence[CandidateEffect]) -> FittedResponse:
        """Of the model with candidates; ThermodataError where no open test has all of their channels."""
        key = frozenset(c.id for c in candidates)
        if key not in self._kept:
            fitted = fit_model(extended(self.spec, candidates), self.data, uncertainty=False)
            self._kept[key] = fitted.responses[self.index]
        return self._kept[key]


def _sizes_of_added(
    ours: FittedResponse,
    theirs: FittedResponse,
    changed: Collection[str],
    tests: Sequence[TestData],
    locked: Sequence[TestData],
) -> tuple[dict[tuple[str, str], float], float]:
    """How much what is added does in each locked test about its mean, by the test's key, and in the open test in which
    it does most, in the response's unit. Other effects move as well when one is added: they say nothing of it.
    changed: ids of effects that become others, which act where they do anything at all."""
    had = {t.id for t in ours.terms} - set(changed)
    new = [t for t in theirs.terms if t.id not in had]

    def size(test: TestData) -> float:
        if not new or not (ours.can_predict(test) and theirs.can_predict(test)):
            return 0.0
        values = np.sum([t.contribution(test) for t in new], axis=0)[theirs.mask(test)]
        return float(values.std()) if len(values) else 0.0

    return {t.key: size(t) for t in locked}, max(map(size, tests), default=0.0)


def _shape(ours: FittedResponse, theirs: FittedResponse, test: TestData) -> Shape:
    left, more = ours.residual(test), theirs.residual(test)
    before, after, changed = (
        shape_of(x, test, mask)
        for x, mask in ((left, ours.mask(test)), (more, theirs.mask(test)), (more - left, theirs.mask(test)))
    )
    return Shape(test.key, len(before), *(float(x @ x) for x in (before, after, changed)))


def shape_of(values: Float1D, test: TestData, mask: Bool1D) -> Float1D:
    """Where it counts, with the best offset, and the best start of a test that began warm, shape (m,). values, mask: of
    all samples, shape (n,)."""
    some = values[mask][:, None]
    return freed(some, test, test.t_s[mask], np.zeros(len(some), dtype=np.int64))[:, 0] if len(some) else some[:, 0]


def _rms_changed(ours: FittedResponse, theirs: FittedResponse, tests: Sequence[TestData]) -> float:
    parts = [shape_of(theirs.residual(t) - ours.residual(t), t, theirs.mask(t)) for t in tests]
    whole = np.concatenate([p for p in parts if len(p)] or [np.zeros(1)])
    return float(np.sqrt(np.mean(whole**2)))


def _terms_by_candidate(
    more: Model, base: FittedModel, candidates: Sequence[CandidateEffect]
) -> dict[str, tuple[str, ...]]:
    """The effects that each candidate changed, or that were added in its order, by its id."""
    had = set(term_ids(base.spec.effects)).union(*(c.becomes for c in candidates))
    added = iter(name for name in term_ids(more.effects) if name not in had)
    return {c.id: c.becomes or (next(added),) for c in candidates}


def _implausible_gains(checks: Sequence[Check], terms: Sequence[str]) -> tuple[str, ...]:
    """What the checks of a response say of the gains of some effects."""
    begins = tuple(f"{IMPLAUSIBLE}{name}." for name in terms)
    return tuple(c.advice for c in checks if c.name.startswith(begins))


def rmse(fitted: FittedResponse, tests: Sequence[TestData], *, free: bool = False) -> float | None:
    """Free-run error over all samples that count, in the response's unit; None where there are none.

    free: with the best offset for each test, instead of the one from its first samples, and the best start of one that
    began warm.
    """
    masks = [fitted.mask(t) for t in tests]
    parts = [fitted.residual(t)[m] for t, m in zip(tests, masks, strict=True)]
    if free:
        parts = [shape_of(fitted.residual(t), t, m) for t, m in zip(tests, masks, strict=True)]
    whole = np.concatenate(parts) if parts else np.empty(0)
    return float(np.sqrt(np.mean(whole**2))) if len(whole) else None
