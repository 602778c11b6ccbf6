"""A second lag of an effect, where tests that were left out of the fit want it.

A part of a machine is distributed: it answers heat by a quick share and a slow one, which no single first-order lag
does. A second lag is the same effect once more in the model file (same drivers, an id of its own), so that all that
reads a model knows what it is. It is asked of the effect that was added, and of each lag that the model had.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.effect import effect as find_effect
from thermodata.errors import UsageError
from thermodata.modelling.compare.left_out_error import Errors, LeftOut
from thermodata.modelling.fit.orders import APART
from thermodata.modelling.model_file.nested import NAME as NESTED
from thermodata.modelling.model_file.prediction.as_effect import NAME as PREDICTION
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.model_file.transfer.as_effect import NAME as TRANSFER
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedTerm
from thermodata.plugin import Param
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.schema.units.quantity import SECONDS_PER_UNIT
from thermodata.schema.words.sentences import counted as in_words
from thermodata.store.base.counting import counted
from thermodata.view.grid.dataset import Dataset

LEAST_TESTS = 3  # open tests; what holds in one of two may be chance
FALL = 0.2  # share of the error on left-out tests that it takes off at least: of all samples, and of the typical test
BETTER = 0.6  # of the left-out tests get better at least


@dataclass(frozen=True, slots=True)
class SecondLag:
    """of, id: of the effect, and of its second lag. tau: time constants of both, in `tau_unit`. before, after: error
    on left-out tests without and with it, in `unit`; of the first response. better: left-out tests that get better, of
    how many (of each response)."""

    of: str
    id: str
    tau: tuple[float, float]
    tau_unit: str
    before: float
    after: float
    unit: str
    better: int
    tests: int

    def __str__(self) -> str:
        first, second = map(_short, self.tau)
        return (
            f"{self.id} is a second lag of {self.of}, of {second} beside {first} {self.tau_unit}: error on "
            f"left-out tests {self.before:.3g} -> {self.after:.3g} {self.unit}, smaller in {self.better} of "
            f"{self.tests}"
        )


def _short(value: float) -> str:
    """Three digits, and whole numbers beyond."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}"


@dataclass(frozen=True, slots=True)
class Refined:
    """spec: the model with its second lags last. lags: what they are, in the order of their use. notes: the same in
    sentences, or why there is none."""

    spec: Model
    lags: tuple[SecondLag, ...]
    notes: list[str]


@dataclass(frozen=True, slots=True)
class _Trial:
    place: int
    spec: Model
    errors: Errors
    share: float
    lag: SecondLag


def with_second_lags(spec: Model, data: Dataset) -> Refined:
    """The model with a second lag of each effect that is worth one, the most useful first.

    Locked tests take no part. A model with fewer than `LEAST_TESTS` open tests, or whose fit can't do without one of
    them, stays as it is.
    """
    waiting = [i for i, effect in enumerate(spec.effects) if is_single_lag(effect, spec.effects)]
    if not waiting:
        return Refined(
            spec, (), ["no second lag: the model has no effect with one lag that a second could stand beside"]
        )
    left_out = LeftOut(spec, data)
    if left_out.tests < LEAST_TESTS:
        few = (
            f"no second lag: {in_words(left_out.tests, 'open test')}, and from {LEAST_TESTS} on they can be "
            "left out in turn"
        )
        return Refined(spec, (), [few])
    try:
        now, whole = left_out.errors(spec), left_out.whole
    except UsageError as error:
        return Refined(spec, (), [f"no second lag: the model can't be fitted without one of its tests ({error})"])
    found: list[SecondLag] = []
    while waiting:
        tried = [_tried(left_out, spec, whole, i, now) for i in counted(waiting, "second lags")]
        useful = [t for t in tried if t is not None]
        if not useful:
            break
        best = min(useful, key=lambda t: t.share)
        found.append(best.lag)
        spec, now, whole = best.spec, best.errors, left_out.fitted(best.spec)
        # what did not help before is not asked again: each question costs a fit for every fold
        waiting = [t.place for t in useful if t is not best]
    none = f"no second lag: none takes {100 * FALL:.0f} % off the error on left-out tests"
    return Refined(spec, tuple(found), [str(lag) for lag in found] or [none])


def _tried(left_out: LeftOut, spec: Model, whole: FittedModel, place: int, now: Errors) -> _Trial | None:
    """None where a second lag of the effect at a place is not worth it."""
    ids = term_ids(spec.effects)
    response = next(r for r in whole.responses if any(t.id == ids[place] for t in r.terms))
    second = second_of(spec.effects[place], whole.term(ids[place]), ids, (spec.step, left_out.longest_s))
    more = spec.model_copy(update={"effects": [*spec.effects, second]})
    if (errors := _worth(left_out, more, now)) is None:
        return None
    param = time_constant(spec.effects[place])
    assert param is not None
    tau = _taus(left_out.fitted(more), ids[place], second, param)
    if max(tau) < APART * min(tau):
        # a lag and its derivative: two huge gains that take each other away, as heat needs that passes two bodies
        # alike; so far apart they do nearly the same with gains that say something
        more = _parted(more, place, param, tau)
        if (errors := _worth(left_out, more, now)) is None:
            return None
        tau = _taus(left_out.fitted(more), ids[place], second, param)
    better, tests = errors.better(now), len(errors.squares)
    figures = now.rmse(response.name), errors.rmse(response.name), response.unit, better, tests
    lag = SecondLag(ids[place], str(second.id), tau, param.unit, *figures)
    return _Trial(place, more, errors, _share(errors, now), lag)


def _worth(left_out: LeftOut, spec: Model, now: Errors) -> Errors | None:
    """The errors of a model with a second lag; None where they say that it is not worth it, or can't be had."""
    try:
        errors = left_out.errors_unless(spec, now, lambda so_far: _is_hopeless(so_far, now))
    except UsageError:
        return None
    if errors is None or _share(errors, now) > 1 - FALL or errors.better(now) < BETTER * len(errors.squares):
        return None
    return errors


def _share(errors: Errors, now: Errors) -> float:
    """Of the error that is left: of all samples, or of the typical test."""
    return max(errors.over(now), errors.typical(now))


def _taus(fitted: FittedModel, first: str, second: EffectSpec, param: Param) -> tuple[float, float]:
    return fitted.term(first).params[param.name], fitted.term(str(second.id)).params[param.name]


def _parted(spec: Model, place: int, param: Param, tau: tuple[float, float]) -> Model:
    """With both lags of an effect, the second of which is the last of the model, kept `APART` about the mean of what
    they were fitted to."""
    middle = math.sqrt(tau[0] * tau[1])
    half = math.sqrt(APART)
    effects = list(spec.effects)
    for i, (lower, upper) in ((place, (None, middle / half)), (len(effects) - 1, (middle * half, None))):
        own = effects[i].bounds.get(param.name, (param.lower, param.upper))
        kept = (own[0] if lower is None else lower, own[1] if upper is None else upper)
        effects[i] = effects[i].model_copy(update={"bounds": {**effects[i].bounds, param.name: kept}})
    return spec.model_copy(update={"effects": effects})


def _is_hopeless(so_far: Errors, now: Errors) -> bool:
    """Whether the tests that were left out so far tell already that a second lag is not worth it: most of what an
    effect's second lag costs goes into the fits of folds, and most second lags help in none."""
    if any(now.samples.get(place) != n for place, n in so_far.samples.items()):
        return False
    tests = len(now.squares)
    best = tests - (len(so_far.squares) - so_far.better(now))
    return best < BETTER * tests or so_far.at_least(now) > (1 - FALL) * (1 + 1e-9)


def is_lag_of(identity: str, of: str) -> bool:
    """Whether an id is that of a further lag of an effect, as `with_second_lags` names it."""
    return identity.startswith(f"{of}_lag") and identity.removeprefix(f"{of}_lag").isdigit()


def without_second_lags(spec: Model) -> tuple[Model, list[str]]:
    """(the model with one lag of each effect, the ids of the others)."""
    ids = term_ids(spec.effects)
    second = [i for i in ids if any(is_lag_of(i, of) for of in ids)]
    kept = [e for i, e in zip(ids, spec.effects, strict=True) if i not in second]
    return spec.model_copy(update={"effects": kept}), second


def is_single_lag(spec: EffectSpec, among: Sequence[EffectSpec]) -> bool:
    """Whether an effect is one lag that a second could stand beside: not where the file holds its values or identifies
    it on tests of its own, nor where it stands twice already (a third lag is nothing that tests can tell)."""

    def same(other: EffectSpec) -> bool:
        keys = ("effect", "drivers", "tests", "gain_by", "phases")
        return all(getattr(spec, key) == getattr(other, key) for key in keys)

    held = bool(spec.fixed) or spec.calibrate_on is not None
    return not held and time_constant(spec) is not None and sum(same(other) for other in among) == 1


def time_constant(spec: EffectSpec) -> Param | None:
    """The one time constant of an effect; None where it has none, or several, or no driver to lag."""
    if spec.effect in (TRANSFER, PREDICTION, NESTED):
        return None
    effect = find_effect(spec.effect)
    times = [p for p in effect.params if p.unit in SECONDS_PER_UNIT]
    return times[0] if effect.needs and len(times) == 1 else None


def second_of(spec: EffectSpec, fitted: FittedTerm, ids: Sequence[str], span_s: tuple[float, float]) -> EffectSpec:
    """The same effect once more, with a time constant anywhere between the grid's step and the longest test (span_s).

    The library's bounds are those of an effect as a whole; its quick share and its slow one lie beside them. An
    exponent is the friction's, not the lag's, and is held as fitted where it is one for all. ids: that are taken.
    """
    param = time_constant(spec)
    assert param is not None
    groups = list(fitted.groups.values())
    held = {
        name: value
        for name, value in fitted.params.items()
        if name != param.name and name not in groups[0].silent and all(g.params[name] == value for g in groups)
    }
    shortest, longest = (s / SECONDS_PER_UNIT[param.unit] for s in span_s)
    bounds = {**spec.bounds, param.name: (min(param.lower, shortest), max(param.upper, longest))}
    number = next(k for k in range(2, len(ids) + 3) if f"{fitted.id}_lag{k}" not in ids)
    start = {name: value for name, value in spec.start.items() if name != param.name}  # that of the first lag
    changes = {"id": f"{fitted.id}_lag{number}", "fixed": held, "start": start, "bounds": bounds}
    return spec.model_copy(update=changes)
